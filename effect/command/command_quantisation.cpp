#include "command_quantisation.h"

#include <algorithm>
#include <cmath>

#include "../catalogue.h"

namespace musclesim {

EffectInfo CommandQuantisation::info() {
  return {
      .id = "command_quantisation",
      .stage = Stage::command,
      .acts_on = {ComponentKind::muscle},
      .summary = "commands are rounded to 2^bits levels",
      .equation = "u' = floor(u (n - 1) + 1 - r) / (n - 1), n = 2^bits, r = rounding_point    u commanded, u' delivered",
      .signature = "residual on a lattice",
      .source = "definition; the compressor of Braun 2007 takes 8 bits",
      .parameters = {{"bits", "bit", unlimited, 1, unlimited, 6, 10, "resolution of the converter"},
                     {"rounding_point", "", 0.5, 0, 1, 0.5, 1,
                      "share of an interval from which on the next level is taken; 0.5: rounds, 1: truncates", true}},
      .make = [](const EffectValues& values) { return std::make_unique<CommandQuantisation>(values["bits"], values["rounding_point"]); }};
}

CommandQuantisation::CommandQuantisation(double bits, double rounding_point)
    : intervals_(std::exp2(bits) - 1), rounding_point_(rounding_point) {}

double CommandQuantisation::settled(double input) {
  return std::clamp(std::floor(input * intervals_ + 1 - rounding_point_) / intervals_, 0.0, 1.0);
}

}  // namespace musclesim
