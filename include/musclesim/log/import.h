/// Turns measured tables into recordings. A mapping file says what each column means, in which unit and at which time.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// How one column of the recording is computed: constant `value`, or factor * x + offset with x from a column of a table; then clamped.
struct ImportColumn {
  std::string name;             ///< column of the recording, with its unit: "command_0_MPa"
  std::string from;             ///< column of the table; empty: the constant `value`
  std::string table;            ///< another CSV file, in the folder of the first; empty: the first
  std::string time = "time_s";  ///< time column of that other table, s
  double factor = 1, offset = 0, value = 0;
  double minimum, maximum;
  bool linear = true;  ///< false: hold the last value between rows (default for commands)
};

/// A mapping file, TOML:
///     robot = "wrist"                  # and any other member of the sidecar, noise_std and robot_parameters as tables
///     [columns]
///     time_s = "t"                     # a column of the table
///     command_0_MPa = { from = "u", factor = -1, offset = 0.6, minimum = 0, maximum = 0.6 }
///     command_1_MPa = { value = 0.1 }
///     angle_wrist_deg = { from = "angle", table = "other.csv", time = "t" }
///     [rows]
///     settle_s = 0.6                   # the table has no time: each row was read at the end of a command held that long
///     step_s = 0.02                    # resample at even steps
///     from_s = 4.0                     # use rows from this time on; it becomes time 0
///     until_s = 7.6                    # use rows up to this time
///     every = 5                        # use every fifth row, not counting rows that repeat a time (only without step_s)
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

/// Reads a mapping file. Throws BadFile with line and column if it is not a valid mapping; IoError if it cannot be read.
ImportMapping readImportMapping(const std::string& toml_file);

/// The path of the table that a column names; it is relative to the folder of the first table.
std::string tableFile(const std::string& csv_file, const ImportColumn& column);

/// Turns the table into a recording. Rows that repeat the time of the row before (a coarse clock) are left out with a note.
/// Throws BadFile if the table lacks a column that the mapping names; throws as readRecording if the result is not a valid recording.
Recording importTable(const std::string& csv_file, const ImportMapping& mapping);

}  // namespace musclesim
