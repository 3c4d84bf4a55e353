#include "video.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <system_error>
#include <vector>

#include "../../base/program_in_path.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {

namespace {

namespace fs = std::filesystem;

/// Checks that the file can be created, and removes an old file that could be mistaken for the new one.
void requireWritable(const std::string& file) {
  replaceFile(file, "");
  fs::remove(file);
}

/// Ignores SIGPIPE, so that this process survives if the reader of a pipe ends.
class IgnoredPipeSignal {
 public:
  IgnoredPipeSignal() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~IgnoredPipeSignal() { std::signal(SIGPIPE, before_); }
  IgnoredPipeSignal(const IgnoredPipeSignal&) = delete;
  IgnoredPipeSignal& operator=(const IgnoredPipeSignal&) = delete;

 private:
  void (*before_)(int);
};

}  // namespace

VideoWriter::VideoWriter(const std::string& file, int width, int height, double frames_per_s)
    : file_(file), result_(file), width_(width), height_(height) {
  if (fs::path(file).extension() != ".mp4") throw BadParameter("video", file, "end in .mp4");
  requireWritable(file);
  startFfmpeg(frames_per_s);
  if (child_ > 0) return;
  result_ = fs::path(file).replace_extension().string() + "-frames";
  std::error_code failure;
  fs::create_directories(result_, failure);
  if (failure) throw IoError(result_ + ": cannot be made: " + failure.message());
}

/// Starts ffmpeg, which reads raw pictures from its standard input. It is started without a shell and in a process group of its own,
/// because a terminal sends Ctrl-C to a whole group, but only the end of the pictures may end the video.
void VideoWriter::startFfmpeg(double frames_per_s) {
  const fs::path program = programInPath("ffmpeg");
  if (program.empty()) return;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return;
  std::vector<std::string> arguments = {"ffmpeg", "-nostdin", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgb24",
                                        "-video_size", fmt::format("{}x{}", width_, height_), "-framerate", fmt::format("{}", frames_per_s),
                                        "-i", "pipe:0",
                                        // Players need an even size and this pixel format.
                                        "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-codec:v", "libx264", "-preset", "veryfast", "-crf",
                                        "20", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "file:" + file_};
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int failure = posix_spawn(&child_, program.c_str(), &actions, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  pipe_ = ends[1];
  if (failure == 0) return;
  ::close(pipe_);
  pipe_ = -1;
  child_ = -1;
}

VideoWriter::~VideoWriter() {
  try {
    close();
  } catch (const Error&) {
  }
}

void VideoWriter::add(const Image& frame) {
  if (frame.width != width_ || frame.height != height_)
    throw BadParameter("size of a video's frame", fmt::format("{} x {}", frame.width, frame.height),
                       fmt::format("be that of the first, {} x {}", width_, height_));
  ++frame_count_;
  if (child_ <= 0) return writePng(frame, fmt::format("{}/{:06}.png", result_, frame_count_));
  const IgnoredPipeSignal ignored;
  const std::string_view bytes(reinterpret_cast<const char*>(frame.rgb.data()), frame.rgb.size());
  if (writeAll(pipe_, bytes) == bytes.size()) return;
  waitForFfmpeg();
  throw IoError(file_ + ": ffmpeg stopped taking frames");
}

void VideoWriter::waitForFfmpeg() {
  ::close(pipe_);
  pipe_ = -1;
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw IoError(file_ + ": ffmpeg could not make it");
}

void VideoWriter::close() {
  if (child_ > 0) waitForFfmpeg();
}

}  // namespace musclesim
