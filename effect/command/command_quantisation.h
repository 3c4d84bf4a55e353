/// Command stage: a converter has a limited number of levels.
///     u' = floor(u m + 1 - r) / m,    m = n - e,  n = 2^bits levels
/// u commanded, u' delivered pressure, fractions of full scale; r = 0.5 rounds, r = 1 truncates. With e = 1 the highest level is full
/// scale; with e = 0 full scale would be one level above the highest, as in converters that output code / 2^bits of their reference. n need
/// not be an integer.
/// Neutral: bits infinite. Range 1 .. infinity, usually 6 .. 10; the compressor of Braun 2007 has 8.  Source: definition.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class CommandQuantisation final : public MuscleRatioEffect {
 public:
  CommandQuantisation(double bits, double rounding_point, double top_level);
  static EffectInfo info();

 private:
  double output(double input, const StepTime&) override { return settled(input); }
  double settled(double input) override;

  double intervals_;       ///< m
  double rounding_point_;  ///< r
};

}  // namespace musclesim
