#include "sensor_gain.h"

namespace musclesim {

EffectInfo SensorGain::info() {
  return {.id = "sensor_gain",
          .stage = Stage::sensor,
          .acts_on = {ComponentKind::signal},
          .summary = "a reading is off by a factor",
          .equation = "y' = g y    g = gain",
          .signature = "the error is proportional to the reading",
          .source = "definition",
          .parameters = {{"gain", "", 1, -10, 10, 0.85, 1.15, "g"}},
          .make = [](const EffectValues& values) { return std::make_unique<SensorGain>(values["gain"]); },
          .is_memoryless = true};
}

}  // namespace musclesim
