// Numbers of the model that are known with an error only: their names, their values at coordinates, and how far they may go.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"
#include "plant.h"

namespace musclesim {

/// Throws BadParameter, with the nearest name, if the model has no such number, and for a number that a factor cannot change.
Parameter Plant::numberNamed(const std::string& option, const std::string& name) const {
  std::vector<std::string> names;
  for (const Parameter& parameter : reference_->parameters().declared()) {
    if (!std::holds_alternative<double>(parameter.value) || parameter.integer) continue;
    names.push_back(parameter.name);
    if (parameter.name != name) continue;
    if (std::get<double>(parameter.value) != 0) return parameter;
    throw BadParameter(option + " " + name, "0", "begin at another value: it is changed by a factor");
  }
  const std::string nearest = nearestName(name, names);
  throw BadParameter(fmt::format("{}: the model of {} has no number \"{}\"{}", option, robot(), name,
                                 nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"));
}

double Plant::numberAt(Eigen::Index index, double eta) const {
  const auto& [parameter, tolerance, is_tuned] = numbers_[static_cast<std::size_t>(index)];
  return std::clamp(std::get<double>(parameter.value) * std::exp(tolerance * eta), parameter.minimum, parameter.maximum);
}

std::vector<std::pair<std::string, double>> Plant::numbersAt(const Eigen::VectorXd& eta) const {
  std::vector<std::pair<std::string, double>> values;
  for (Eigen::Index i = 0; i < eta.size(); ++i)
    if (eta[i] != numbers_in_force_[i]) values.emplace_back(numbers_[static_cast<std::size_t>(i)].parameter.name, numberAt(i, eta[i]));
  return values;
}

Eigen::VectorXd Plant::clampedNumbers(const Eigen::VectorXd& eta, double margin) const {
  constexpr double farthest = 4;  // tolerances: beyond it the tolerance itself would be wrong
  constexpr int halving_count = 6;
  const Eigen::VectorXd whole = eta.cwiseMax(-farthest).cwiseMin(farthest), none = Eigen::VectorXd::Zero(eta.size());
  if (margin > 0 && !canBeBuilt(none, margin)) margin = 0;
  if (canBeBuilt(whole, margin)) return whole;
  Eigen::VectorXd result = none;
  for (Eigen::Index i = 0; i < eta.size(); ++i) {
    double fits = 0, too_far = 1;  // shares of this number's coordinate
    const auto tryShare = [&](double share) {
      result[i] = share * whole[i];
      (canBeBuilt(result, margin) ? fits : too_far) = share;
    };
    tryShare(1);
    for (int k = 0; k < halving_count && fits < 1; ++k) tryShare((fits + too_far) / 2);
    result[i] = fits * whole[i];
  }
  return result;
}

/// Whether the robot can be built with the numbers at these coordinates, and with each of them changed by the margin.
bool Plant::canBeBuilt(const Eigen::VectorXd& eta, double margin) const {
  if (margin > 0)
    for (Eigen::Index i = 0; i < eta.size(); ++i)
      for (const double side : {margin, -margin}) {
        Eigen::VectorXd beside = eta;
        beside[i] += side;
        if (!canBeBuilt(beside, 0)) return false;
      }
  if (eta.isZero(0)) return true;
  const std::vector<double> key(eta.begin(), eta.end());
  {
    const std::lock_guard lock(access_to_built_);
    if (const auto known = built_.find(key); known != built_.end()) return known->second;
  }
  bool possible = true;
  try {
    ReplayOptions options = options_.model;
    for (const auto& [name, value] : numbersAt(eta)) options.parameters.set(name, value, "diagnosis");
    const RecordingInfo& info = recordings_.front().info;
    Simulation(simulationOptionsFor(info, sidecarPath(recordings_.front().file), options)).build(info.robot);
  } catch (const BadParameter&) {
    possible = false;
  } catch (const BadFile&) {
    possible = false;
  }
  const std::lock_guard lock(access_to_built_);
  return built_[key] = possible;
}

}  // namespace musclesim
