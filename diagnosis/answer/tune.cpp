#include "tune.h"

#include <limits>
#include <mutex>

#include "../fit/comparison.h"
#include "../fit/refit.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr int tuning_round_count = 20;
/// Of the half width of a 95 % interval, in tolerances, if the data say something; without data it is 1.96.
constexpr double determined = 1;

/// How far each tuned number can still be changed alone. Where the robot could not be built beside the tuned values, for example because a
/// body would have all its mass in one point, the search for causes could not move from there.
constexpr double kept_free = 0.2;

}  // namespace

Tuning tune(const std::vector<Recording>& recordings, DiagnosisOptions& options) {
  const Plant plant(recordings, options);
  Comparison fitted(plant, plant.split().fit);
  if (const Eigen::VectorXd nominal = fitted.predicted(Model{}); nominal.size()) fitted.setGap(fitted.measured() - nominal);
  std::mutex mutex;  // derivatives are simulated by several threads
  DiagnosisProgress progress{"fitting parameters of the model", 0, tuning_round_count * static_cast<long>(plant.numberCount() + 2)};
  FitProblem problem;
  problem.start = Eigen::VectorXd::Zero(plant.numberCount());
  problem.clamped = [&plant](const Eigen::VectorXd& eta) { return plant.clampedNumbers(eta, kept_free); };
  problem.precision = Eigen::VectorXd::Ones(plant.numberCount());
  problem.predicted = [&](const Eigen::VectorXd& z) {
    {
      const std::lock_guard lock(mutex);
      ++progress.done;
      if (options.progress) options.progress(progress);
    }
    Model model;
    model.parameters = plant.numbersAt(z);
    return fitted.predicted(model);
  };
  FitResult result = fit(fitted, problem, tuning_round_count);
  if (!result.residual.size()) {
    if (!plant.interrupted()) throw Diverged(0, plant.robot(), "the model without further effects cannot follow the recordings");
    result.certainty = notDetermined(result.z.size());
  }
  Tuning tuning{tunedParameters(plant, result.z, result.certainty.half_width), plant.simulationCount(), plant.simulatedS()};
  for (const TunedParameter& parameter : tuning.parameters) options.model.parameters.set(parameter.name, parameter.fitted.value, "--tune");
  return tuning;
}

std::vector<TunedParameter> tunedParameters(const Plant& plant, const Eigen::VectorXd& eta, const Eigen::VectorXd& half_width) {
  std::vector<TunedParameter> result;
  for (Eigen::Index i = 0; i < eta.size(); ++i) {
    const UncertainNumber& number = plant.numbers()[static_cast<std::size_t>(i)];
    if (!number.is_tuned) continue;
    const Estimate fitted = {plant.numberAt(i, eta[i]), plant.numberAt(i, eta[i] - half_width[i]),
                             plant.numberAt(i, eta[i] + half_width[i]), half_width[i] < determined};
    result.push_back({number.parameter.name, number.parameter.unit, std::get<double>(number.parameter.value), fitted, fitted});
  }
  return result;
}

}  // namespace musclesim
