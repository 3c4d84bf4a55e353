#include "valve_lag.h"

#include <cmath>

namespace musclesim {

EffectInfo ValveLag::info() {
  return {
      .id = "valve_lag",
      .stage = Stage::pressure,
      .acts_on = {ComponentKind::muscle},
      .summary = "the valve fills and vents the muscle with a lag",
      .equation =
          "(1 - s) tau dv/dt = u - v, s tau dp/dt = v - p    u delivered, p actual, tau of filling or venting, s = second_lag_share",
      .signature =
          "fast commands are attenuated, with an error in proportion to amplitude; no error remains if the measured pressure drives "
          "the model",
      .source = "first-order lag of valve and volume; 0.05 and 0.084 s, 0.126 and 0.089 s measured",
      .parameters = {{"fill_time_constant_s", "s", 0, 0, 5, 0.01, 0.2, "tau while the pressure rises"},
                     {"vent_time_constant_s", "s", 0, 0, 5, 0.01, 0.2, "tau while the pressure falls"},
                     {"second_lag_share", "", 0, 0, 0.5, 0, 0.5, "s, share of tau that belongs to a second lag in series", true, {}, true}},
      .make = [](const EffectValues& values) {
        return std::make_unique<ValveLag>(values["fill_time_constant_s"], values["vent_time_constant_s"], values["second_lag_share"]);
      }};
}

double ValveLag::output(double input, const StepTime& time) {
  constexpr double equal = 1e-6;
  const double first_s = (1 - share_) * (input > valve_ ? fill_s_ : vent_s_);
  const double first_left = first_s > 0 ? std::exp(-time.h_s / first_s) : 0, valve_off = valve_ - input;
  valve_ = input + valve_off * first_left;
  const double second_s = share_ * (valve_ > pressure_ ? fill_s_ : vent_s_);
  if (second_s <= 0) return pressure_ = valve_;
  const double second_left = std::exp(-time.h_s / second_s), off = pressure_ - input;
  if (std::abs(first_s - second_s) < equal * second_s) return pressure_ = input + (off + valve_off * time.h_s / second_s) * second_left;
  const double shared = valve_off * first_s / (first_s - second_s);
  return pressure_ = input + shared * first_left + (off - shared) * second_left;
}

}  // namespace musclesim
