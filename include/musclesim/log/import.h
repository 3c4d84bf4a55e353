/// Foreign tables become recordings: a mapping says which column is what, in which unit and at which time.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// How one column of the recording comes about: value, or factor * x + offset with x from a column of a table, then limited.
struct ImportColumn {
  std::string name;             ///< column of the recording, with its unit: "command_0_MPa"
  std::string from;             ///< column of the table; empty: the constant `value`
  std::string table;            ///< another CSV file, in the folder of the first; empty: the first
  std::string time = "time_s";  ///< time column of that other table, s
  double factor = 1, offset = 0, value = 0;
  double minimum, maximum;
  bool linear = true;  ///< between rows: straight line; otherwise the last value. Commands are held unless the mapping says otherwise
};

/// A mapping file, TOML:
///     robot = "wrist"                  # and any other member of the sidecar, noise_std and robot_parameters as tables
///     [columns]
///     time_s = "t"                     # a column of the table
///     command_0_MPa = { from = "u", factor = -1, offset = 0.6, minimum = 0, maximum = 0.6 }
///     command_1_MPa = { value = 0.1 }
///     angle_wrist_deg = { from = "angle", table = "other.csv", time = "t" }
///     [rows]
///     settle_s = 0.6                   # no time: each row is what was read at the end of a step that was held that long
///     step_s = 0.02                    # even steps in place of the table's times
///     from_s = 4.0                     # rows from there on; that time becomes 0
///     until_s = 7.6                    # rows up to there
///     every = 5                        # every fifth row of the table, not counting rows that repeat a time (without step_s)
///     before_s = 1.0                   # before the first row the plant rested that long ...
///     before = { command_0_MPa = 0 }   # ... under these commands, the others as in the first row
struct ImportMapping {
  std::string file;
  std::string sidecar_json;
  std::vector<ImportColumn> columns;
  std::optional<double> settle_s, step_s, from_s, until_s, before_s;
  std::map<std::string, double> before;
  int every = 1;
};

/// Throws BadFile with line and column for what is not such a mapping; IoError if it cannot be read.
ImportMapping readImportMapping(const std::string& toml_file);

/// The file of a column's own table, which lies relative to the first one.
std::string tableFile(const std::string& csv_file, const ImportColumn& column);

/// The table as a recording. Rows whose time does not increase because the clock is coarse (the same time again) are left out with a note.
/// Throws BadFile for a table without a column that the mapping names, and as readRecording for what is not a recording then.
Recording importTable(const std::string& csv_file, const ImportMapping& mapping);

}  // namespace musclesim
