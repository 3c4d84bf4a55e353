#include "machine.h"

#include <algorithm>
#include <map>

#include "chance.h"
#include "musclesim/base/error.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim::blind {

namespace {

struct Sizes {
  double low, high;
};

/// Measured sizes of a cause, by parameter of the law; the law's other parameters lie in their usual ranges.
using MeasuredSizes = std::map<std::string, Sizes>;

/// By catalogue id.
const std::map<std::string, MeasuredSizes>& measuredSizes() {
  constexpr double full_scale_bar = 6, least = 0.8, most = 1.2;  // machines differ from the one that was measured
  constexpr double fill_per_s = 7 / full_scale_bar, vent_per_s = 2.7 / full_scale_bar, zero = -0.3 / full_scale_bar;
  static const std::map<std::string, MeasuredSizes> sizes = {
      {"transport_delay", {{"delay_s", {0.044, 0.096}}}},
      {"valve_lag", {{"fill_time_constant_s", {0.05, 0.126}}, {"vent_time_constant_s", {0.05, 0.126}}}},
      {"flow_limit",
       {{"fill_rate_per_s", {least * fill_per_s, most * fill_per_s}}, {"vent_rate_per_s", {least * vent_per_s, most * vent_per_s}}}},
      {"braid_hysteresis", {{"relative_width", {0.05, 0.17}}}},
      {"creep", {{"amount", {0.07, 0.25}}, {"time_constant_s", {0.5, 1}}}},
      {"pressure_calibration", {{"gain", {1, 1}}, {"offset", {most * zero, least * zero}}, {"bow", {-0.01, 0.01}}}}};
  return sizes;
}

const OutOfCatalogueLaw& lawFor(const std::string& cause) {
  return *std::ranges::find(outOfCatalogueLaws(), cause, &OutOfCatalogueLaw::stands_for);
}

Cause drawMeasured(const std::string& id, const std::string& component, RandomStream& random) {
  const OutOfCatalogueLaw& law = lawFor(id);
  std::vector<double> values = drawSizes(law.info, random);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (const auto size = measuredSizes().at(id).find(law.info.parameters[i].name); size != measuredSizes().at(id).end())
      values[i] = random.uniform(size->second.low, size->second.high);
  return {.id = id, .component = component, .law = activeEffect(law.info, component, values), .stage = law.info.stage, .measured = true};
}

}  // namespace

std::vector<Cause> drawMachine(int count, const Robot& robot, RandomStream& random) {
  if (count < 0 || count > most_machine_causes)
    throw BadParameter("causes of a machine", std::to_string(count), "be in 0 .. " + std::to_string(most_machine_causes));
  std::vector<std::string> ids = {"transport_delay", happens(random, 0.5) ? "valve_lag" : "flow_limit", "braid_hysteresis", "creep",
                                  "pressure_calibration"};
  std::vector<Cause> causes;
  for (; count > 0; --count) {
    const auto chosen = ids.begin() + static_cast<std::ptrdiff_t>(indexBelow(random, ids.size()));
    causes.push_back(drawMeasured(*chosen, componentsFor(lawFor(*chosen).info, robot).front(), random));
    ids.erase(chosen);
  }
  return causes;
}

Cause drawnAgain(const Cause& cause, RandomStream& random) {
  return drawMeasured(cause.id, cause.component, random);
}

}  // namespace musclesim::blind
