/// Command stage: a converter knows a limited number of levels.
///     u' = floor(u (n - 1) + 1 - r) / (n - 1),    n = 2^bits levels on 0 .. 1
/// u commanded, u' delivered pressure, fractions of full scale; r = 0.5 rounds, r = 1 truncates. n need not be whole.
/// Neutral: bits infinite. Range 1 .. infinity, usually 6 .. 10; the compressor of Braun 2007 has 8.  Source: definition.
#pragma once

#include "musclesim/effect/catalogue.h"

namespace musclesim {

class CommandQuantisation final : public MuscleRatioEffect {
 public:
  CommandQuantisation(double bits, double rounding_point);
  static EffectInfo info();

 private:
  double output(double input, const Moment&) override { return settled(input); }
  double settled(double input) override;

  double intervals_;       ///< n - 1
  double rounding_point_;  ///< r
};

}  // namespace musclesim
