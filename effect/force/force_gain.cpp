#include "force_gain.h"

namespace musclesim {

EffectInfo ForceGain::info() {
  return {.id = "force_gain",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "a muscle is weaker or stronger than the force law says",
          .equation = "F' = g F    F tension, g = gain",
          .signature = "the error is proportional to the tension and the same in both directions; caused by ageing or another muscle type",
          .source = "definition",
          .parameters = {{"gain", "", 1, 0, 10, 0.7, 1.3, "g"}},
          .make = [](const EffectValues& values) { return std::make_unique<ForceGain>(values["gain"]); }};
}

}  // namespace musclesim
