/// Claims say which worker works on which row. They are files, so that workers need nothing but a shared folder.
///
///     workers/WORKER         one per worker; its modification time is the worker's heartbeat
///     claims/ROW.N           the N-th attempt at a row, created atomically (link) by the worker who makes it; never removed
///     claims/ROW.N.end       says that this attempt ended without a result, and why
/// A claim is on the disk before work begins. If a claim is nevertheless unreadable, it counts as an attempt, and its worker as gone once
/// the file is older than the limit.
///
/// A row is free if no attempt was made, if the last attempt has an end, or if the worker of the last attempt is gone. A worker on this
/// machine is gone if its process no longer exists; a worker on another machine is gone if its heartbeat is older than the limit. Only
/// times from the file system are compared, so the machines' clocks need not agree. If two workers take over the same row, both try to
/// create ROW.N+1, and one succeeds.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace musclesim {

/// How an attempt without a result ended.
enum class AttemptEnd {
  crashed,    ///< its own failure: a signal like SIGSEGV, an internal error, out of time
  killed,     ///< killed from outside, or its worker vanished
  abandoned,  ///< its worker had to stop and gave the row back
};

/// The attempts at a row so far.
struct RowHistory {
  int attempt_count = 0;
  int crash_count = 0, kill_count = 0;
  bool free = true;     ///< a next attempt may be made
  std::string message;  ///< reason of the last failed attempt
};

class Claims {
 public:
  /// Registers this process as a worker of the sweep in `folder`. Throws IoError.
  Claims(const std::string& folder, double stale_after_s);
  /// Removes the worker's file.
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Heartbeat: shows that this worker lives. Cheap: touches the file at most ten times per limit.
  void beat();
  /// Claims the N-th attempt at a row, N from 1. Returns false if another worker has it.
  bool claim(std::size_t row, int attempt);
  /// Records that an attempt of this worker ended without a result.
  void end(std::size_t row, int attempt, AttemptEnd how, const std::string& message);
  RowHistory history(std::size_t row) const;
  /// For each row, whether any worker has tried it.
  std::vector<bool> tried(std::size_t row_count) const;
  const std::string& worker() const { return worker_; }

 private:
  std::string path(std::size_t row, int attempt) const;
  static void addEnd(RowHistory& history, const std::string& end_file);
  bool isGone(const std::string& claim_file) const;
  /// Time from the last change of a file to this worker's last heartbeat.
  double ageS(const std::string& file) const;

  std::string folder_, machine_, worker_, text_;
  double stale_after_s_;
  double last_beat_s_ = -1e300;
};

}  // namespace musclesim
