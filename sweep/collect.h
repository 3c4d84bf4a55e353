/// Collecting: all results of a sweep in one table.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// Which rows have no numbers, and why.
struct Collected {
  std::size_t row_count = 0, done_count = 0;
  std::vector<std::size_t> missing, diverged, failed, crashed;
  std::vector<std::string> unmet_columns;  ///< of the plan's columns those that no row has; empty while no row is done
  std::string csv_file, json_file;

  /// Every row was run to an end of its own; divergence is one.
  bool complete() const { return missing.empty() && failed.empty() && crashed.empty(); }
};

/// Writes collected.csv and collected.json into the sweep's folder: row, status, parameters, numbers. They depend on the rows' results
/// only, not on who made them or when: members named wall_s, wall_per_simulated_s, log, figure, out and elapsed_s are left out unless the
/// plan's columns name them in full. Throws BadFile, IoError.
Collected collect(const std::string& folder);

}  // namespace musclesim
