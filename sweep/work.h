/// A worker of a sweep: claims a row, runs it in a child process, writes its result, and repeats until no row is left.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "sweep/child.h"

namespace musclesim {

struct WorkOptions {
  std::string program = own_program;                              ///< the program that runs the rows
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< this worker ends within this wall time
  double stale_after_s = 60;  ///< a worker on another machine counts as gone after this time without heartbeat
  bool wait = true;           ///< when all rows are taken, wait for their ends, to take over from a worker that dies
  std::function<int()> interrupt_signal = [] { return 0; };
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

struct WorkSummary {
  enum class End { finished, time_limit, interrupted };
  End end = End::finished;                                                              ///< finished: no row is left for this worker
  std::size_t done_count = 0, diverged_count = 0, failed_count = 0, crashed_count = 0;  ///< rows whose results this worker wrote
  double wall_s = 0, child_wall_s = 0;
};

/// Makes this process a worker of the sweep. Any number of workers may run at once.
/// A run that crashes is repeated once; a run that is killed from outside is repeated up to five times; then its result is "crashed". A run
/// that ends with a usage error or bad input is not repeated; its result is "failed".
/// Throws BadFile if the sweep was planned by another version, for other robots, or its inputs have changed; IoError.
WorkSummary work(const std::string& folder, const WorkOptions& options);

}  // namespace musclesim
