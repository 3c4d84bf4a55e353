#include "law_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "intervals.h"
#include "law_families.h"
#include "least_squares.h"
#include "musclesim/base/error.h"
#include "point_checks.h"

namespace musclesim {

namespace {

/// Law minus measurement at a point, in N. A small measured force is compared with the tension, which is 0 where the law's formula would
/// push: there the muscle is slack. A larger force is compared with the formula, so that a search that starts with a slack muscle has a
/// gradient. For a censored point only an excess over the floor counts.
double offN(const ForceLaw& law, const StaticPoint& point, double floor_N, double force_scale_N) {
  constexpr double small_share = 0.05;
  if (point.censored) return std::max(0.0, law.formulaN(point.pressure_ratio, point.length_mm) - floor_N);
  const bool is_small = point.force_N < small_share * force_scale_N;
  return (is_small ? law.tensionN(point.pressure_ratio, point.length_mm) : law.formulaN(point.pressure_ratio, point.length_mm)) -
         point.force_N;
}

/// The points as a least-squares problem. `loss_N`: scale of Cauchy's loss, 0 for plain squares.
LeastSquaresProblem problemOf(const LawModel& model, const StaticPoints& points, double loss_N) {
  LeastSquaresProblem problem;
  std::vector<StaticPoint> used;
  for (const auto& point : points.points)
    if (!point.outlier) used.push_back(point);
  const auto count = static_cast<Eigen::Index>(used.size());
  problem.residuals = [&model, used, count, floor_N = points.floor_N, force_scale_N = points.largestForceN(), loss_N](
                          const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    const auto law = model.build(x);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto& point = used[static_cast<std::size_t>(i)];
      const double off_N = offN(*law, point, floor_N, force_scale_N);
      r(i) = loss_N > 0 ? std::copysign(loss_N * std::sqrt(std::log1p(off_N * off_N / (loss_N * loss_N))), off_N) : off_N;
    }
    r.tail(r.size() - count) = std::sqrt(static_cast<double>(count)) * model.penaltiesN(x);
  };
  problem.residual_count = static_cast<int>(count + model.penaltiesN(model.starts().front()).size());
  const auto& parameters = model.parameters();
  problem.lowest.resize(static_cast<Eigen::Index>(parameters.size()));
  problem.highest = problem.lowest;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    problem.lowest(static_cast<Eigen::Index>(i)) = parameters[i].lowest;
    problem.highest(static_cast<Eigen::Index>(i)) = parameters[i].highest;
  }
  return problem;
}

/// Robust standard deviation of the measured points from a law: 1.4826 times the median distance (exact for normal errors).
double robustDeviationN(const ForceLaw& law, const StaticPoints& points) {
  std::vector<double> off_N;
  for (const auto& point : points.measured()) off_N.push_back(std::abs(offN(law, point, points.floor_N, points.largestForceN())));
  std::nth_element(off_N.begin(), off_N.begin() + static_cast<std::ptrdiff_t>(off_N.size() / 2), off_N.end());
  constexpr double deviation_per_median = 1.4826;
  return deviation_per_median * off_N[off_N.size() / 2];
}

double largestOffN(const ForceLaw& law, const StaticPoints& points) {
  double largest_N = 0;
  for (const auto& point : points.points)
    largest_N = std::max(largest_N, std::abs(offN(law, point, points.floor_N, points.largestForceN())));
  return largest_N;
}

/// Warns of a law that pushes between no pressure and the highest, at the measured lengths.
void warnOfPush(const ForceLaw& law, const StaticPoints& points, std::vector<std::string>& warnings) {
  constexpr int steps = 20;
  constexpr double noticeable_share = 0.01;
  double highest_ratio = 0;
  for (const auto& point : points.points) highest_ratio = std::max(highest_ratio, point.pressure_ratio);
  StaticPoint worst;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const double pressure_ratio = highest_ratio * i / steps;
      const double length_mm = points.shortestMm() + (points.longestMm() - points.shortestMm()) * j / steps;
      const double tension_N = law.tensionN(pressure_ratio, length_mm);
      if (tension_N < worst.force_N) worst = {pressure_ratio, length_mm, tension_N};
    }
  if (-worst.force_N < noticeable_share * points.largestForceN()) return;
  const std::string where = worst.pressure_ratio == 0 ? "when vented" : fmt::format("at {:.3g} of full scale", worst.pressure_ratio);
  warnings.push_back(fmt::format("{} pushes with up to {:.3g} N {}, at {:.4g} mm; no muscle can, and a simulated one is slack there",
                                 law.name(), -worst.force_N, where, worst.length_mm));
}

