#include "slide_friction.h"

#include "../presliding.h"

namespace musclesim {

EffectInfo SlideFriction::info() {
  return {.id = "slide_friction",
          .stage = Stage::body,
          .acts_on = {ComponentKind::slide},
          .summary = "dry friction of a load that slides on a guide",
          .equation =
              "force = -F_c sign(dx/dt), at rest within -F_c .. F_c; with presliding d: -F_c z, dz = (1 - z sgn(dx))^i dx / d    x "
              "position on the guide, F_c = force_N, d = presliding_mm, i = presliding_exponent",
          .signature = "the width of the loop does not depend on pressure; the muscle's own force shows it; the load sticks at reversals",
          .source = "Coulomb friction as a bounded constraint force; Dahl 1968; Maxwell slip, Al-Bender, Lampaert and Swevers 2005",
          .parameters = {{"force_N", "N", 0, 0, 1e4, 0.5, 10, "F_c"},
                         {"presliding_mm", "mm", 0, 0, 100, 0.05, 1, "d, way over which friction acts like a spring before the load slides",
                          true},
                         {"presliding_exponent", "", 0, 0, 1, 0, 1, "i; 0: the load slides at once, 1: little by little", true}},
          .make = [](const EffectValues& v) {
            return std::make_unique<SlideFriction>(v["force_N"], v["presliding_mm"], v["presliding_exponent"]);
          }};
}

void SlideFriction::attach(const EffectPlace& place) {
  SlideEffect::attach(place);
  if (presliding_mm_ > 0) return;
  addDryFrictionN(force_N_);
}

void SlideFriction::apply(const StepTime& time) {
  if (presliding_mm_ == 0 || !(time.h_s > 0)) return;  // friction does not shift an equilibrium
  share_ = slid(share_, time.h_s * rateMmPerS() / presliding_mm_, exponent_);
  addForceN(-force_N_ * share_);
}

}  // namespace musclesim
