#include "command_dead_band.h"

namespace musclesim {

EffectInfo CommandDeadBand::info() {
  return {.id = "command_dead_band",
          .stage = Stage::command,
          .acts_on = {ComponentKind::muscle},
          .summary = "small commands do not open the valve",
          .equation = "u' = 0 for u < u_t, u otherwise    u commanded, u' delivered, u_t = threshold",
          .signature = "below the threshold the pressure stays at zero and nothing moves",
          .source = "definition; 0.056 of full scale measured on a pneumatic muscle drive",
          .parameters = {{"threshold", "", 0, 0, 1, 0.02, 0.1, "u_t, fraction of full scale"}},
          .make = [](const EffectValues& values) { return std::make_unique<CommandDeadBand>(values["threshold"]); }};
}

}  // namespace musclesim
