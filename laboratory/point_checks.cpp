#include "point_checks.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "musclesim/base/error.h"
#include "point_groups.h"

namespace musclesim {

namespace {

/// Largest plausible ratio of the longest to the shortest length of a muscle; in the paper's rigs it is at most 5.8.
constexpr double largest_length_quotient = 8;

/// A pressure as text for messages.
std::string pressureText(const StaticPoints& points, double ratio) {
  return points.full_scale_kPa ? fmt::format("{:g} kPa", ratio * *points.full_scale_kPa) : fmt::format("{:g}", ratio);
}

void requireTwoOfEach(const StaticPoints& points) {
  const auto& first = points.points.front();
  if (groupByPressure(points.points).size() < 2)
    throw BadFile(points.file, first.line, 0,
                  fmt::format("all {} points have the pressure {}: at least 2 pressures (better 5 or more, from low to "
                              "full) are needed to tell how the force grows with pressure",
                              points.points.size(), pressureText(points, first.pressure_ratio)));
  if (groupByLength(points.points).size() < 2)
    throw BadFile(points.file, first.line, 0,
                  fmt::format("all {} points have the length {:g} mm: at least 2 lengths (better 4 or more) are needed to tell "
                              "how the force changes with length",
                              points.points.size(), first.length_mm));
}

void requireOneMusclesLengths(const StaticPoints& points) {
  const double shortest_mm = points.shortestMm(), longest_mm = points.longestMm();
  if (longest_mm <= largest_length_quotient * shortest_mm) return;
  for (const auto& point : points.points)
    if (point.length_mm == shortest_mm)
      throw BadFile(points.file, point.line, 0,
                    fmt::format("length {:g} mm, but another is {:g} mm: no muscle extends to more than {:g} times its shortest length; "
                                "are the columns swapped, or several muscles in one file (--where column=value)?",
                                shortest_mm, longest_mm, largest_length_quotient));
}

/// Fits the plane F = g + g_p p + g_l l to the measured points; it must rise with both p and l.
void requireRisingForce(const StaticPoints& points) {
  const auto measured = points.measured();
  Eigen::MatrixXd columns(measured.size(), 3);
  Eigen::VectorXd forces_N(measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    columns.row(row) << 1, measured[i].pressure_ratio, measured[i].length_mm / points.longestMm();
    forces_N(row) = measured[i].force_N;
  }
  const Eigen::VectorXd slopes_N = columns.colPivHouseholderQr().solve(forces_N);
  const auto refuse = [&](const std::string& with) {
    throw BadFile(points.file,
                  fmt::format("the force falls with {} ({:.3g} N over the whole range, slope of the fitted plane; must grow): a "
                              "muscle pulls harder at higher pressure and at greater length; are columns swapped?",
                              with, with == "pressure" ? slopes_N(1) : slopes_N(2) * (1 - points.shortestMm() / points.longestMm())));
  };
  if (slopes_N(1) <= 0) refuse("pressure");
  if (slopes_N(2) <= 0) refuse("length");
}

}  // namespace

void requirePoints(const StaticPoints& points, const StaticPointsOptions& options) {
  if (points.points.size() >= fewest_points) return;
  throw BadFile(points.file, fmt::format("{} points{}; at least {} are needed, at several pressures and several lengths",
                                         points.points.size(), options.where.empty() ? "" : " pass the filter --where", fewest_points));
}

void requireMuscle(const StaticPoints& points) {
  requireTwoOfEach(points);
  requireOneMusclesLengths(points);
  if (points.measured().size() < fewest_points)
    throw BadFile(points.file, fmt::format("only {} of {} points are above the floor of {:g} N; at least {} are needed",
                                           points.measured().size(), points.points.size(), points.floor_N, fewest_points));
  requireRisingForce(points);
}

}  // namespace musclesim
