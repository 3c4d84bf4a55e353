#include "flow_limit.h"

#include <algorithm>
#include <cmath>

#include "atmosphere.h"

namespace musclesim {

EffectInfo FlowLimit::info() {
  return {.id = "flow_limit",
          .stage = Stage::pressure,
          .acts_on = {ComponentKind::muscle},
          .summary = "choked flow limits how fast the pressure changes",
          .equation =
              "dp/dt = rate sat((u - p) / proportional_band), rate = fill_rate_per_s for u > p, vent_rate_per_s (1 - c + c (p + p_atm) / "
              "(1 + p_atm)) for u < p    u delivered, p actual, p_atm = 0.17, c = vent_pressure_share",
          .signature = "large steps become ramps, small steps are unchanged",
          .source = "choked flow through an orifice (ISO 6358); +7 and -2.7 bar/s of 6 bar measured",
          .parameters = {{"fill_rate_per_s", "1/s", unlimited, 0.01, unlimited, 0.3, 2, "largest dp/dt"},
                         {"vent_rate_per_s", "1/s", unlimited, 0.01, unlimited, 0.3, 2, "largest -dp/dt"},
                         {"proportional_band", "1", 0, 0, 0.5, 0.01, 0.03,
                          "distance |u - p| below which the flow falls in proportion to it", true},
                         {"vent_pressure_share", "", 0, 0, 1, 0, 1,
                          "c; 0: a muscle vents at one rate, 1: in proportion to its absolute pressure", true}},
          .make =
              [](const EffectValues& values) {
                return std::make_unique<FlowLimit>(values["fill_rate_per_s"], values["vent_rate_per_s"], values["proportional_band"],
                                                   values["vent_pressure_share"]);
              },
          .ignores_motion = true};
}

double FlowLimit::ventRatePerS() const {
  if (pressure_share_ == 0) return vent_per_s_;
  return vent_per_s_ * (1 - pressure_share_ + pressure_share_ * (pressure_ + atmosphere_ratio) / (1 + atmosphere_ratio));
}

double FlowLimit::output(double input, const StepTime& time) {
  const double rate_per_s = input > pressure_ ? fill_per_s_ : ventRatePerS();
  if (std::isinf(rate_per_s)) return pressure_ = input;  // also for a query with h_s = 0, where infinity times 0 would be NaN
  const double distance = std::abs(input - pressure_), sign = input > pressure_ ? 1 : -1;
  const double full_flow_s = std::max(0.0, distance - band_) / rate_per_s;  // time until p reaches the band
  if (full_flow_s >= time.h_s) return pressure_ += sign * rate_per_s * time.h_s;
  if (band_ == 0) return pressure_ = input;
  const double left = std::min(distance, band_) * std::exp(-(time.h_s - full_flow_s) * rate_per_s / band_);
  return pressure_ = input - sign * left;
}

}  // namespace musclesim
