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

NumberErrors drawNumbers(const Recording& plan, RandomStream& random) {
  NumberErrors errors{drawScale(random), {}, {}, {}};
  Simulation model(simulationOptionsFor(plan.info, plan.file));
  const std::map<std::string, double> tolerances = model.build(plan.info.robot).parameterTolerances();
  for (const Parameter& parameter : model.parameters().declared()) {
    const auto tolerance = tolerances.find(parameter.name);
    if (tolerance == tolerances.end()) continue;
    const double nominal = std::get<double>(parameter.value);
    errors.tolerance[parameter.name] = tolerance->second;
    errors.nominal[parameter.name] = nominal;
    if (errors.scale == 0) continue;
    const double drawn = nominal * std::exp(errors.scale * tolerance->second * random.normal());
    errors.truth[parameter.name] = std::clamp(drawn, parameter.minimum, parameter.maximum);
  }
  return errors;
}

}  // namespace musclesim::blind
