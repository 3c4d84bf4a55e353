/// Writes a recording while the run goes on, so that a crash loses little and a broken run never looks complete.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// Appends rows to NAME.csv and keeps NAME.json beside it.
///
/// On opening, the sidecar is written with "complete": false and the header row with it. Rows reach the disk at least every 256 rows and
/// every second of wall time. close() writes the sidecar again with "complete": true or false, and the reason.
/// Numbers are written with the fewest digits that read back to the same double; NaN as an empty cell.
/// Throws IoError (naming the file and the system's reason) from every call that writes.
class Recorder {
 public:
  /// `columns` without time_s. The folder must exist.
  Recorder(const std::string& csv_file, RecordingInfo info, std::vector<std::string> columns);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Appends one row; `values` has one entry per column.
  void append(double time_s, const std::vector<double>& values);
  /// Sets or replaces a member of the sidecar ("verdict", "substeps", ...); `json_value` is JSON text. Written at close().
  void note(const std::string& member, const std::string& json_value);
  /// Finishes both files. `complete` false marks a run that stopped early.
  void close(bool complete);

  const std::string& csvFile() const { return csv_file_; }
  long rowCount() const { return row_count_; }

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
  std::string csv_file_;
  long row_count_ = 0;
};

}  // namespace musclesim
