#include "braid_hysteresis.h"

#include <algorithm>
#include <cmath>

namespace musclesim {

EffectInfo BraidHysteresis::info() {
  return {.id = "braid_hysteresis",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "the threads of the braid rub on each other",
          .equation = "F' = F - w |F| z, dz = -dl / s within -1 <= z <= 1    F tension, l length, w = relative_width, s = presliding_mm",
          .signature = "loop of pressure over length whose width grows with pressure and does not depend on speed",
          .source = "Maxwell slip element, Iwan 1966; friction of braid muscles, Chou and Hannaford 1996",
          .parameters = {{"relative_width", "", 0, 0, 1, 0.01, 0.12, "w, half the loop's width as a share of the tension"},
                         {"presliding_mm", "mm", 1, 0.01, 50, 0.5, 3, "s, displacement until the threads slide", true}},
          .make = [](const EffectValues& values) {
            return std::make_unique<BraidHysteresis>(values["relative_width"], values["presliding_mm"]);
          }};
}

double BraidHysteresis::playAt(double length_mm) const {
  return std::clamp(play_ - (length_mm - length_mm_) / presliding_mm_, -1.0, 1.0);
}

double BraidHysteresis::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  const double tension_N = below(input);
  return tension_N - width_ * std::abs(tension_N) * playAt(input.length_mm);
}

void BraidHysteresis::advance(const MuscleInput& input) {
  play_ = playAt(input.length_mm);
  length_mm_ = input.length_mm;
}

void BraidHysteresis::settle(const MuscleInput& input) {
  play_ = 0;
  length_mm_ = input.length_mm;
}

}  // namespace musclesim
