#include "contribution.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cause.h"
#include "musclesim/base/error.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim::blind {

namespace {

constexpr double most_tolerances = 2;  ///< by which a number may differ from its nominal value, unless the plant's differs more

/// One number that may stand in for a cause: value = at_zero + z scale, or at_zero exp(z scale) if it is a ratio.
struct Coordinate {
  std::string name;
  std::size_t law = 0;  ///< index of the other cause; unused for a number of the plant
  bool is_number = false, is_ratio = false;
  double at_zero = 0, scale = 1, least = 0, most = 0;
  double valueAt(double z) const { return std::clamp(is_ratio ? at_zero * std::exp(z * scale) : at_zero + z * scale, least, most); }
};

/// A plant without one cause, as a function of what may stand in for it.
class Remainder {
 public:
  Remainder(const std::vector<ActiveEffect>& others, const Truth::Motion& motion, const Truth& truth, const NumberErrors& numbers)
      : others_(others), motion_(motion), truth_(truth) {
    for (std::size_t i = 0; i < others.size(); ++i) addLaw(i);
    for (const auto& [name, tolerance] : numbers.tolerance) {
      const auto truth_of = numbers.truth.find(name);
      const double nominal = numbers.nominal.at(name),
                   eta = truth_of == numbers.truth.end() ? 0 : std::log(truth_of->second / nominal) / tolerance;
      const double most = std::max(most_tolerances, std::abs(eta));
      coordinates_.push_back(
          {name, 0, true, true, nominal, tolerance, nominal * std::exp(-most * tolerance), nominal * std::exp(most * tolerance)});
      start_.push_back(eta);
    }
  }

  Eigen::VectorXd start() const { return Eigen::Map<const Eigen::VectorXd>(start_.data(), static_cast<Eigen::Index>(start_.size())); }

  /// Empty where the plant diverges or a law refuses its parameters.
  std::optional<Truth::Motion> motionAt(const Eigen::VectorXd& z) const {
    std::vector<ActiveEffect> laws = others_;
    std::map<std::string, double> numbers;
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const Coordinate& one = coordinates_[k];
      const double value = one.valueAt(z[static_cast<Eigen::Index>(k)]);
      if (one.is_number)
        numbers[one.name] = value;
      else
        laws[one.law].parameters[one.name] = value;
    }
    try {
      Truth::Motion moved = truth_.motion(laws, numbers);
      if (std::isfinite(truth_.gapOverNoise(truth_.rmse(moved, motion_)))) return moved;
    } catch (const BadParameter&) {
    } catch (const BadFile&) {  // a robot file whose numbers make no body
    }
    return {};
  }

  /// Plant minus `moved` in noise floors, so that the square of a signal's part is (RMSE / noise)^2.
  Eigen::VectorXd residual(const Truth::Motion& moved) const {
    std::vector<double> values;
    double row_count = 0;
    for (const Recording& recording : motion_) row_count += static_cast<double>(recording.time_s.size());
    for (std::size_t r = 0; r < motion_.size(); ++r)
      for (const auto& [name, noise] : truth_.noiseStd()) {
        const std::vector<double>&measured = motion_[r].find(name)->values, &model = moved[r].find(name)->values;
        for (std::size_t i = 0; i < measured.size(); ++i) {
          const double difference = (measured[i] - model[i]) / noise / std::sqrt(row_count);
          values.push_back(std::isfinite(difference) ? difference : 0);  // a reading that a sensor lost
        }
      }
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

 private:
  void addLaw(std::size_t law) {
    for (const EffectParameter& p : effectInfo(others_[law].id).parameters) {
      const auto given = others_[law].parameters.find(p.name);
      if (p.shape || countsBits(p) || given == others_[law].parameters.end()) continue;
      const double value = std::get<double>(given->second);
      if (!std::isfinite(value) || value == p.neutral) continue;
      const bool is_ratio = !std::isfinite(p.neutral);
      coordinates_.push_back({p.name, law, false, is_ratio, value, is_ratio ? 1 : std::abs(value - p.neutral), p.minimum, p.maximum});
      start_.push_back(0);
    }
  }

  const std::vector<ActiveEffect>& others_;
  const Truth::Motion& motion_;
  const Truth& truth_;
  std::vector<Coordinate> coordinates_;
  std::vector<double> start_;
};

struct Point {
  Eigen::VectorXd z, residual;
  Truth::Motion motion;
  double cost = std::numeric_limits<double>::infinity();
};

Point pointAt(const Remainder& remainder, const Eigen::VectorXd& z) {
  auto motion = remainder.motionAt(z);
  if (!motion) return {.z = z, .residual = {}, .motion = {}};
  Point point{.z = z, .residual = remainder.residual(*motion), .motion = std::move(*motion)};
  point.cost = point.residual.squaredNorm();
  return point;
}

/// Derivatives of the model by the coordinates, columns; 0 where the plant beside diverges.
Eigen::MatrixXd slopesAt(const Remainder& remainder, const Point& point) {
  constexpr double difference = 0.1;  // of a coordinate
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(point.residual.size(), point.z.size());
  for (Eigen::Index k = 0; k < point.z.size(); ++k) {
    Eigen::VectorXd moved = point.z;
    moved[k] += difference;
    if (const auto motion = remainder.motionAt(moved)) slopes.col(k) = (point.residual - remainder.residual(*motion)) / difference;
  }
  return slopes;
}

/// One step of Gauss and Newton, shortened until it gains, and a rank-one update of the slopes (Broyden 1965). False if it gains nothing
/// worth another one.
bool stepDown(const Remainder& remainder, Eigen::MatrixXd& slopes, Point& best) {
  constexpr double worth = 0.02;  // of the cost
  constexpr double shares[] = {1, 0.3, 0.1};
  Eigen::MatrixXd normal = slopes.transpose() * slopes;
  normal.diagonal() = normal.diagonal() * 1.01 + Eigen::VectorXd::Constant(normal.rows(), 1e-6);
  const Eigen::VectorXd whole = normal.ldlt().solve(slopes.transpose() * best.residual).cwiseMax(-2).cwiseMin(2);
  for (const double share : shares) {
    const Eigen::VectorXd step = share * whole;
    Point next = pointAt(remainder, best.z + step);
    if (next.cost >= best.cost) continue;
    const bool is_worth_another = next.cost < (1 - worth) * best.cost;
    slopes += (best.residual - next.residual - slopes * step) * step.transpose() / step.squaredNorm();
    best = std::move(next);
    return is_worth_another;
  }
  return false;
}

}  // namespace

std::map<std::string, double> contributionBeside(const std::vector<ActiveEffect>& others, const Truth::Motion& motion, const Truth& truth,
                                                 const NumberErrors& numbers) {
  constexpr int most_steps = 6;
  const Remainder remainder(others, motion, truth, numbers);
  Point best = pointAt(remainder, remainder.start());
  std::map<std::string, double> result;
  if (best.motion.empty()) {
    for (const auto& [name, noise] : truth.noiseStd()) result[name] = std::numeric_limits<double>::quiet_NaN();
    return result;
  }
  if (best.z.size() > 0) {
    Eigen::MatrixXd slopes = slopesAt(remainder, best);
    for (int step = 0; step < most_steps && stepDown(remainder, slopes, best);) ++step;
  }
  result = truth.rmse(best.motion, motion);
  for (auto& [name, value] : result) value /= truth.noiseStd().at(name);
  return result;
}

}  // namespace musclesim::blind
