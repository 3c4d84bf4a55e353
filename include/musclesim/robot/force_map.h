/// A measured map of tension over pressure and length, as a smooth force law.
#pragma once

#include <Eigen/Core>

#include "musclesim/robot/force_law.h"

namespace musclesim {

/// Natural cubic spline through values at equidistant knots on 0..1. Outside it continues as straight lines. Source: de Boor 1978.
class NaturalSpline {
 public:
  /// Throws BadParameter for fewer than two knots.
  explicit NaturalSpline(int knot_count);
  int knotCount() const { return static_cast<int>(curvatures_.rows()); }
  /// The value at `x` is the sum of these weights times the values at the knots.
  Eigen::VectorXd weights(double x) const;

 private:
  Eigen::MatrixXd curvatures_;  ///< second derivatives at the knots (times the knots' distance squared), per value at a knot
};

/// Nodes of a force map and the forces at them, read from the parameters "force_law.*".
struct ForceMapTable {
  /// The defaults are Eq. 1 with the paper's constants for l_min/l_max = 0.4, on 3 pressures and 7 lengths.
  explicit ForceMapTable(Parameters& parameters);
  ForceMapTable() = default;
  double shortest_ratio = 0.4, longest_ratio = 1.0;  ///< lengths of the first and the last node over the rest length
  Eigen::MatrixXd force_N;  ///< rows: pressures from 0 to 1; columns: lengths. A negative force: the muscle is slack
};

/// A tensor product of natural cubic splines through the table's nodes:
///     F(p, l) = max(0, sum_ij u_i(p) v_j(l / l_0) F_ij)
/// p pressure (fraction of full scale), l length, l_0 rest length, u and v the splines' weights. Outside the nodes the map continues
/// linearly. A slack muscle does not push.
class ForceMap final : public ForceLaw {
 public:
  /// Throws BadParameter unless the rest length is positive, the first length is below the last, there are at least two pressures and two
  /// lengths, and all forces are finite.
  ForceMap(double rest_length_mm, const ForceMapTable& table);
  double tensionN(double pressure_ratio, double length_mm) const override;
  double formulaN(double pressure_ratio, double length_mm) const override;
  std::string name() const override { return "map"; }
  std::optional<double> restLengthMm() const override { return rest_length_mm_; }

 private:
  double rest_length_mm_;
  ForceMapTable table_;
  NaturalSpline over_pressure_, over_length_;
};

}  // namespace musclesim
