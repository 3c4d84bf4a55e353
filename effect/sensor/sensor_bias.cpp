#include "sensor_bias.h"

namespace musclesim {

EffectInfo SensorBias::info() {
  return {.id = "sensor_bias",
          .stage = Stage::sensor,
          .acts_on = {ComponentKind::signal},
          .summary = "a reading is off by a constant",
          .equation = "y' = y + b    b = offset, in the unit of the signal",
          .signature = "the error is constant and does not depend on pressure",
          .source = "definition",
          .parameters = {{"offset", "unit of the signal", 0, -1e4, 1e4, -5, 5, "b"}},
          .make = [](const EffectValues& values) { return std::make_unique<SensorBias>(values["offset"]); },
          .is_memoryless = true};
}

}  // namespace musclesim
