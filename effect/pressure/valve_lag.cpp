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
          "tau_k dp_k/dt = p_(k-1) - p_k, tau_k = tau r^k / (1 + r + r^2), k = 0, 1, 2    p_-1 = u delivered, p_2 actual, tau of filling "
          "or venting, r = next_lag_ratio; leaks and volume couplings of the muscle are terms of the first lag",
      .signature =
          "fast commands are attenuated, with an error in proportion to amplitude; no error remains if the measured pressure drives "
          "the model",
      .source = "first-order lag of valve and volume; 0.05 and 0.084 s, 0.126 and 0.089 s measured",
      .parameters =
          {{"fill_time_constant_s", "s", 0, 0, 5, 0.01, 0.2, "tau while the pressure rises"},
           {"vent_time_constant_s", "s", 0, 0, 5, 0.01, 0.2, "tau while the pressure falls"},
           {"next_lag_ratio", "", 0, 0, 1, 0, 1, "r, each of three lags in series to the one before it; 0: a single lag", true, {}, true}},
      .make =
          [](const EffectValues& values) {
            return std::make_unique<ValveLag>(values["fill_time_constant_s"], values["vent_time_constant_s"], values["next_lag_ratio"]);
          },
      .ignores_motion = true};
}

double ValveLag::filled(double input, const StepTime& time) {
  if (time.h_s <= 0) return pressures_.back();
  double from = input, to = input, share = 1 / (1 + ratio_ + ratio_ * ratio_);
  for (double& pressure : pressures_) {
    const bool has_terms = hasTerms() && &pressure == pressures_.data();
    const bool fills = to > pressure || (has_terms && to == pressure && rate(pressure).gain_per_s < rate(pressure).loss_per_s * pressure);
    const double before = pressure, lag_s = share * (fills ? fill_s_ : vent_s_);
    const double behind = (to - from) * lag_s / time.h_s;  // of an input that goes on like this
    pressure = lag_s <= 0  ? to
               : has_terms ? pressureAfter(time.h_s, pressure, to, lag_s)
                           : to - behind + (pressure - from + behind) * std::exp(-time.h_s / lag_s);
    from = before;
    to = pressure;
    share *= ratio_;
  }
  return pressures_.back();
}

double ValveLag::settledAir(double input) {
  const double held = hasTerms() ? heldPressure(input, fill_s_ / (1 + ratio_ + ratio_ * ratio_)) : input;
  pressures_.fill(held);
  return held;
}

}  // namespace musclesim
