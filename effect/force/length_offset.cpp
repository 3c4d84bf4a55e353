#include "length_offset.h"

namespace musclesim {

EffectInfo LengthOffset::info() {
  return {.id = "length_offset",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "a muscle is mounted too long or too short",
          .equation = "F' = F(p, l + d)    F tension, l length, d = offset_mm",
          .signature = "the error grows with pressure and vanishes when the muscle is slack",
          .source = "definition",
          .parameters = {{"offset_mm", "mm", 0, -500, 500, -15, 15, "d; positive: stretched by d more than in the model"}},
          .make = [](const EffectValues& values) { return std::make_unique<LengthOffset>(values["offset_mm"]); }};
}

double LengthOffset::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  MuscleInput inside = input;
  inside.length_mm += offset_mm_;
  return below(inside);
}

}  // namespace musclesim
