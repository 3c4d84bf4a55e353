#include "sensor_backlash.h"

#include <algorithm>

#include "musclesim/base/error.h"
#include "musclesim/log/recording.h"
#include "musclesim/robot/robot.h"

namespace musclesim {

EffectInfo SensorBacklash::info() {
  return {.id = "sensor_backlash",
          .stage = Stage::sensor,
          .acts_on = {ComponentKind::signal},
          .summary = "play between the joint or muscle and its sensor",
          .equation = "y - w/2 <= y' <= y + w/2    y' moves only to stay within these bounds, w = width_deg or width_mm",
          .signature = "the reading is flat at each reversal; the true motion is unaffected, so other signals agree with the model",
          .source = "play operator, Krasnosel'skii and Pokrovskii 1989",
          .parameters = {{"width_deg", "deg", 0, 0, 90, 0.3, 5, "w of an angle"},
                         {"width_mm", "mm", 0, 0, 1000, 0.3, 5, "w of a length or position"}},
          .make = [](const EffectValues& values) { return std::make_unique<SensorBacklash>(values["width_deg"], values["width_mm"]); }};
}

void SensorBacklash::attach(const EffectPlace& place) {
  const std::string unit = signalUnit(place.robot.signalNames()[static_cast<std::size_t>(place.signal)]);
  width_ = unit == "deg" ? width_deg_ : unit == "mm" ? width_mm_ : 0;
  if (width_ == 0 && !place.one_of_all)
    throw BadParameter("sensor_backlash on " + place.component + ": it needs width_deg for an angle, width_mm for a length or position");
}

double SensorBacklash::reading(double value, const StepTime&, long) {
  return at_start_ ? value : std::clamp(followed_, value - width_ / 2, value + width_ / 2);
}

void SensorBacklash::track(double value, const StepTime& time) {
  followed_ = reading(value, time, 0);
  at_start_ = false;
}

}  // namespace musclesim
