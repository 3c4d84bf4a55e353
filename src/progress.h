/// Progress of long work on standard error.
#pragma once

#include <chrono>
#include <string>

namespace musclesim::command_line {

/// On a terminal rewrites one line a few times per second; in a file or a pipe adds a line every 30 s. Silent on request.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Whether a new text would be shown now. The last state is always shown on a terminal, and after work of more than 30 s.
  bool isDue(bool at_end) const;
  void show(const std::string& text);
  double wallS() const;

 private:
  bool active_, is_terminal_, shown_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

/// Progress of a run.
class Progress {
 public:
  Progress(double duration_s, bool quiet) : duration_s_(duration_s), line_(quiet) {}

  /// `detail` is appended to "12.3 of 300 s simulated, 4.1 x real time, 1 min 10 s left".
  void show(double simulated_s, const std::string& detail);
  double wallS() const { return line_.wallS(); }

 private:
  double duration_s_;
  ProgressLine line_;
};

/// Progress of work in phases, counted in simulations.
class PhaseProgress {
 public:
  explicit PhaseProgress(bool quiet) : line_(quiet) {}
  void show(const std::string& phase, long done, long expected);

 private:
  ProgressLine line_;
};

/// Progress through a list of similar cases.
class CaseProgress {
 public:
  explicit CaseProgress(bool quiet) : line_(quiet) {}
  void show(int done, int count);

 private:
  ProgressLine line_;
};

}  // namespace musclesim::command_line
