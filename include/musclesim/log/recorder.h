/// Writes a recording during the run: a crash loses little, and an incomplete run never looks complete.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// Throws BadParameter if writing a recording there would replace a measured recording or a file that is not a recording.
void requireReplaceable(const std::string& csv_file);

/// Appends rows to NAME.csv and keeps NAME.json beside it.
///
/// The constructor writes the sidecar with "complete": false, then the CSV's header row. Rows are handed to the operating system after 256
/// rows, or when a row comes a second of wall time or more after the last write; a killed program loses no more than that.
/// close() writes the sidecar again with "complete" true or false. Both times the sidecar is replaced atomically.
/// Numbers are written with the fewest digits that read back to the same double; NaN as an empty cell.
/// Every call that writes may throw IoError with the file's name and the system's reason.
class Recorder {
 public:
  /// `columns` are canonical signal names without time_s. The folder must exist; existing files are replaced.
  /// Throws BadParameter for a name that does not end in .csv, and for columns or an info that readRecording would refuse.
  Recorder(const std::string& csv_file, RecordingInfo info, std::vector<std::string> columns);
  /// Closes the files and leaves "complete": false if close() was not called. Never throws.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Appends one row; `values` has one entry per column, in canonical units. After an IoError the rows not yet written are kept, and the
  /// next call tries again.
  /// Throws BadParameter if time_s is not later than the row before, the number of values is wrong, a value is infinite, or a command lies
  /// outside 0..1.
  void append(double time_s, const std::vector<double>& values);
  /// Sets or replaces a member of the sidecar ("verdict", "substeps", "stop_reason", ...); `json_value` is JSON text. close() writes it.
  /// Throws BadParameter if the value is not JSON or if readRecording would refuse the sidecar.
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
