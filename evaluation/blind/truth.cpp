#include "truth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chance.h"
#include "excitation.h"
#include "musclesim/simulation/replay.h"

namespace musclesim::blind {

namespace {

/// The simulator's parameter that holds the noise of a signal.
std::string noiseParameter(const std::string& signal) {
  if (signal.starts_with("pressure_")) return "sensor.pressure_noise_ratio";
  if (signal.starts_with("force_")) return "sensor.force_noise_N";
  if (signal.starts_with("length_")) return "sensor.length_noise_mm";
  if (signal.starts_with("angle_")) return "sensor.angle_noise_deg";
  return "sensor.hand_noise_mm";
}

/// Number of last digits per unit of a sensor: far finer than its noise.
double stepsPerUnit(const std::string& signal) {
  return signal.starts_with("pressure_") ? 1e5 : 1e4;
}

}  // namespace

Truth::Truth(std::vector<Recording> plans, std::vector<std::string> signals, std::map<std::string, double> noise_std, std::uint64_t seed,
             std::map<std::string, double> numbers)
    : plans_(std::move(plans)), signals_(std::move(signals)), noise_std_(std::move(noise_std)), seed_(seed), numbers_(std::move(numbers)) {
  for (const Recording& plan : plans_) {
    ReplayResult result = replayRecording(plan);
    substeps_.push_back(result.substeps);
    model_.push_back(std::move(result.simulated));
  }
  clean_ = motion({});
}

/// A robot of many muscles is sensitive: a finer time step alone moves the arm's hand by millimetres, many times the noise. Its plants
/// differ from the model in everything else only.
int Truth::stepRatio() const {
  return layoutOf(plans_.front().muscleCount()) == Layout::many ? 1 : 2;
}

Recording Truth::simulated(std::size_t recording, const std::vector<ActiveEffect>& effects, const Numbers& numbers, bool noisy) const {
  ReplayOptions options;
  options.effects = effects;
  options.seed = seed_ + recording;
  options.substeps = substeps_[recording] * stepRatio();
  for (const auto& [name, value] : numbers) options.parameters.set(name, value, "blind");
  if (noisy)
    for (const auto& [signal, deviation] : noise_std_) options.parameters.set(noiseParameter(signal), deviation, "blind");
  return replayRecording(plans_[recording], options).simulated;
}

Truth::Motion Truth::motion(const std::vector<ActiveEffect>& effects, const Numbers& numbers) const {
  Motion recordings;
  for (std::size_t i = 0; i < plans_.size(); ++i) recordings.push_back(simulated(i, effects, numbers, false));
  return recordings;
}

Truth::Motion Truth::nominalMotion(const std::vector<ActiveEffect>& effects) const {
  return effects.empty() && numbers_.empty() ? clean_ : motion(effects, {});
}

std::map<std::string, double> Truth::rmse(const Motion& one, const Motion& other) const {
  std::map<std::string, double> squares;
  double row_count = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const bool whole = one[i].info.complete.value_or(true) && other[i].info.complete.value_or(true);
    row_count += static_cast<double>(one[i].time_s.size());
    for (const SignalError& error : compareSignals(one[i], other[i]))
      squares[error.name] +=
          whole ? error.rmse * error.rmse * static_cast<double>(error.sample_count) : std::numeric_limits<double>::quiet_NaN();
  }
  std::map<std::string, double> result;
  for (const std::string& signal : signals_) result[signal] = std::sqrt(squares[signal] / row_count);
  return result;
}

double Truth::gapOverNoise(const std::map<std::string, double>& rmse) const {
  double largest = 0;
  for (const auto& [signal, value] : rmse) {
    if (!std::isfinite(value)) return value;
    largest = std::max(largest, value / noise_std_.at(signal));
  }
  return largest;
}

double Truth::normalisedGap(const std::map<std::string, double>& rmse) const {
  double sum = 0;
  for (const auto& [signal, value] : rmse) sum += std::pow(value / noise_std_.at(signal), 2);
  return sum / static_cast<double>(rmse.size());
}

std::vector<Recording> Truth::measured(const std::vector<ActiveEffect>& effects) const {
  std::vector<Recording> recordings;
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Recording plant = simulated(i, effects, numbers_, true);
    Recording recording = plans_[i];
    recording.info.noise_std = noise_std_;
    for (const std::string& name : signals_) {
      recording.signals.push_back(*plant.find(name));
      for (double& value : recording.signals.back().values) value = rounded(value, stepsPerUnit(name));
    }
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

}  // namespace musclesim::blind
