/// Writes a recording while the run goes on, so that a crash loses little and a broken run never looks complete.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// Appends rows to NAME.csv and keeps NAME.json beside it.
///
/// On opening, the sidecar is written with "complete": false, then the CSV's header row. Rows reach the operating system at least every 256
/// rows, and with the first row that comes a second of wall time or more after the last write; a killed program loses no more than that.
/// close() writes the sidecar again with "complete" true or false. Both sidecars appear under their name as a whole or not at all.
/// Numbers are written with the fewest digits that read back to the same double; NaN as an empty cell.
/// Throws IoError (naming the file and the system's reason) from every call that writes.
class Recorder {
 public:
  /// `columns` are canonical signal names without time_s. The folder must exist; existing files are replaced.
  /// Throws BadParameter for a name that does not end in .csv, and for columns or an info that readRecording would refuse.
  Recorder(const std::string& csv_file, RecordingInfo info, std::vector<std::string> columns);
  /// Closes as not complete if close() was not called; never throws.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Appends one row; `values` has one entry per column, in canonical units. After an IoError the rows not yet written are kept, and the
  /// next call tries again.
  /// Throws BadParameter if time_s is not later than the row before, the number of values is wrong, a value is infinite, or a command lies
  /// outside 0..1.
  void append(double time_s, const std::vector<double>& values);
  /// Sets or replaces a member of the sidecar ("verdict", "substeps", "stop_reason", ...); `json_value` is JSON text. Written at close().
  /// Throws BadParameter if the value is not JSON, or the sidecar would be refused with it.
  void note(const std::string& member, const std::string& json_value);
  /// Finishes both files and waits until they are on the disk. `complete` false marks a run that stopped early. A second call does nothing.
  /// After an IoError the sidecar still says "complete": false.
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
