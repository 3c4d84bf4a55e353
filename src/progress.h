/// A progress line on a terminal.
#pragma once

#include <chrono>
#include <string>

namespace musclesim::program {

/// Rewrites one line on standard error a few times per second; silent when standard error is not a terminal or when told so.
class Progress {
 public:
  Progress(double duration_s, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `detail` is appended to "12.3 of 300 s simulated, 4.1 x real time, 1 min 10 s left".
  void show(double simulated_s, const std::string& detail);
  double wallS() const;

 private:
  double duration_s_;
  bool active_, shown_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace musclesim::program
