#include "flow_limit.h"

#include <algorithm>
#include <cmath>

#include "../catalogue.h"

namespace musclesim {

EffectInfo FlowLimit::info() {
  return {
      .id = "flow_limit",
      .stage = Stage::pressure,
      .acts_on = {ComponentKind::muscle},
      .summary = "choked flow limits how fast the pressure changes",
      .equation = "-vent_rate_per_s <= dp/dt <= fill_rate_per_s, otherwise p = u    u delivered, p actual",
      .signature = "ramps at large steps, small steps untouched",
      .source = "choked flow through an orifice (ISO 6358); +7 and -2.7 bar/s of 6 bar measured",
      .parameters = {{"fill_rate_per_s", "1/s", unlimited, 0.01, unlimited, 0.3, 2, "largest dp/dt"},
                     {"vent_rate_per_s", "1/s", unlimited, 0.01, unlimited, 0.3, 2, "largest -dp/dt"}},
      .make = [](const EffectValues& values) { return std::make_unique<FlowLimit>(values["fill_rate_per_s"], values["vent_rate_per_s"]); }};
}

double FlowLimit::output(double input, const Moment& moment) {
  const double rate_per_s = input > pressure_ ? fill_per_s_ : vent_per_s_;
  if (std::isinf(rate_per_s)) return pressure_ = input;  // also at a look: infinity times 0 is not a number
  const double reach = rate_per_s * moment.h_s;
  return pressure_ = std::clamp(input, pressure_ - reach, pressure_ + reach);
}

}  // namespace musclesim
