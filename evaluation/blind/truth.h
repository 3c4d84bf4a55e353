/// A plant with a withheld cause: its measurements and its distance from the model.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim::blind {

/// One plant with its commands and sensors, simulated with other laws, a finer internal step, other seeds and, if given, other numbers than
/// the model that a diagnosis compares it with.
class Truth {
 public:
  /// What a plant or a model does, without noise, one recording per plan; shorter where it diverges.
  using Motion = std::vector<Recording>;

  /// `signals`: the measured ones; `noise_std`: of each of them; `numbers`: parameters of the plant that differ from the model's, by full
  /// name. Simulates the model's own prediction.
  Truth(std::vector<Recording> plans, std::vector<std::string> signals, std::map<std::string, double> noise_std, std::uint64_t seed,
        std::map<std::string, double> numbers = {});

  /// The model's prediction.
  const Motion& model() const { return model_; }
  /// The plant without effects.
  const Motion& clean() const { return clean_; }
  /// The plant with these effects.
  Motion motion(const std::vector<ActiveEffect>& effects) const { return motion(effects, numbers_); }
  /// The same with the model's numbers.
  Motion nominalMotion(const std::vector<ActiveEffect>& effects) const;
  /// The same with other numbers, by full name, in place of the plant's.
  Motion motion(const std::vector<ActiveEffect>& effects, const std::map<std::string, double>& numbers) const;

  /// RMSE per signal between two motions over all their recordings. NaN if one of them diverges.
  std::map<std::string, double> rmse(const Motion& one, const Motion& other) const;
  /// The largest RMSE over noise of any signal.
  double gapOverNoise(const std::map<std::string, double>& rmse) const;
  /// Mean over signals of RMSE^2 / noise^2: the normalised gap of a diagnosis that knows the noise exactly.
  double normalisedGap(const std::map<std::string, double>& rmse) const;
  /// The readings of the plant's sensors, noise included, without any trace of effects, seed, step or numbers.
  std::vector<Recording> measured(const std::vector<ActiveEffect>& effects) const;

  const std::vector<std::string>& signals() const { return signals_; }
  const std::map<std::string, double>& noiseStd() const { return noise_std_; }
  /// Internal steps of the plant per internal step of the model.
  int stepRatio() const;

 private:
  using Numbers = std::map<std::string, double>;
  Recording simulated(std::size_t recording, const std::vector<ActiveEffect>& effects, const Numbers& numbers, bool noisy) const;

  std::vector<Recording> plans_;
  Motion model_, clean_;
  std::vector<int> substeps_;
  std::vector<std::string> signals_;
  std::map<std::string, double> noise_std_;
  std::uint64_t seed_;
  Numbers numbers_;
};

}  // namespace musclesim::blind
