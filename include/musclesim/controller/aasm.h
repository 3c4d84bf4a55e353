/// The adaptive attractor selection model: attractors move towards the states in which the arm was active.
#pragma once

#include "musclesim/controller/attractors.h"
#include "musclesim/controller/controller.h"
#include "musclesim/controller/task.h"

namespace musclesim {

/// Activity of AASM. It is high when the hand is nearer to the target than in the past, or at the target.
///     e = (d / length)^2,   a = 1 / (e + e_min)
///     activity = min(max(100 (a - mean a) + 25 exp(-e^2 / 2), 0), 100)
/// d distance hand-target, mm; length in mm makes e a pure number; e_min keeps a finite. mean a is the discounted mean of the past
/// (DiscountedMean, gamma per control step), a itself at the first step. The activity lies in 0..100.
class AasmActivity {
 public:
  /// Declares aasm.length_mm, aasm.error_floor (e_min) and aasm.discount (gamma).
  explicit AasmActivity(Parameters& parameters);
  /// To be called once per control step; d at least 0 and finite.
  double update(double d_mm);

 private:
  double length_mm_, e_min_;
  DiscountedMean mean_a_;
};

/// Attractors that learn: each moves towards the states that the controller visits near it.
///     m_i <- m_i + rate w N_i(x) (x - m_i)     at every update
///     xi_i <- m_i                              at every period-th update
/// xi_i attractors, m_i running averages that start at them, N_i(x) responsibilities (Eq. 6), w weight of the visit in 0..1, rate in
/// 0..1. Each new m_i lies between the old m_i and x, so all stay in [-1, 1]^n.
class AdaptiveAttractors {
 public:
  /// Throws BadParameter unless rate lies in 0..1 and period is at least 1.
  AdaptiveAttractors(AttractorMixture mixture, double rate, int period);
  void update(const Eigen::VectorXd& x, double weight);
  const AttractorMixture& mixture() const { return mixture_; }

 private:
  AttractorMixture mixture_;
  Eigen::MatrixXd averages_;
  double rate_;
  int period_, since_replaced_ = 0;
};

/// AASM. The state x in [-1, 1]^n, one entry per muscle, follows the Langevin equation
///     time_constant dx/dt = activity f(x) + eta,   eta white with variance noise_variance per time constant
/// At each decision it takes aasm.steps_per_decision discrete steps with the activity held,
///     x <- clip(x + min(h activity / time_constant, 1) f(x) + sqrt(noise_variance h / time_constant) N(0, 1)),   h = aasm.step_ratio
/// The command is p_i = (tanh(3 x_i) + 1) / 2, held until the next decision. Activity (AasmActivity) and attractors (AdaptiveAttractors,
/// weight = activity / 100) are updated at every control step, because the arm follows a decision for seconds and its success must be
/// credited to the state held meanwhile: a 300 s run has 50 decisions, but 30000 updates.
///
/// The structure follows the published program, but its numbers (e in mm^2, width 1/501, a replacement every 6000 s) never moved an
/// attractor. Therefore lengths are dimensionless here, and width, rate, period, floor, step count and noise are chosen anew.
/// Declares aasm.attractor_count, _attractor_exponent, _width, _learning_rate, _update_period, _step_ratio, _time_constant,
/// _noise_variance, _steps_per_decision, those of AasmActivity and the target of the task (either task). Streams "aasm.attractors" and
/// "aasm.noise". output() throws BadParameter if the robot reports no hand, Diverged if that is not finite.  Source: Braun 2007, Section 5.
class AasmController final : public Controller {
 public:
  explicit AasmController(const ControllerRequest& request);

  Action output(const State& state) override;
  std::optional<double> activity() const override { return decision_activity_; }
  std::optional<Vector> targetMm() const override { return target_.point_mm; }
  bool targetIsHeight() const override { return target_.is_height; }
  void moveTarget(const Vector& target_mm) override { target_.point_mm = target_mm; }

  /// State x, n numbers in [-1, 1].
  const Eigen::VectorXd& x() const { return x_; }
  /// n x k matrix, the present attractors.
  const Eigen::MatrixXd& attractors() const { return adaptive_.mixture().attractors(); }

 private:
  void decide(double activity);

  Target target_;
  AasmActivity activity_;
  DecisionTimer timer_;
  AdaptiveAttractors adaptive_;
  RandomStream noise_;
  double pull_per_activity_, noise_std_;
  int steps_per_decision_;
  Eigen::VectorXd x_;
  std::optional<double> decision_activity_;
};

}  // namespace musclesim
