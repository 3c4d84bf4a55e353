#include "braid_hysteresis.h"

#include <algorithm>
#include <cmath>

#include "../presliding.h"
#include "musclesim/robot/actuator.h"

namespace musclesim {

EffectInfo BraidHysteresis::info() {
  return {.id = "braid_hysteresis",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "the threads of the braid rub against each other",
          .equation =
              "F' = F - (w ((1 - c) |F| + c p F_0) + F_c) z, dz = -(1 + z sgn(dl))^i dl / s    F tension, p pressure, F_0 tension at full "
              "pressure and rest length, l length, w = relative_width, F_c = constant_friction_N, s = presliding_mm, c = pressure_share, "
              "i = presliding_exponent",
          .signature = "loop of pressure over length whose width does not depend on speed; it grows with the tension, unless only F_c acts",
          .source =
              "Maxwell slip element, Iwan 1966; Dahl 1968; friction between threads, Tondu and Lopez 2000; constant friction, Chou and "
              "Hannaford 1996",
          .parameters = {{"relative_width", "", 0, 0, 1, 0.01, 0.12,
                          "w, half the loop's width as a share of the tension (c = 0) or of p F_0 (c = 1)"},
                         {"presliding_mm", "mm", 1, 0.01, 50, 0.5, 3, "s, displacement until the threads slide", true},
                         {"pressure_share", "", 0, 0, 1, 0, 1, "c; 0: friction in proportion to the tension, 1: to the pressure", true},
                         {"presliding_exponent", "", 0, 0, 1, 0, 1, "i; 0: all threads slide at once, 1: ever more of them", true},
                         {"constant_friction_N", "N", 0, 0, 1000, 1, 20, "F_c, friction at any tension and pressure"}},
          .make = [](const EffectValues& values) { return std::make_unique<BraidHysteresis>(values); },
          .variants = Variants::laws};
}

BraidHysteresis::BraidHysteresis(const EffectValues& values)
    : width_(values["relative_width"]),
      presliding_mm_(values["presliding_mm"]),
      pressure_share_(values["pressure_share"]),
      exponent_(values["presliding_exponent"]),
      constant_N_(values["constant_friction_N"]) {}

void BraidHysteresis::attach(const EffectPlace& place) {
  ForceEffect::attach(place);
  full_tension_N_ = actuator().calculateForce(1, actuator().restLengthMm());
}

double BraidHysteresis::playAt(double length_mm) const {
  if (length_mm != asked_length_mm_) {
    asked_play_ = slid(play_, (length_mm_ - length_mm) / presliding_mm_, exponent_);
    asked_length_mm_ = length_mm;
  }
  return asked_play_;
}

double BraidHysteresis::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  const double tension_N = below(input);
  if (pressure_share_ == 0 && constant_N_ == 0) return tension_N - width_ * std::abs(tension_N) * playAt(input.length_mm);
  const double pressed_N = std::max(0.0, input.pressure_ratio) * full_tension_N_;
  const double friction_N = width_ * ((1 - pressure_share_) * std::abs(tension_N) + pressure_share_ * pressed_N) + constant_N_;
  return std::max(tension_N - friction_N * playAt(input.length_mm), std::min(0.0, tension_N));
}

void BraidHysteresis::advance(const MuscleInput& input) {
  play_ = playAt(input.length_mm);
  length_mm_ = input.length_mm;
}

void BraidHysteresis::settle(const MuscleInput& input) {
  play_ = asked_play_ = 0;
  length_mm_ = asked_length_mm_ = input.length_mm;
}

}  // namespace musclesim
