/// Sensor stage: play between the joint or muscle and its sensor.
///     y' follows y with a play of width w: it moves only to keep y - w/2 <= y' <= y + w/2
/// w = width_deg for angles, width_mm for lengths and positions. y' is updated at every internal step. At the start y' = y.
/// Neutral: both 0. Range 0 .. 90 deg and 0 .. 1000 mm, usually 0.3 .. 5.  Source: play operator, Krasnosel'skii and Pokrovskii 1989.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class SensorBacklash final : public SensorEffect {
 public:
  SensorBacklash(double width_deg, double width_mm) : width_deg_(width_deg), width_mm_(width_mm) {}
  static EffectInfo info();

  /// Throws BadParameter if the effect is placed on a single signal and the width for that signal's unit is 0.
  void attach(const EffectPlace& place) override;
  void reset() override { at_start_ = true; }
  double reading(double value, const StepTime&, long) override;
  void track(double value, const StepTime& time) override;
  bool tracks() const override { return true; }

 private:
  double width_deg_, width_mm_;
  double width_ = 0;  ///< w of this signal
  bool at_start_ = true;
  double followed_ = 0;
};

}  // namespace musclesim
