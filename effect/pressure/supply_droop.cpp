#include "supply_droop.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace musclesim {

namespace {

constexpr double filter_s = 0.2;

}  // namespace

EffectInfo SupplyDroop::info() {
  return {
      .id = "supply_droop",
      .stage = Stage::pressure,
      .acts_on = {ComponentKind::all_muscles},
      .summary = "the supply pressure drops under the total demand of all muscles",
      .equation = "p = min(u, 1 - droop (sum over muscles of max(0, s) + mean of u))    u delivered, p actual, s du/dt filtered with 0.2 s",
      .signature = "the error of one muscle follows the demand of the others",
      .source = "pressure drop over the supply's resistance; 0.04 to 0.12 of the supply measured",
      .parameters = {{"droop", "", 0, 0, 1, 0.02, 0.2, "drop of the supply per unit of demand"}},
      .make = [](const EffectValues& values) { return std::make_unique<SupplyDroop>(values["droop"]); },
      .ignores_motion = true};
}

void SupplyDroop::settle(std::vector<double>& ratios) {
  filtered_ = ratios;
  limit(ratios);
}

void SupplyDroop::apply(std::vector<double>& ratios, const StepTime& time) {
  const double kept = std::exp(-time.h_s / filter_s);
  for (std::size_t i = 0; i < ratios.size(); ++i) filtered_[i] = ratios[i] + (filtered_[i] - ratios[i]) * kept;
  limit(ratios);
}

void SupplyDroop::limit(std::vector<double>& ratios) const {
  double demand = std::accumulate(ratios.begin(), ratios.end(), 0.0) / static_cast<double>(ratios.size());
  for (std::size_t i = 0; i < ratios.size(); ++i) demand += std::max(0.0, (ratios[i] - filtered_[i]) / filter_s);
  const double supply = std::max(0.0, 1 - droop_ * demand);
  for (double& ratio : ratios) ratio = std::min(ratio, supply);
}

}  // namespace musclesim
