#include "musclesim/controller/aasm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double largest_activity = 100.0;

AdaptiveAttractors drawAttractors(const ControllerRequest& request) {
  auto& parameters = request.parameters;
  const int count = parameters.integer("aasm.attractor_count", 500, 1, 100000, "number of attractors");
  const double width = parameters.number("aasm.width", 0.25, "", 1e-3, 1e3, "standard deviation of the Gaussian about each attractor");
  const double exponent =
      parameters.number("aasm.attractor_exponent", 0.25, "", 1e-3, 100,
                        "exponent of the entries' distribution: 1 uniform in -1 .. 1; smaller ones gather them near -1 and 1");
  const double rate = parameters.number("aasm.learning_rate", 0.01, "", 0, 1,
                                        "share of its distance to the state that an attractor moves per control step");
  const int period = parameters.integer("aasm.update_period", 100, 1, 1000000, "control steps between replacements of the attractors");
  RandomStream stream(request.seed, "aasm.attractors");
  return {AttractorMixture::random(request.muscle_count, count, width, exponent, stream), rate, period};
}

}  // namespace

AasmActivity::AasmActivity(Parameters& parameters)
    : length_mm_(parameters.number("aasm.length_mm", 100, "mm", 1e-3, 1e5, "distance from the target that counts as an error of 1")),
      e_min_(parameters.number("aasm.error_floor", 0.1, "", 1e-6, 1e6, "added to the squared error, so that its inverse is finite")),
      mean_a_(parameters.number("aasm.discount", 0.9999, "", 1e-3, 1, "discount factor of the past per control step")) {}

double AasmActivity::update(double d_mm) {
  const double e = std::pow(d_mm / length_mm_, 2);
  const double a = 1.0 / (e + e_min_);
  const double rise = a - mean_a_.meanOr(a);
  mean_a_.add(a);
  return std::clamp(100.0 * rise + 25.0 * std::exp(-e * e / 2.0), 0.0, largest_activity);
}

AdaptiveAttractors::AdaptiveAttractors(AttractorMixture mixture, double rate, int period)
    : mixture_(std::move(mixture)), averages_(mixture_.attractors()), rate_(rate), period_(period) {
  if (!(rate >= 0 && rate <= 1)) throw BadParameter("learning rate", fmt::format("{}", rate), "lie in 0 .. 1");
  if (period < 1) throw BadParameter("update period", fmt::format("{}", period), "be at least 1");
}

void AdaptiveAttractors::update(const Eigen::VectorXd& x, double weight) {
  if (weight > 0) {
    const Eigen::RowVectorXd share = (rate_ * weight * mixture_.weights(x)).transpose();
    averages_ += (x.replicate(1, averages_.cols()) - averages_) * share.asDiagonal();
  }
  if (++since_replaced_ < period_) return;
  since_replaced_ = 0;
  mixture_.replace(averages_);
}

AasmController::AasmController(const ControllerRequest& request)
    : target_(Target::make(request)),
      activity_(request.parameters),
      timer_(request),
      adaptive_(drawAttractors(request)),
      noise_(request.seed, "aasm.noise"),
      x_(Eigen::VectorXd::Zero(request.muscle_count)) {
  auto& parameters = request.parameters;
  const double h = parameters.number("aasm.step_ratio", 0.01, "", 1e-6, 1e3, "length of one Langevin step");
  const double time_constant = parameters.number("aasm.time_constant", 0.1, "", 1e-6, 1e3, "time constant of the state");
  const double variance = parameters.number("aasm.noise_variance", 0.36, "", 0, 100, "variance of the fluctuation per time constant");
  steps_per_decision_ = parameters.integer("aasm.steps_per_decision", 100, 1, 100000, "Langevin steps per decision");
  pull_per_activity_ = h / time_constant;
  noise_std_ = std::sqrt(variance * h / time_constant);
}

Action AasmController::output(const State& state) {
  const double activity = activity_.update(target_.distanceMm(state));
  adaptive_.update(x_, activity / largest_activity);
  if (timer_.due()) decide(activity);
  return pressures(x_);
}

void AasmController::decide(double activity) {
  decision_activity_ = activity;
  for (int i = 0; i < steps_per_decision_; ++i)
    x_ = fluctuated(x_, adaptive_.mixture(), pull_per_activity_ * activity, noise_std_, noise_);  // Eq. 5
}

}  // namespace musclesim
