#include "figure_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <vector>

#include "../base/program_in_path.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {

namespace {

namespace fs = std::filesystem;

constexpr const char* converter = "rsvg-convert";
constexpr const char* png_zoom = "1.5";  ///< pixels of a PNG per pixel of the SVG: sharp on paper, and below the limit of tall figures

/// Starts the converter without a shell and waits for it. Returns whether it did what it was asked to.
bool convert(std::vector<std::string> arguments) {
  const fs::path program = programInPath(converter);
  if (program.empty()) return false;
  arguments.insert(arguments.begin(), converter);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  const int failure = posix_spawn(&child, program.c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return false;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// A file that is removed in the end.
struct TemporaryFile {
  std::string name;
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(name, ignored);
  }
};

}  // namespace

void requireFigureFile(const std::string& file) {
  const fs::path extension = fs::path(file).extension();
  if (extension != ".svg" && extension != ".png") throw BadParameter("figure", file, "end in .svg or .png");
  if (extension == ".png" && !convert({"--version"}))
    throw BadParameter("figure = " + file + ": a PNG needs rsvg-convert, which is not installed; Debian: apt-get install librsvg2-bin");
}

void writeFigure(const std::string& file, const std::string& svg) {
  requireFigureFile(file);
  if (fs::path(file).extension() == ".svg") return replaceFile(file, svg);
  const TemporaryFile drawing{file + ".drawing.svg"}, picture{file + ".picture.png"};
  replaceFile(drawing.name, svg);
  // The names may begin with a dash.
  if (!convert({"--zoom", png_zoom, "--background-color", "white", "--output", picture.name, "--", drawing.name}))
    throw IoError(file + ": rsvg-convert could not make it");
  std::error_code failure;
  fs::rename(picture.name, file, failure);
  if (failure) throw IoError(file + ": cannot be written: " + failure.message());
}

}  // namespace musclesim