/// d constants / d parameters.
Eigen::MatrixXd constantsJacobian(const LawModel& model, const Eigen::VectorXd& x) {
  LeastSquaresProblem problem;
  problem.residuals = [&](const Eigen::VectorXd& at, Eigen::VectorXd& constants) { constants = model.constantsAt(at); };
  problem.residual_count = static_cast<int>(model.constants().size());
  problem.lowest = Eigen::VectorXd::Constant(x.size(), -1e300);
  problem.highest = -problem.lowest;
  return jacobianOf(problem, x);
}

/// Intervals and warnings of a fit whose parameters are known.
class Judgement {
 public:
  Judgement(const LawModel& model, const StaticPoints& points, LawFit& fit) : model_(model), fit_(fit), names_(model.constants()) {
    const LeastSquaresProblem problem = problemOf(model, points, 0);
    Eigen::VectorXd residuals(problem.residual_count);
    problem.residuals(fit.parameters, residuals);
    const Eigen::MatrixXd jacobian = jacobianOf(problem, fit.parameters);
    const Scatter scatter = scatterOf(jacobian, residuals);
    const Eigen::MatrixXd to_constants = constantsJacobian(model, fit.parameters);
    influence_ = to_constants * scatter.influence;
    variances_ = scatter.variances;
    covariance_ = influence_ * variances_.asDiagonal() * influence_.transpose();
    const Eigen::VectorXd scale = jacobian.colwise().norm().transpose().cwiseMax(1e-300);
    undetermined_ = to_constants * scale.cwiseInverse().asDiagonal() * scatter.undetermined;
  }

  void addConstants() {
    const Eigen::VectorXd values = model_.constantsAt(fit_.parameters);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      FittedConstant constant{names_[i].name, names_[i].unit, values(row), {}, {}};
      if (!isUndetermined(row, values(row))) setInterval(constant, halfWidth(row), names_[i].is_factor);
      fit_.constants.push_back(constant);
    }
  }

  void addWarnings() {
    warnOfUndetermined();
    warnOfCorrelations();
    warnOfBounds();
    if (!fit_.converged) fit_.warnings.push_back("the search ended before it converged; the constants may not be the best");
  }

 private:
  bool isUndetermined(Eigen::Index row, double value) const {
    constexpr double noticeable_ratio = 1e-6;
    return undetermined_.cols() > 0 && undetermined_.row(row).norm() > noticeable_ratio * std::max(std::abs(value), 1e-12) *
                                                                           undetermined_.cwiseAbs().maxCoeff() /
                                                                           std::max(fit_.parameters.cwiseAbs().maxCoeff(), 1e-12);
  }

  /// Half width of the 95 % interval.
  double halfWidth(Eigen::Index row) const {
    const double degrees = std::min(degreesOfFreedom(influence_.row(row).transpose(), variances_),
                                    static_cast<double>(std::max<Eigen::Index>(1, influence_.cols() - influence_.rows())));
    return student975(degrees) * std::sqrt(covariance_(row, row));
  }

  static void setInterval(FittedConstant& constant, double half_width, bool is_factor) {
    const double relative = std::abs(half_width / constant.value);
    if (is_factor && relative < 1) {
      const double one = constant.value * std::exp(-relative), other = constant.value * std::exp(relative);
      constant.low = std::min(one, other);
      constant.high = std::max(one, other);
    } else {
      constant.low = constant.value - half_width;
      constant.high = constant.value + half_width;
    }
  }

  void warnOfUndetermined() {
    std::vector<std::string> names;
    for (const auto& constant : fit_.constants)
      if (!constant.low) names.push_back(constant.name);
    if (!names.empty())
      fit_.warnings.push_back(
          fmt::format("the points do not determine {} separately: many combinations of their values give the same forces; fix one of them",
                      fmt::join(names, ", ")));
  }

  void warnOfCorrelations() {
    constexpr double strong = 0.98;
    for (Eigen::Index i = 0; i < covariance_.rows(); ++i)
      for (Eigen::Index j = 0; j < i; ++j) {
        const auto& a = fit_.constants[static_cast<std::size_t>(j)];
        const auto& b = fit_.constants[static_cast<std::size_t>(i)];
        const double correlation = covariance_(i, j) / std::sqrt(covariance_(i, i) * covariance_(j, j));
        if (a.low && b.low && std::abs(correlation) > strong)
          fit_.warnings.push_back(
              fmt::format("{} and {} can hardly be told apart (correlation {:.4f}): compare them with another muscle's only "
                          "together",
                          a.name, b.name, correlation));
      }
  }

  void warnOfBounds() {
    const auto& parameters = model_.parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const double x = fit_.parameters(static_cast<Eigen::Index>(i));
      for (const double bound : {parameters[i].lowest, parameters[i].highest})
        if (std::abs(x - bound) <= 1e-6 * std::abs(bound))
          fit_.warnings.push_back(fmt::format("{} is at its bound {:g}: the intervals are not valid", parameters[i].name, bound));
    }
  }

  const LawModel& model_;
  LawFit& fit_;
  std::vector<LawConstant> names_;
  Eigen::MatrixXd influence_, covariance_, undetermined_;  ///< rows: constants
  Eigen::VectorXd variances_;                              ///< of the residuals
};

}  // namespace

