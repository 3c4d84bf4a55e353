/// Body stage: a mass in the hand (rig: on the load) that the model does not know; negative: what the model has too much.
///     m' = m + mass_kg, with centre of mass and inertia of a point mass at the hand added to those of the hand's body
/// Throws BadParameter where mass or inertia of the body would not stay positive.
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
