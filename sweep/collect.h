/// Collects all results of a sweep in one table.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// The state of the rows: how many are done, and which are missing or have failed.
struct Collected {
  std::size_t row_count = 0, done_count = 0;
  std::vector<std::size_t> missing, diverged, failed, crashed;
  std::vector<std::string> unmet_columns;  ///< columns of the plan that no row has; empty while no row is done
  std::string csv_file, json_file;

  /// True if every row is done or diverged.
  bool complete() const { return missing.empty() && failed.empty() && crashed.empty(); }
};

/// Writes collected.csv and collected.json into the sweep's folder: row, status, parameters, numbers. Their contents do not depend on which
/// worker ran a row or when: members named wall_s, real_time_factor, log, figure, out and elapsed_s are left out unless the plan's
/// columns give their full names. Throws BadFile, IoError.
Collected collect(const std::string& folder);

}  // namespace musclesim
