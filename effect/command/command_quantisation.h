/// Command stage: a converter knows a limited number of levels.
///     u' = round(u (n - 1)) / (n - 1),    n = 2^bits levels on 0 .. 1
/// u commanded, u' delivered pressure, fractions of full scale. n need not be whole, so that fits are smooth in bits.
/// Neutral: bits infinite. Range 1 .. infinity, usually 6 .. 10; the compressor of Braun 2007 has 8.  Source: definition.
#pragma once

#include "musclesim/effect/catalogue.h"

namespace musclesim {

class CommandQuantisation final : public MuscleRatioEffect {
 public:
  explicit CommandQuantisation(double bits);
  static EffectInfo info();

 private:
  double output(double input, const Moment&) override { return settled(input); }
  double settled(double input) override;

  double intervals_;  ///< n - 1
};

}  // namespace musclesim
