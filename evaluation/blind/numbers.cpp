#include "numbers.h"

#include <algorithm>
#include <cmath>

#include "musclesim/robot/robot.h"
#include "musclesim/simulation/replay.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim::blind {

namespace {

double drawScale(RandomStream& random) {
  constexpr double usual_share = 0.7, twice_share = 0.1;
  const double place = random.uniform();
  return place < usual_share ? 1 : place < usual_share + twice_share ? 2 : 0;
}

}  // namespace

/// Masses can be weighed, inertias follow from a drawing, friction inside of muscles is only estimated.
std::map<std::string, double> tolerancesOf(const Robot& robot) {
  constexpr double mass = 0.02, inertia = 0.15, friction = 0.5, force_constant = 0.05;
  static const std::map<std::string, std::map<std::string, double>> own = {
      {"rig", {{"rig.load_kg", mass}}},
      {"elbow", {{"elbow.forearm_kg", mass}, {"elbow.forearm_inertia_kgm2", inertia}}},
      {"wrist", {{"wrist.hand_kg", mass}, {"wrist.own_inertia_kgm2", inertia}}}};
  std::map<std::string, double> tolerances = {{"muscle.slider_friction_N", friction}, {"force_law.c_kgf", force_constant}};
  if (const auto found = own.find(robot.name()); found != own.end()) tolerances.insert(found->second.begin(), found->second.end());
  return tolerances;
}

NumberErrors drawNumbers(const Recording& plan, RandomStream& random) {
  NumberErrors errors{drawScale(random), {}, {}};
  if (errors.scale == 0) return errors;
  Simulation model(simulationOptionsFor(plan.info, plan.file));
  const std::map<std::string, double> tolerances = tolerancesOf(model.build(plan.info.robot));
  for (const Parameter& parameter : model.parameters().declared()) {
    const auto tolerance = tolerances.find(parameter.name);
    if (tolerance == tolerances.end()) continue;
    const double nominal = std::get<double>(parameter.value),
                 drawn = nominal * std::exp(errors.scale * tolerance->second * random.normal());
    errors.nominal[parameter.name] = nominal;
    errors.truth[parameter.name] = std::clamp(drawn, parameter.minimum, parameter.maximum);
  }
  return errors;
}

}  // namespace musclesim::blind
