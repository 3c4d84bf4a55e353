#include "command_quantisation.h"

#include <algorithm>
#include <cmath>

namespace musclesim {

namespace {

constexpr double most_bits = 50;  ///< finer levels than a double has between 0 and 1 would overflow

}  // namespace

EffectInfo CommandQuantisation::info() {
  return {
      .id = "command_quantisation",
      .stage = Stage::command,
      .acts_on = {ComponentKind::muscle},
      .summary = "commands are rounded to 2^bits levels",
      .equation = "u' = floor(u m + 1 - r) / m, m = 2^bits - top_level, r = rounding_point    u commanded, u' delivered",
      .signature = "the residual jumps between discrete levels",
      .source = "definition; the compressor of Braun 2007 takes 8 bits",
      .parameters = {{"bits", "bit", unlimited, 1, unlimited, 6, 10, "resolution of the converter"},
                     {"rounding_point", "", 0.5, 0, 1, 0.5, 1,
                      "r, point within an interval from which values go to the next level; 0.5: rounds, 1: truncates", true},
                     {"top_level", "", 1, 0, 1, 0, 1, "1: the highest level is full scale; 0: full scale would be one level above it",
                      true}},
      .make = [](const EffectValues& v) { return std::make_unique<CommandQuantisation>(v["bits"], v["rounding_point"], v["top_level"]); },
      .ignores_motion = true,
      .variants = Variants::bits};
}

CommandQuantisation::CommandQuantisation(double bits, double rounding_point, double top_level)
    : intervals_(std::exp2(std::min(bits, most_bits)) - top_level), rounding_point_(rounding_point) {}

double CommandQuantisation::settled(double input) {
  return std::clamp(std::floor(input * intervals_ + 1 - rounding_point_) / intervals_, 0.0, 1.0);
}

}  // namespace musclesim
