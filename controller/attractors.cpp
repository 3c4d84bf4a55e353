#include "musclesim/controller/attractors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"

namespace musclesim {

AttractorMixture::AttractorMixture(Eigen::MatrixXd attractors, double width) : attractors_(std::move(attractors)), width_(width) {
  if (attractors_.size() == 0) throw BadParameter("attractors: there must be at least one, of dimension 1 or more");
  if (!(width > 0) || !std::isfinite(width)) throw BadParameter("width", fmt::format("{}", width), "be finite and above 0");
}

AttractorMixture AttractorMixture::random(int n, int k, double width, double exponent, RandomStream& stream) {
  Eigen::MatrixXd attractors(n, k);
  for (auto& entry : attractors.reshaped()) {
    const double u = stream.uniform(-1.0, 1.0);
    entry = std::copysign(std::pow(std::abs(u), exponent), u);
  }
  return {attractors, width};
}

Eigen::VectorXd AttractorMixture::weights(const Eigen::VectorXd& x) const {
  const auto& xi = attractors_;
  // Eq. 6: the factor exp(-largest) cancels in N_i = g_i / sum_j g_j and keeps at least one g_j at 1.
  const Eigen::ArrayXd exponent = (xi.colwise() - x).colwise().squaredNorm().transpose().array() / (-2.0 * width_ * width_);
  const Eigen::ArrayXd g = (exponent - exponent.maxCoeff()).exp();
  return g / g.sum();
}

Eigen::VectorXd AttractorMixture::drift(const Eigen::VectorXd& x) const {
  return attractors_ * weights(x) - x;  // Eq. 6, with sum_i N_i = 1
}

void AttractorMixture::replace(const Eigen::MatrixXd& attractors) {
  if (attractors.rows() != attractors_.rows() || attractors.cols() != attractors_.cols())
    throw BadParameter("attractors: the new ones must have the shape of the old ones");
  attractors_ = attractors;
}

Eigen::VectorXd fluctuated(const Eigen::VectorXd& x, const AttractorMixture& mixture, double step_times_activity, double noise_std,
                           RandomStream& noise) {
  const double pull = std::clamp(step_times_activity, 0.0, 1.0);
  Eigen::VectorXd next = x;
  if (pull > 0) next += pull * mixture.drift(x);  // Eq. 5
  for (auto& entry : next) entry += noise_std * noise.normal();
  return next.cwiseMax(-1.0).cwiseMin(1.0);
}

Action pressures(const Eigen::VectorXd& x) {
  Action action(static_cast<std::size_t>(x.size()));
  std::transform(x.begin(), x.end(), action.begin(), [](double entry) { return (std::tanh(3.0 * entry) + 1.0) / 2.0; });
  return action;
}

void DiscountedMean::add(double value) {
  A_ = gamma_ * (value + A_);  // Eq. 9
  B_ = gamma_ * (1.0 + B_);
}

DecisionTimer::DecisionTimer(double interval_s, double step_s) {
  const auto requirePositive = [](const std::string& name, double value) {
    if (!(value > 0) || !std::isfinite(value)) throw BadParameter(name, fmt::format("{} s", value), "be finite and above 0 s");
  };
  requirePositive("step", step_s);
  requirePositive("decision interval", interval_s);
  const double steps = std::max(1.0, std::round(interval_s / step_s));
  if (!(steps < 1e9)) throw BadParameter("decision interval", fmt::format("{} s", interval_s), "be less than 1e9 control steps");
  steps_ = static_cast<int>(steps);
}

bool DecisionTimer::due() {
  if (next_in_ > 0) {
    --next_in_;
    return false;
  }
  next_in_ = steps_ - 1;
  return true;
}

}  // namespace musclesim
