/// The last stage: turns the true state into sensor readings.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "musclesim/effect/effect.h"

namespace musclesim {

/// Holds the sensor effects of all signals and applies them to the robot's state.
class SensorStage {
 public:
  void add(int signal, std::unique_ptr<SensorEffect> effect);
  /// White noise on all signals whose parameter "sensor.<quantity>_noise_<unit>" is not 0.
  void addNoise(World& world, const Robot& robot);
  /// Standard deviation of the noise by signal, for signals with noise.
  const std::map<std::string, double>& noise() const { return noise_; }
  bool empty() const { return sensors_.empty(); }
  void reset();
  /// Passes the present signals to the sensor effects that keep a history.
  void track(const Robot& robot, const StepTime& time);
  void read(const Robot& robot, State& state, const StepTime& time);

 private:
  struct Sensor {
    int signal;
    std::unique_ptr<SensorEffect> effect;
  };
  std::vector<Sensor> sensors_;   ///< effects on the same signal stand in the order in which they act
  std::size_t sensor_count_ = 0;  ///< number of effects that do not depend on the sample; they come first
  std::map<std::string, double> noise_;
  bool tracks_ = false;
  long sample_ = -1;  ///< index of the present sample
  double sample_clock_s_ = 0;
};

}  // namespace musclesim
