/// A plant with a withheld cause: what it measures and how far the model is off.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim::blind {

/// One plant, its commands, its sensors. The plant is simulated with other laws, a finer internal step and other seeds than the model that
/// a diagnosis compares it with.
class Truth {
 public:
  /// `signals`: what is measured; `noise_std`: of each of them. The model's own answer is simulated here.
  Truth(std::vector<Recording> plans, std::vector<std::string> signals, std::map<std::string, double> noise_std, std::uint64_t seed);

  /// RMSE per signal between the model and the plant with these effects, without noise, over all recordings. NaN if the plant diverges.
  std::map<std::string, double> rmse(const std::vector<ActiveEffect>& effects) const;
  /// The largest RMSE over noise of any signal.
  double gapOverNoise(const std::map<std::string, double>& rmse) const;
  /// Mean over signals of RMSE^2 / noise^2: the normalised gap of a diagnosis with perfect floors.
  double normalisedGap(const std::map<std::string, double>& rmse) const;
  /// What the sensors of the plant read, noise included, without a word about effects, seed or step.
  std::vector<Recording> measured(const std::vector<ActiveEffect>& effects) const;

  const std::vector<std::string>& signals() const { return signals_; }
  /// How many internal steps of the plant there are for one of the model.
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
