#include "sensor_stage.h"

#include "musclesim/robot/robot.h"

namespace musclesim {

void SensorStage::add(int signal, std::unique_ptr<SensorEffect> effect) {
  tracks_ = tracks_ || effect->tracks();
  sensors_.push_back({signal, std::move(effect)});
}

void SensorStage::reset() {
  sample_ = -1;
  for (const Sensor& sensor : sensors_) sensor.effect->reset();
}

void SensorStage::track(const Robot& robot, const Moment& moment) {
  if (!tracks_) return;
  std::vector<double> values = robot.signalValues(robot.truth());
  for (const Sensor& sensor : sensors_) {
    double& value = values[static_cast<std::size_t>(sensor.signal)];
    sensor.effect->track(value, moment);
    value = sensor.effect->reading(value, moment, sample_);
  }
}

void SensorStage::read(const Robot& robot, State& state, const Moment& moment) {
  if (sensors_.empty()) return;
  if (sample_ < 0 || moment.clock_s != sample_clock_s_) ++sample_;
  sample_clock_s_ = moment.clock_s;
  std::vector<double> values = robot.signalValues(state);
  for (const Sensor& sensor : sensors_) {
    double& value = values[static_cast<std::size_t>(sensor.signal)];
    value = sensor.effect->reading(value, moment, sample_);
  }
  robot.setSignalValues(values, state);
}

}  // namespace musclesim
