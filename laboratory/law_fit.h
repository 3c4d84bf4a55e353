/// Fits one family of force laws to static points.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "law_model.h"
#include "static_points.h"

namespace musclesim {

/// A fitted constant with its interval.
struct FittedConstant {
  std::string name, unit;
  double value = 0;
  /// Ends of the 95 % interval; empty if the points do not determine the constant. The interval is valid if the law is right and the errors
  /// of the points are independent; the errors may have different sizes.
  std::optional<double> low, high;
};

/// Error of a law over the points that are neither censored nor outliers.
struct FitError {
  double sum_of_squares_N2 = 0, measured_squares_N2 = 0;
  double largest_N = 0;  ///< model minus measurement at the point with the largest magnitude of it
  int largest_line = 0;
  int count = 0;
  bool is_missing = false;  ///< a part of it could not be computed
  bool isDefined() const { return !is_missing && count > 0 && measured_squares_N2 > 0; }
  /// The paper's error function, sum((m - s)^2) / sum(m^2).
  double relativeSquaredError() const { return sum_of_squares_N2 / measured_squares_N2; }
  void add(const FitError& other);
};

FitError errorOf(const ForceLaw& law, const std::vector<StaticPoint>& points);

struct LawFit {
  Eigen::VectorXd parameters;
  bool converged = false;
  FitError error;
  std::vector<FittedConstant> constants;
  std::vector<std::string> warnings;  ///< for example: constants not determined separately, a constant at its bound, no convergence
};

/// The least number of points, neither censored nor outliers, for a fit of this family.
std::size_t fewestPointsFor(const LawModel& model);

/// Minimises sum (F(p, l) - measured)^2 over the points that are not outliers. A censored point adds max(0, F - floor)^2 instead: it counts
/// only if the law is above the floor. Throws BadFile if there are fewer points than it needs.
Eigen::VectorXd fitParameters(const LawModel& model, const StaticPoints& points, const std::vector<Eigen::VectorXd>& starts,
                              bool* converged = nullptr);
/// As above, and computes errors, intervals and warnings.
LawFit fitLaw(const LawModel& model, const StaticPoints& points);

/// Marks the points that lie further than 6 robust standard deviations (1.4826 median |r|) and 10 % of the largest force from a smooth map
/// through all of them, fitted with Cauchy's loss; adds a note. The reference is a smooth map and not a law, since a law may be wrong.
void markOutliers(StaticPoints& points, const Specimen& specimen);

/// Rest length (default: the longest measured), shortest length and largest force.
Specimen specimenOf(const StaticPoints& points, std::optional<double> rest_length_mm);

}  // namespace musclesim
