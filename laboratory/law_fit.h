/// Fits one family of force laws to static points.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "law_model.h"
#include "static_points.h"

namespace musclesim {

/// A constant as the points determine it.
struct FittedConstant {
  std::string name, unit;
  double value = 0;
  /// Ends of the 95 % interval; empty where the points do not determine the constant. They hold where the law is the right one and the
  /// points' errors are independent; the errors may be of different sizes.
  std::optional<double> low, high;
};

/// How far a law is off, over points that are neither censored nor outliers.
struct FitError {
  double sum_of_squares_N2 = 0, measured_squares_N2 = 0;
  double largest_N = 0;  ///< model minus measurement where it is largest in magnitude
  int largest_line = 0;
  int count = 0;
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
  std::vector<std::string> warnings;  ///< constants that cannot be told apart, at a bound, not converged
};

/// Minimises sum (F(p, l) - measured)^2 over the points that are no outliers; a censored point counts only where the law is above the
/// floor: max(0, F - floor)^2. Throws BadFile if there are fewer than two measured points per parameter.
Eigen::VectorXd fitParameters(const LawModel& model, const StaticPoints& points, const std::vector<Eigen::VectorXd>& starts,
                              bool* converged = nullptr);
/// The same, with errors, intervals and warnings.
LawFit fitLaw(const LawModel& model, const StaticPoints& points);

/// Marks the points that lie further than 6 robust standard deviations (1.4826 median |r|) and 10 % of the largest force from a smooth map
/// through all of them, fitted with Cauchy's loss; adds a note. Far from neighbours, not far from a law: a law may be wrong.
void markOutliers(StaticPoints& points, const Specimen& specimen);

/// Rest length (default: the longest measured), shortest length and largest force.
Specimen specimenOf(const StaticPoints& points, std::optional<double> rest_length_mm);

}  // namespace musclesim
