/// Working on a sweep: claims a row, runs it in a child process, puts its result in place, until nothing is left.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "sweep/child.h"

namespace musclesim {

struct WorkOptions {
  std::string program = own_program;                              ///< what runs the rows
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< wall time after which this worker has ended
  double stale_after_s = 60;                                      ///< a worker on another machine without heartbeat for so long is gone
  bool wait = true;  ///< when all rows are taken, stay until they are over, to take over from a worker that dies
  std::function<int()> interrupt_signal = [] { return 0; };
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

struct WorkSummary {
  enum class End { finished, time_limit, interrupted };
  End end = End::finished;  ///< finished: nothing is left that this worker could do
  std::size_t done_count = 0, diverged_count = 0, failed_count = 0, crashed_count = 0;  ///< rows that this worker concluded
  double wall_s = 0, child_wall_s = 0;
};

/// Makes this process a worker of the sweep. Any number may work at once.
/// A run that crashes is repeated once, one that is killed from outside up to five times; then its result says "crashed". Runs that end
/// with a usage error or bad input are not repeated: "failed".
/// Throws BadFile if the sweep was planned by another version, for other robots, or its inputs have changed; IoError.
WorkSummary work(const std::string& folder, const WorkOptions& options);

}  // namespace musclesim
