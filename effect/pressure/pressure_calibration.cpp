#include "pressure_calibration.h"

namespace musclesim {

EffectInfo PressureCalibration::info() {
  return {.id = "pressure_calibration",
          .stage = Stage::pressure,
          .acts_on = {ComponentKind::muscle},
          .summary = "the regulator's pressure differs from the requested pressure by a gain and an offset",
          .equation = "p' = max(0, gain p + offset)    p requested, p' actual",
          .signature = "the error is present at rest and the same in both directions",
          .source = "definition",
          .parameters = {{"gain", "", 1, 0, 5, 0.9, 1.1, "gain"}, {"offset", "", 0, -1, 1, -0.05, 0.05, "offset, fraction of full scale"}},
          .make = [](const EffectValues& values) { return std::make_unique<PressureCalibration>(values["gain"], values["offset"]); },
          .ignores_motion = true};
}

}  // namespace musclesim
