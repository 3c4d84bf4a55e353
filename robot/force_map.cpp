#include "musclesim/robot/force_map.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "force_law_checks.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr int most_nodes = 40;

double defaultForceN(double pressure_ratio, double length_ratio) {
  static const BraunForceLaw equation_1(ForceMapTable().shortest_ratio, ForceMapTable().longest_ratio);
  return equation_1.tensionN(pressure_ratio, length_ratio);
}

double gridPositionOf(int node, int count) {
  return static_cast<double>(node) / (count - 1);
}

}  // namespace

NaturalSpline::NaturalSpline(int knot_count) {
  if (knot_count < 2) throw BadParameter("number of knots of a spline", fmt::format("{}", knot_count), "be at least 2");
  // Continuous first derivatives: M_{i-1} + 4 M_i + M_{i+1} = 6 (y_{i-1} - 2 y_i + y_{i+1}), M = 0 at both ends.
  Eigen::MatrixXd left = Eigen::MatrixXd::Identity(knot_count, knot_count);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(knot_count, knot_count);
  for (int i = 1; i + 1 < knot_count; ++i) {
    left.row(i).segment(i - 1, 3) << 1, 4, 1;
    right.row(i).segment(i - 1, 3) << 6, -12, 6;
  }
  curvatures_ = left.partialPivLu().solve(right);
}

Eigen::VectorXd NaturalSpline::weights(double x) const {
  const int interval_count = knotCount() - 1;
  const double along = x * interval_count;
  const int first = std::clamp(static_cast<int>(std::floor(along)), 0, interval_count - 1);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(knotCount());
  const double to = along - first, from = 1 - to;
  result(first) = from;
  result(first + 1) = to;
  // Outside the knots the spline continues as a straight line with the slope at its end.
  const double inside = std::clamp(to, 0.0, 1.0), beyond = to - inside, rest = 1 - inside;
  const double bend_first = (rest * rest * rest - rest) / 6 - beyond * (3 * rest * rest - 1) / 6;
  const double bend_second = (inside * inside * inside - inside) / 6 + beyond * (3 * inside * inside - 1) / 6;
  return result + (bend_first * curvatures_.row(first) + bend_second * curvatures_.row(first + 1)).transpose();
}

ForceMapTable::ForceMapTable(Parameters& p)
    : shortest_ratio(p.number("force_law.map_shortest_ratio", 0.4, "", 0, 10, "map: length of the first node over the rest length")),
      longest_ratio(p.number("force_law.map_longest_ratio", 1, "", 0, 10, "map: length of the last node over the rest length")) {
  const int pressure_count = p.integer("force_law.map_pressure_count", 3, 2, most_nodes, "map: number of pressures from 0 to 1");
  const int length_count = p.integer("force_law.map_length_count", 7, 2, most_nodes, "map: number of lengths");
  force_N.resize(pressure_count, length_count);
  for (int i = 0; i < pressure_count; ++i)
    for (int j = 0; j < length_count; ++j) {
      const double pressure = gridPositionOf(i, pressure_count);
      const double length = shortest_ratio + (longest_ratio - shortest_ratio) * gridPositionOf(j, length_count);
      force_N(i, j) = p.number(fmt::format("force_law.map_force_{}_{}_N", i, j), defaultForceN(pressure, length), "N", -1e6, 1e6,
                               fmt::format("map: force at pressure {:.4g}, relative length {:.4g}", pressure, length));
    }
}

ForceMap::ForceMap(double rest_length_mm, const ForceMapTable& table)
    : rest_length_mm_(rest_length_mm),
      table_(table),
      over_pressure_(static_cast<int>(table.force_N.rows())),
      over_length_(static_cast<int>(table.force_N.cols())) {
  requireLengthAndConstants("the force map", rest_length_mm, {table.force_N.sum()});
  if (!(table_.shortest_ratio >= 0 && table_.shortest_ratio < table_.longest_ratio && std::isfinite(table_.longest_ratio)))
    throw BadParameter("first and last length of the force map", fmt::format("{}, {}", table_.shortest_ratio, table_.longest_ratio),
                       "be in order and finite");
}

double ForceMap::tensionN(double pressure_ratio, double length_mm) const {
  return std::max(0.0, formulaN(pressure_ratio, length_mm));
}

double ForceMap::formulaN(double pressure_ratio, double length_mm) const {
  const double along = (length_mm / rest_length_mm_ - table_.shortest_ratio) / (table_.longest_ratio - table_.shortest_ratio);
  return over_pressure_.weights(pressure_ratio).dot(table_.force_N * over_length_.weights(along));
}

}  // namespace musclesim
