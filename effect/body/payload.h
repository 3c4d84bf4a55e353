/// Body stage: the hand (rig: the load) carries a mass that is not in the model; a negative mass means that the model's is too large.
///     m' = m + mass_kg,   a point mass at the hand is added to the mass, centre of mass and inertia of the hand's body
/// Throws BadParameter if the body's mass or inertia would not stay positive.
/// Neutral: 0. Range -1000 .. 1000 kg, usually -0.3 .. 1.  Source: parallel-axis theorem.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class Payload final : public HandEffect {
 public:
  explicit Payload(double mass_kg) : mass_kg_(mass_kg) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;

 private:
  double mass_kg_;
};

}  // namespace musclesim
