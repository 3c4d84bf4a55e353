#include "command_quantisation.h"

#include <algorithm>
#include <cmath>

#include "../catalogue.h"

namespace musclesim {

EffectInfo CommandQuantisation::info() {
  return {.id = "command_quantisation",
          .stage = Stage::command,
          .acts_on = {ComponentKind::muscle},
          .summary = "commands are rounded to 2^bits levels",
          .equation = "u' = round(u (n - 1)) / (n - 1), n = 2^bits    u commanded, u' delivered",
          .signature = "residual on a lattice",
          .source = "definition; the compressor of Braun 2007 takes 8 bits",
          .parameters = {{"bits", "bit", unlimited, 1, unlimited, 6, 10, "resolution of the converter"}},
          .make = [](const EffectValues& values) { return std::make_unique<CommandQuantisation>(values["bits"]); }};
}

CommandQuantisation::CommandQuantisation(double bits) : intervals_(std::exp2(bits) - 1) {}

double CommandQuantisation::settled(double input) {
  return std::min(std::round(input * intervals_) / intervals_, 1.0);
}

}  // namespace musclesim
