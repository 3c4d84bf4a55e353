/// The last stage: what is read of the true state.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "musclesim/effect/effect.h"

namespace musclesim {

/// Sensor effects by signal. The robot's state is read through it.
class SensorStage {
 public:
  void add(int signal, std::unique_ptr<SensorEffect> effect);
  /// White noise on all signals whose parameter "sensor.<quantity>_noise_<unit>" is not 0.
  void addNoise(World& world, const Robot& robot);
  /// Standard deviations of the noise by signal, where there is any.
  const std::map<std::string, double>& noise() const { return noise_; }
  bool empty() const { return sensors_.empty(); }
  void reset();
  /// Tells the sensors that remember what the signals are now.
  void track(const Robot& robot, const Moment& moment);
  void read(const Robot& robot, State& state, const Moment& moment);

 private:
  struct Sensor {
    int signal;
    std::unique_ptr<SensorEffect> effect;
  };
  std::vector<Sensor> sensors_;   ///< of one signal in the order in which they act
  std::size_t sensor_count_ = 0;  ///< those that do not depend on the sample; they come first
  std::map<std::string, double> noise_;
  bool tracks_ = false;
  long sample_ = -1;  ///< number of the present sample
  double sample_clock_s_ = 0;
};

}  // namespace musclesim