void FitError::add(const FitError& other) {
  sum_of_squares_N2 += other.sum_of_squares_N2;
  measured_squares_N2 += other.measured_squares_N2;
  count += other.count;
  is_missing = is_missing || other.is_missing;
  if (std::abs(other.largest_N) <= std::abs(largest_N)) return;
  largest_N = other.largest_N;
  largest_line = other.largest_line;
}

FitError errorOf(const ForceLaw& law, const std::vector<StaticPoint>& points) {
  FitError error;
  for (const auto& point : points) {
    if (point.censored || point.outlier) continue;
    const double off_N = law.tensionN(point.pressure_ratio, point.length_mm) - point.force_N;
    error.add({off_N * off_N, point.force_N * point.force_N, off_N, point.line, 1});
  }
  return error;
}

Specimen specimenOf(const StaticPoints& points, std::optional<double> rest_length_mm) {
  return {rest_length_mm.value_or(points.longestMm()), points.shortestMm(), points.largestForceN()};
}

std::size_t fewestPointsFor(const LawModel& model) {
  // For a table few points suffice, since penalties determine what the points do not.
  return model.isTable() ? fewest_points : 2 * model.parameters().size();
}

Eigen::VectorXd fitParameters(const LawModel& model, const StaticPoints& points, const std::vector<Eigen::VectorXd>& starts,
                              bool* converged) {
  const std::size_t needed = fewestPointsFor(model);
  if (points.measured().size() < needed)
    throw BadFile(points.file, fmt::format("{} points above the floor are too few for the law {} with {} constants; at least {} are needed",
                                           points.measured().size(), model.name(), model.parameters().size(), needed));
  const LeastSquaresResult result = minimise(problemOf(model, points, 0), starts);
  if (converged) *converged = result.converged;
  return result.x;
}

LawFit fitLaw(const LawModel& model, const StaticPoints& points) {
  LawFit fit;
  fit.parameters = fitParameters(model, points, model.starts(), &fit.converged);
  fit.error = errorOf(*model.build(fit.parameters), points.points);
  Judgement judgement(model, points, fit);
  judgement.addConstants();
  if (!model.isTable()) judgement.addWarnings();
  warnOfPush(*model.build(fit.parameters), points, fit.warnings);
  return fit;
}

void markOutliers(StaticPoints& points, const Specimen& specimen) {
  constexpr double deviations = 6, force_share = 0.1;
  const double force_limit_N = force_share * specimen.force_scale_N;
  // If a law of six constants is near to all points, none is an outlier; then the costlier map need not be fitted.
  const auto law = makeLawModel("sarosi", specimen, {});
  const auto law_x = minimise(problemOf(*law, points, 0), law->starts()).x;
  if (largestOffN(*law->build(law_x), points) < force_limit_N / 2) return;
  const auto model = makeLawModel("map", specimen, {});
  Eigen::VectorXd x = minimise(problemOf(*model, points, 0), model->starts()).x;
  constexpr double cauchy_per_deviation = 2.385;  // 95 % efficiency for normal errors
  constexpr double least_share = 1e-6;
  double deviation_N = 0;
  for (int round = 0; round < 3; ++round) {
    deviation_N = std::max(robustDeviationN(*model->build(x), points), least_share * specimen.force_scale_N);
    x = minimise(problemOf(*model, points, cauchy_per_deviation * deviation_N), {x}).x;
  }
  const double limit_N = std::max(deviations * deviation_N, force_limit_N);
  const auto map = model->build(x);
  std::vector<std::string> lines;
  for (auto& point : points.points) {
    if (point.censored) continue;
    const double off_N = -offN(*map, point, points.floor_N, specimen.force_scale_N);
    point.outlier = std::abs(off_N) > limit_N;
    if (point.outlier) lines.push_back(fmt::format("{} ({:g} N, {:+.3g} N)", point.line, point.force_N, off_N));
  }
  if (!lines.empty())
    points.notes.push_back(fmt::format("{} points differ by more than {:.3g} N from their neighbours and are left out: lines {}",
                                       lines.size(), limit_N, fmt::join(lines, ", ")));
}

}  // namespace musclesim
