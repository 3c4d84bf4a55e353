#include "sensor_stage.h"

#include "musclesim/robot/robot.h"
#include "sensor/sensor_noise.h"

namespace musclesim {

void SensorStage::add(int signal, std::unique_ptr<SensorEffect> effect) {
  tracks_ = tracks_ || effect->tracks();
  const bool per_sample = effect->perSample();
  const auto place = per_sample ? sensors_.end() : sensors_.begin() + static_cast<std::ptrdiff_t>(sensor_count_++);
  sensors_.insert(place, {signal, std::move(effect)});
}

namespace {

double noiseOf(const std::string& signal, Parameters& parameters) {
  static const struct {
    const char *begin, *name, *unit;
  } quantities[] = {{"pressure_", "sensor.pressure_noise_ratio", ""},
                    {"force_", "sensor.force_noise_N", "N"},
                    {"length_", "sensor.length_noise_mm", "mm"},
                    {"angle_", "sensor.angle_noise_deg", "deg"},
                    {"hand_", "sensor.hand_noise_mm", "mm"}};
  for (const auto& quantity : quantities)
    if (signal.starts_with(quantity.begin))
      return parameters.number(quantity.name, 0, quantity.unit, 0, 1e3, "standard deviation of the sensors' white noise");
  return 0;
}

}  // namespace

void SensorStage::addNoise(World& world, const Robot& robot) {
  const std::vector<std::string> names = robot.signalNames();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double deviation = noiseOf(names[i], world.parameters());
    if (deviation == 0) continue;
    noise_[names[i]] = deviation;
    // Noise acts before dropouts, so a lost sample loses its noise too.
    sensors_.insert(sensors_.begin() + static_cast<std::ptrdiff_t>(sensor_count_ + noise_.size() - 1),
                    {static_cast<int>(i), std::make_unique<SensorNoise>(deviation, world.seed(), names[i])});
  }
}

void SensorStage::reset() {
  sample_ = -1;
  for (const Sensor& sensor : sensors_) sensor.effect->reset();
}

void SensorStage::track(const Robot& robot, const StepTime& time) {
  if (!tracks_) return;
  std::vector<double> values = robot.signalValues(robot.truth());
  for (std::size_t i = 0; i < sensor_count_; ++i) {
    const Sensor& sensor = sensors_[i];
    double& value = values[static_cast<std::size_t>(sensor.signal)];
    sensor.effect->track(value, time);
    value = sensor.effect->reading(value, time, sample_);
  }
}

void SensorStage::read(const Robot& robot, State& state, const StepTime& time) {
  if (sensors_.empty()) return;
  if (sample_ < 0 || time.clock_s != sample_clock_s_) ++sample_;
  sample_clock_s_ = time.clock_s;
  std::vector<double> values = robot.signalValues(state);
  for (const Sensor& sensor : sensors_) {
    double& value = values[static_cast<std::size_t>(sensor.signal)];
    value = sensor.effect->reading(value, time, sample_);
  }
  robot.setSignalValues(values, state);
}

}  // namespace musclesim
