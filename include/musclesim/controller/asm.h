/// The attractor selection model: fluctuation makes the pressures wander until an attractor gives high activity, where they stay.
#pragma once

#include <memory>

#include "musclesim/controller/attractors.h"
#include "musclesim/controller/controller.h"
#include "musclesim/controller/task.h"

namespace musclesim {

/// ASM. At every decision the state x in [-1, 1]^n, one entry per muscle, follows
///     dx/dt = alpha f(x) + eta                                  (Eq. 5)
/// with the activity alpha of the task, the pull f(x) of random attractors (Eq. 6, AttractorMixture) and Gaussian white noise eta.
/// Implemented form: asm.steps_per_decision steps
///     x <- clip(x + min(max(step alpha, 0), 1) f(x) + noise_std N(0, 1))
/// with alpha constant during these steps; all quantities are pure numbers. The command is p_i = (tanh(3 x_i) + 1) / 2, held until the next
/// decision. If alpha is 0, x does a random walk of noise_std sqrt(steps) per decision; if step alpha is near 1, x stays within about
/// noise_std of an attractor. x starts at 0, where all pressures are one half.
///
/// Declares asm.attractor_count, asm.attractor_exponent, asm.width, asm.step_ratio (step), asm.noise_std, asm.steps_per_decision and the
/// parameters of the task. Streams "asm.attractors" and "asm.noise". output() throws BadParameter if the robot reports no hand, Diverged if
/// that is not finite. Source: Kashiwagi, Urabe, Kaneko and Yomo 2006; for the arm Braun 2007, Section 5.
class AsmController final : public Controller {
 public:
  explicit AsmController(const ControllerRequest& request);

  Action output(const State& state) override;
  /// May be negative; a negative activity acts as 0.
  std::optional<double> activity() const override { return activity_; }
  std::optional<Vector> targetMm() const override { return task_->targetMm(); }
  bool targetIsHeight() const override { return task_->targetIsHeight(); }
  void moveTarget(const Vector& target_mm) override { task_->moveTarget(target_mm); }

  /// State x, n numbers in [-1, 1].
  const Eigen::VectorXd& x() const { return x_; }

 private:
  void decide(const State& state);

  std::unique_ptr<Task> task_;
  DecisionTimer timer_;
  AttractorMixture mixture_;
  RandomStream noise_;
  double step_ratio_, noise_std_;
  int steps_per_decision_;
  Eigen::VectorXd x_;
  std::optional<double> activity_;
};

}  // namespace musclesim
