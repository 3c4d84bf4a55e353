/// Videos: passes pictures to ffmpeg one by one or, without ffmpeg, writes them to a folder.
#pragma once

#include <sys/types.h>

#include <string>

#include "image.h"

namespace musclesim {

/// Makes FILE.mp4 from frames of one size. If ffmpeg is not installed or fails, it writes numbered pictures to the folder FILE-frames
/// instead.
class VideoWriter {
 public:
  /// Throws BadParameter for a name that does not end in .mp4, IoError if nothing can be written.
  VideoWriter(const std::string& file, int width, int height, double frames_per_s);
  /// Closes silently if close() was not called.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Throws IoError.
  void add(const Image& frame);
  /// Waits until the file is complete. Throws IoError.
  void close();

  long frameCount() const { return frame_count_; }
  /// The video, or the folder of the pictures.
  const std::string& result() const { return result_; }

 private:
  void startFfmpeg(double frames_per_s);
  void waitForFfmpeg();

  std::string file_, result_;
  int width_, height_;
  int pipe_ = -1;
  pid_t child_ = -1;
  long frame_count_ = 0;
};

}  // namespace musclesim
