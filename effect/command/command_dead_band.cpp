#include "command_dead_band.h"

namespace musclesim {

EffectInfo CommandDeadBand::info() {
  return {.id = "command_dead_band",
          .stage = Stage::command,
          .acts_on = {ComponentKind::muscle},
          .summary = "small commands do not open the valve",
          .equation =
              "closed: u' = 0 until u >= u_t, open: u' = u until u < (1 - h) u_t    u commanded, u' delivered, u_t = threshold, "
              "h = hysteresis",
          .signature = "below the threshold the pressure stays at zero and nothing moves",
          .source = "definition; 0.056 of full scale measured on a pneumatic muscle drive; a sticking spool opens later than it closes",
          .parameters = {{"threshold", "", 0, 0, 1, 0.02, 0.1, "u_t, fraction of full scale"},
                         {"hysteresis", "", 0, 0, 1, 0, 0.5, "h, the valve closes at (1 - h) u_t", true}},
          .make = [](const EffectValues& values) { return std::make_unique<CommandDeadBand>(values["threshold"], values["hysteresis"]); },
          .ignores_motion = true};
}

}  // namespace musclesim
