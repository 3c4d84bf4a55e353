/// The mapping file of an import: how each table is written, what each column means, in which unit and at which time.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/log/table_format.h"

namespace musclesim {

/// How one column of the recording is computed: constant `value`, or factor * x + offset with x from a column of a table; then limited.
struct ImportColumn {
  std::string name;                 ///< column of the recording, with its unit: "command_0_MPa"
  std::string written;              ///< as the mapping names it, perhaps in a unit that recordings do not have: "command_0_psi"
  double unit_factor = 1;           ///< from that unit to the recording's
  ColumnName from;                  ///< column of the table; empty: the constant `value`
  std::string table;                ///< another file, in the folder of the first; empty: the first
  std::optional<TableClock> clock;  ///< of the other table, or another clock in the first
  double factor = 1, offset = 0, value = 0;
  double minimum, maximum;
  std::optional<double> clipped_below, clipped_above;  ///< limits of the sensor or table, in the table's unit: x there is no reading
  std::optional<double> unwrap;  ///< in the table's unit: the sensor begins again after so much, a turn; the readings count on
  bool linear = true;            ///< false: hold the last value between rows (default for commands)

  /// Whether the table's value x is at one of the limits or beyond it.
  bool isClipped(double x) const { return (clipped_below && x <= *clipped_below) || (clipped_above && x >= *clipped_above); }
  /// The value in the written unit for the table's value x.
  double readingOf(double x) const;
  /// The same in the recording's unit.
  double valueOf(double x) const { return unit_factor * readingOf(x); }
};

/// A column that is taken as it is.
ImportColumn importColumn(const std::string& written, const ColumnName& from);

/// A mapping file, TOML. docs/reference/recording_format.md lists all members.
///     robot = "wrist"                  # and any other member of the sidecar, noise_std and robot_parameters as tables
///     [table]                          # how the file is written, where it differs from a recording
///     separator = ";"
///     decimal = ","
///     [columns]
///     time_s = "t"                     # a column of the table
///     command_0_MPa = { from = "u", factor = -1, offset = 0.6, minimum = 0, maximum = 0.6 }
///     command_1_MPa = { value = 0.1 }
///     pressure_0_hPa = { from = 3, ambient_kPa = 101.3 }
///     angle_wrist_deg = { from = "angle", table = "other.csv" }
///     [tables."other.csv"]             # how another table is written, and its clock
///     time_ms = { from = "t", offset = -200 }
///     [rows]
///     step_s = 0.02                    # resample at even steps
///     from_s = 4.0                     # use rows from this time on; it becomes time 0
///     before_s = 1.0                   # before the first row the plant rested that long ...
///     before = { command_0_MPa = 0 }   # ... under these commands, the others as in the first row
struct ImportMapping {
  struct Place {
    int line = 0, column = 0;
  };
  std::string file;
  std::map<std::string, Place> places;  ///< of all members in the file: "columns.command_0_bar", "rows.before.command_0"
  std::string sidecar_json;
  std::optional<TableClock> clock;  ///< of the first table
  std::vector<ImportColumn> columns;
  TableFormat format;                          ///< of the first table
  std::map<std::string, TableFormat> formats;  ///< of other tables; those without are written as the first
  std::optional<double> settle_s, step_s, from_s, until_s, before_s, longest_gap_s;
  std::map<std::string, double> before;
  bool has_rows = false;  ///< there is a section [rows]
  int every = 1;

  /// Throws BadFile at a member of the file.
  [[noreturn]] void refuse(const std::string& member, const std::string& what) const;
};

/// Reads a mapping file. Throws BadFile with line and column if it is not a valid mapping; IoError if it cannot be read.
ImportMapping readImportMapping(const std::string& toml_file);

}  // namespace musclesim
