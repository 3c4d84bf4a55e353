#include "channel_swap.h"

namespace musclesim {

EffectInfo ChannelSwap::info() {
  return {.id = "channel_swap",
          .stage = Stage::command,
          .acts_on = {ComponentKind::muscle_pair},
          .summary = "the commands of two muscles are exchanged",
          .equation = "u_i' = u_j, u_j' = u_i    u commanded, u' delivered",
          .signature = "the two muscles respond to each other's commands; antagonists move in the wrong direction",
          .source = "definition",
          .parameters = {},
          .make = [](const EffectValues&) { return std::make_unique<ChannelSwap>(); },
          .ignores_motion = true};
}

void ChannelSwap::attach(const EffectPlace& place) {
  first_ = static_cast<std::size_t>(place.muscle);
  second_ = static_cast<std::size_t>(place.other_muscle);
}

}  // namespace musclesim
