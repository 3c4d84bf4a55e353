/// Force stage: the muscle follows another static force law than the model.
///     F' = G(p, l),  or, with law = corrected,  F' = max(0, F + G(p, l))
/// G is one of the laws of musclesim/robot: Eq. 1 with other constants, Chou-Hannaford, Sarosi, or the measured map of the parameters
/// "force_law.*"; with law = corrected, G is the Chou-Hannaford formula. F tension, p pressure, l length; each law's header explains its
/// constants. rest_length_mm = 0 stands for the rest length of the model's law. Eq. 1 has r = 0 where the model's law has it or, under
/// full pressure, stops pulling.
/// Neutral: law = own.  Source: Braun 2007; Chou and Hannaford 1996; Sarosi 2012.
#pragma once

#include "musclesim/effect/effect_info.h"
#include "musclesim/robot/force_law.h"

namespace musclesim {

class OtherForceLaw final : public ForceEffect {
 public:
  explicit OtherForceLaw(EffectValues values) : values_(std::move(values)) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;

 private:
  EffectValues values_;
  std::unique_ptr<ForceLaw> law_;
  bool adds_ = false;
};

}  // namespace musclesim
