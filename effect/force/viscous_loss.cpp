#include "viscous_loss.h"

#include <cmath>

#include "musclesim/base/units.h"
#include "musclesim/robot/world.h"

namespace musclesim {

namespace {

constexpr double stable_mass_g = 10;

}  // namespace

EffectInfo ViscousLoss::info() {
  return {.id = "viscous_loss",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "a muscle resists changes of its length in proportion to their speed",
          .equation = "F' = F + B dl/dt    F tension, l length, B = damping_Ns_per_m, times shortening_ratio while l gets shorter",
          .signature = "the loop of tension over length gets wider with speed",
          .source = "Reynolds et al. 2003: 1570 (relaxing) to 2900 N s/m (contracting)",
          .parameters = {{"damping_Ns_per_m", "N s/m", 0, 0, 1e5, 20, 3000, "B while the muscle gets longer"},
                         {"shortening_ratio", "", 1, 0, 100, 0.5, 2, "ratio of B while the muscle gets shorter to B while it gets longer",
                          true}},
          .make = [](const EffectValues& values) {
            const double damping = values["damping_Ns_per_m"];
            return std::make_unique<ViscousLoss>(damping, damping * values["shortening_ratio"]);
          }};
}

ViscousLoss::ViscousLoss(double lengthening_Ns_per_m, double shortening_Ns_per_m)
    : lengthening_Ns_per_mm_(lengthening_Ns_per_m / mm_per_m), shortening_Ns_per_mm_(shortening_Ns_per_m / mm_per_m) {}

double ViscousLoss::lossAfter(double rate_mm_per_s, double h_s) const {
  const double damping = rate_mm_per_s > 0 ? lengthening_Ns_per_mm_ : shortening_Ns_per_mm_;
  if (!(h_s > 0) || damping == 0) return damping * rate_mm_per_s;
  const double stiffness_N_per_mm = stable_mass_g / (h_s * h_s) / world().physics().force_per_N;
  const double kept = std::exp(-h_s * stiffness_N_per_mm / damping);
  return loss_N_ * kept + damping * rate_mm_per_s * (1 - kept);
}

double ViscousLoss::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  // A query without a step (h_s = 0) returns the tension of the next step.
  return below(input) + lossAfter(input.rate_mm_per_s, input.time.h_s > 0 ? input.time.h_s : step_s_);
}

void ViscousLoss::advance(const MuscleInput& input) {
  loss_N_ = lossAfter(input.rate_mm_per_s, input.time.h_s);
  step_s_ = input.time.h_s;
}

}  // namespace musclesim
