#include "musclesim/controller/asm.h"

namespace musclesim {

namespace {

AttractorMixture drawMixture(const ControllerRequest& request) {
  auto& parameters = request.parameters;
  const int count = parameters.integer("asm.attractor_count", 400, 1, 100000, "number of random attractors");
  const double width = parameters.number("asm.width", 0.25, "", 1e-3, 1e3, "standard deviation of the Gaussian about each attractor");
  const double exponent =
      parameters.number("asm.attractor_exponent", 0.25, "", 1e-3, 100,
                        "exponent of the entries' distribution: 1 uniform in -1 .. 1; smaller ones gather them near -1 and 1");
  RandomStream stream(request.seed, "asm.attractors");
  return AttractorMixture::random(request.muscle_count, count, width, exponent, stream);
}

}  // namespace

AsmController::AsmController(const ControllerRequest& request)
    : task_(Task::make(request)),
      timer_(request),
      mixture_(drawMixture(request)),
      noise_(request.seed, "asm.noise"),
      step_ratio_(
          request.parameters.number("asm.step_ratio", 1.2, "", 0, 1e6, "length of one step; times the activity it is limited to 1")),
      noise_std_(request.parameters.number("asm.noise_std", 0.2, "", 0, 10, "standard deviation of the fluctuation in one step")),
      steps_per_decision_(request.parameters.integer("asm.steps_per_decision", 200, 1, 100000, "steps of the state per decision")),
      x_(Eigen::VectorXd::Zero(request.muscle_count)) {}

Action AsmController::output(const State& state) {
  if (timer_.due()) decide(state);
  return pressures(x_);
}

void AsmController::decide(const State& state) {
  activity_ = task_->activity(state);
  for (int i = 0; i < steps_per_decision_; ++i) x_ = fluctuated(x_, mixture_, step_ratio_ * *activity_, noise_std_, noise_);  // Eq. 5
}

}  // namespace musclesim
