#include "force_gain.h"

namespace musclesim {

EffectInfo ForceGain::info() {
  return {.id = "force_gain",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "a muscle is weaker or stronger than the force law says",
          .equation = "F' = g F    F tension, g = gain",
          .signature = "error in proportion to the tension, the same in both directions; ageing or another muscle type",
          .source = "definition",
          .parameters = {{"gain", "", 1, 0, 10, 0.7, 1.3, "g"}},
          .make = [](const EffectValues& values) { return std::make_unique<ForceGain>(values["gain"]); }};
}

}  // namespace musclesim
