/// Measured static points of a muscle: pressure, length, force.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace musclesim {

/// One equilibrium of a measured muscle.
struct StaticPoint {
  double pressure_ratio = 0;  ///< fraction of full scale
  double length_mm = 0;
  double force_N = 0;     ///< pulling positive
  int line = 0;           ///< line in the file
  bool censored = false;  ///< the reading is at or below the sensor's floor: the force is known only to be at most the floor
  bool outlier = false;   ///< far from its neighbours; see markOutliers
};

/// All points of one muscle.
struct StaticPoints {
  std::string file;
  std::vector<StaticPoint> points;
  std::optional<double> full_scale_kPa;  ///< pressure of ratio 1; empty where the file holds fractions
  double floor_N = 0;                    ///< the sensor's floor, for censored points
  std::vector<std::string> notes;        ///< messages for the user: columns ignored, rows skipped, points censored

  double shortestMm() const;
  double longestMm() const;
  double largestForceN() const;
  /// Points that are neither censored nor outliers.
  std::vector<StaticPoint> measured() const;
  int censoredCount() const;
};

/// Options for reading a file.
struct StaticPointsOptions {
  /// A mapping file as for import: how the table is written ([table]) and what its columns are ([columns] with pressure, length and force).
  std::string mapping;
  /// "pressure", "length" or "force" and the column that holds it; "#3" is the third. The unit is the name's ending (_kPa, _cm), or follows
  /// a colon (L:mm).
  std::vector<std::pair<std::string, std::string>> columns;
  /// Keep only rows that have this value in this column, for all pairs.
  std::vector<std::pair<std::string, std::string>> where;
  std::optional<double> full_scale_kPa;    ///< default: the largest pressure of the file
  std::optional<double> censored_below_N;  ///< default: the lowest force, if it occurs repeatedly
};

}  // namespace musclesim
