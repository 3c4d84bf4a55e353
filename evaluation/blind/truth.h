/// A plant with a withheld cause: its measurements and its distance from the model.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim::blind {

/// One plant with its commands and sensors, simulated with other laws, a finer internal step and other seeds than the model that a
/// diagnosis compares it with.
class Truth {
 public:
  /// `signals`: the measured ones; `noise_std`: of each of them. Simulates the model's own prediction.
  Truth(std::vector<Recording> plans, std::vector<std::string> signals, std::map<std::string, double> noise_std, std::uint64_t seed);

  /// RMSE per signal between the model and the plant with these effects, without noise, over all recordings. NaN if the plant diverges.
  std::map<std::string, double> rmse(const std::vector<ActiveEffect>& effects) const;
  /// The largest RMSE over noise of any signal.
  double gapOverNoise(const std::map<std::string, double>& rmse) const;
  /// Mean over signals of RMSE^2 / noise^2: the normalised gap of a diagnosis that knows the noise exactly.
  double normalisedGap(const std::map<std::string, double>& rmse) const;
  /// The readings of the plant's sensors, noise included, without any trace of effects, seed or step.
  std::vector<Recording> measured(const std::vector<ActiveEffect>& effects) const;

  const std::vector<std::string>& signals() const { return signals_; }
  /// Internal steps of the plant per internal step of the model.
  int stepRatio() const;

 private:
  Recording simulated(std::size_t recording, const std::vector<ActiveEffect>& effects, bool noisy) const;

  std::vector<Recording> plans_, model_;
  std::vector<int> substeps_;
  std::vector<std::string> signals_;
  std::map<std::string, double> noise_std_;
  std::uint64_t seed_;
};

}  // namespace musclesim::blind
