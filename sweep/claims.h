/// Who works on which row: agreed through files alone, so that workers need nothing but a folder that they share.
///
///     workers/WORKER         one per worker; its time of change is the worker's heartbeat
///     claims/ROW.N           the N-th attempt at a row, created atomically (link) by the worker who makes it; never removed
///     claims/ROW.N.end       that attempt ended without a result, and why
/// Claims are on the disk before work begins. One that is not readable as a claim nevertheless is an attempt whose worker is gone when the
/// file is older than the limit.
///
/// A row is free if no attempt was made, if the last one has an end, or if the worker of the last one is gone: on this machine when its
/// process no longer exists, on another when its heartbeat is older than the limit. Times are compared as the file system gives them, so
/// that clocks of machines need not agree. Two workers that take over the same row try to create the same ROW.N+1, and one succeeds.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace musclesim {

/// How an attempt ended that has no result.
enum class AttemptEnd {
  crashed,    ///< by its own doing: a signal like SIGSEGV, an internal error, out of time
  killed,     ///< from outside, or its worker vanished
  abandoned,  ///< given back by a worker that had to stop
};

/// What is known of a row's attempts so far.
struct RowHistory {
  int attempt_count = 0;
  int crash_count = 0, kill_count = 0;
  bool free = true;     ///< a next attempt may be made
  std::string message;  ///< of the last one that failed
};

class Claims {
 public:
  /// Registers this process as a worker of the sweep in `folder`. Throws IoError.
  Claims(const std::string& folder, double stale_after_s);
  /// Takes the worker's file away.
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Shows that this worker lives; cheap, at most once a tenth of the limit.
  void beat();
  /// Tries to make the N-th attempt at a row this worker's, N from 1. False if it is another's.
  bool claim(std::size_t row, int attempt);
  /// Notes that an attempt of this worker ended without a result.
  void end(std::size_t row, int attempt, AttemptEnd how, const std::string& message);
  RowHistory history(std::size_t row) const;
  /// Which rows anybody has tried.
  std::vector<bool> tried(std::size_t row_count) const;
  const std::string& worker() const { return worker_; }

 private:
  std::string path(std::size_t row, int attempt) const;
  static void addEnd(RowHistory& history, const std::string& end_file);
  bool isGone(const std::string& claim_file) const;
  /// How long before this worker's last heartbeat a file was changed.
  double ageS(const std::string& file) const;

  std::string folder_, machine_, worker_, text_;
  double stale_after_s_;
  double last_beat_s_ = -1e300;
};

}  // namespace musclesim
