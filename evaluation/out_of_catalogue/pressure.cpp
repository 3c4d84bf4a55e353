/// Out-of-catalogue laws of the pressure stage: a lag of a line and of a growing volume, an orifice with choked and subsonic flow (ISO
/// 6358), a choked leak, a tail that large changes shorten, a tank that empties, the volume of an ideal braid (Chou and Hannaford 1996), a
/// bowed calibration.
#include <algorithm>
#include <cmath>

#include "laws_by_stage.h"
#include "musclesim/robot/actuator.h"

namespace musclesim::out_of_catalogue {

namespace {

constexpr double atmosphere_ratio = 0.17;

/// A line, dv/dt = 4 (u - v) / tau, before a volume that grows with the pressure, dp/dt = (v - p) / (tau (0.45 + 0.6 p)).
class GrowingLag final : public MuscleRatioEffect {
 public:
  explicit GrowingLag(const EffectValues& v) : fill_s_(v["fill_time_constant_s"]), vent_s_(v["vent_time_constant_s"]) {}

 private:
  double output(double input, const StepTime& time) override {
    constexpr double share_of_line = 0.25, empty_share = 0.45, growth = 0.6;
    const auto follow = [&](double& pressure, double to, double share) {
      const double tau_s = share * (to > pressure ? fill_s_ : vent_s_);
      pressure = tau_s > 0 ? to + (pressure - to) * std::exp(-time.h_s / tau_s) : to;
    };
    follow(line_, input, share_of_line);
    follow(muscle_, line_, empty_share + growth * muscle_);
    return muscle_;
  }
  double settled(double input) override { return line_ = muscle_ = input; }

  double fill_s_, vent_s_, line_ = 0, muscle_ = 0;
};

/// Flow through an orifice over its largest flow, as a function of the ratio of absolute pressures; choked below 0.3.
double flowShare(double ratio) {
  constexpr double critical = 0.3;
  if (ratio <= critical) return 1;
  const double x = std::min(1.0, (ratio - critical) / (1 - critical));
  return std::sqrt(std::max(0.0, 1 - x * x));
}

/// dp/dt = rate psi(p / supply) sat((u - p) / 0.03) while filling; rate psi(atmosphere / p) p ... while venting.
class Orifice final : public MuscleRatioEffect {
 public:
  explicit Orifice(const EffectValues& v) : fill_per_s_(v["fill_rate_per_s"]), vent_per_s_(v["vent_rate_per_s"]) {}

 private:
  double output(double input, const StepTime& time) override {
    constexpr double opening_range = 0.03;
    const double opening = std::clamp((input - pressure_) / opening_range, -1.0, 1.0);
    const double absolute = pressure_ + atmosphere_ratio;
    const double rate = opening > 0 ? fill_per_s_ * flowShare(absolute / (1.2 + atmosphere_ratio))
                                    : vent_per_s_ * flowShare(atmosphere_ratio / absolute) * absolute / (0.5 + atmosphere_ratio);
    if (std::isinf(rate)) return pressure_ = input;
    const double next = pressure_ + time.h_s * rate * opening;
    return pressure_ = opening > 0 ? std::min(next, input) : std::max(next, input);
  }
  double settled(double input) override { return pressure_ = input; }

  double fill_per_s_, vent_per_s_, pressure_ = 0;
};

/// dp/dt = (u - p) / tau - k (p + p_atm)^n while p > 0: the flow depends on the absolute pressure; n = 1 for choked flow
class ChokedLeak final : public MuscleRatioEffect {
 public:
  explicit ChokedLeak(const EffectValues& v) : leak_per_s_(v["leak_per_s"]), regulator_s_(v["regulator_s"]), exponent_(v["exponent"]) {}

 private:
  double lossPerS(double pressure) const { return leak_per_s_ * std::pow(pressure + atmosphere_ratio, exponent_); }
  double output(double input, const StepTime& time) override {
    return pressure_ = std::max(0.0, pressure_ + time.h_s * ((input - pressure_) / regulator_s_ - lossPerS(pressure_)));
  }
  /// Solves p + tau k (p + p_atm)^n = u by bisection.
  double settled(double input) override {
    constexpr int halvings = 50;
    double low = 0, high = input;
    for (int i = 0; i < halvings; ++i) {
      const double middle = (low + high) / 2;
      (middle + regulator_s_ * lossPerS(middle) < input ? low : high) = middle;
    }
    return pressure_ = low;
  }

  double leak_per_s_, regulator_s_, exponent_, pressure_ = 0;
};

/// ds/dt = (1 - s) / T - c sum max(0, du_i/dt),  p_i = min(u_i, s)
class Tank final : public RatioEffect {
 public:
  explicit Tank(const EffectValues& v) : capacity_(v["loss_per_fill"]), recovery_s_(v["recovery_s"]) {}
  void apply(std::vector<double>& ratios, const StepTime& time) override {
    for (std::size_t i = 0; i < ratios.size(); ++i) supply_ -= capacity_ * std::max(0.0, ratios[i] - before_[i]);
    before_ = ratios;
    supply_ = std::max(0.0, 1 + (supply_ - 1) * std::exp(-time.h_s / recovery_s_));
    for (double& ratio : ratios) ratio = std::min(ratio, supply_);
  }
  void settle(std::vector<double>& ratios) override {
    supply_ = 1;
    before_ = ratios;
  }

 private:
  double capacity_, recovery_s_, supply_ = 1;
  std::vector<double> before_;
};

/// dp/dt = (u - p) / tau - (p + p_atm) (dV/dt) / V,  V ~ l (b^2 - l^2), b = 1.1 l_0
class BraidVolume final : public MuscleRatioEffect {
 public:
  explicit BraidVolume(const EffectValues& v) : coupling_(v["coupling"]), regulator_s_(v["regulator_time_constant_s"]) {}

 private:
  double output(double input, const StepTime& time) override {
    constexpr double strand_ratio = 1.1;
    const double l = actuator().lengthMm(), b = strand_ratio * actuator().restLengthMm();
    const double volume_rate = lengthRateMmPerS() * (b * b - 3 * l * l) / (l * (b * b - l * l));
    const double rate = (input - pressure_) / regulator_s_ - coupling_ * (pressure_ + atmosphere_ratio) * volume_rate;
    return pressure_ = std::max(0.0, pressure_ + time.h_s * rate);
  }
  double settled(double input) override { return pressure_ = input; }

  double coupling_, regulator_s_, pressure_ = 0;
};

/// p = u - s (u - w),  dw/dt = (u - w) |u - w| / (0.2 tau) + (u - w) / (4 tau): large changes end sooner than small ones
class HurriedTail final : public MuscleRatioEffect {
 public:
  explicit HurriedTail(const EffectValues& v) : share_(v["share"]), time_constant_s_(v["time_constant_s"]) {}

 private:
  double output(double input, const StepTime& time) override {
    constexpr double full_change = 0.2, slow_factor = 4;
    const double left = input - slow_;
    const double rate_per_s = (std::abs(left) / full_change + 1 / slow_factor) / time_constant_s_;
    slow_ = input - left * std::exp(-rate_per_s * time.h_s);
    return input - share_ * (input - slow_);
  }
  double settled(double input) override { return slow_ = input; }

  double share_, time_constant_s_, slow_ = 0;
};

/// p' = g p + o + c p (1 - p)
class BowedCalibration final : public MuscleRatioEffect {
 public:
  explicit BowedCalibration(const EffectValues& v) : gain_(v["gain"]), offset_(v["offset"]), bow_(v["bow"]) {}

 private:
  double output(double input, const StepTime&) override { return settled(input); }
  double settled(double p) override { return std::max(0.0, gain_ * p + offset_ + bow_ * p * (1 - p)); }

  double gain_, offset_, bow_;
};

}  // namespace

std::vector<OutOfCatalogueLaw> pressureLaws() {
  const std::vector<ComponentKind> muscle = {ComponentKind::muscle};
  return {
      {entry("growing_lag", Stage::pressure, muscle, "dv/dt = 4 (u - v) / tau, dp/dt = (v - p) / (tau (0.45 + 0.6 p))",
             {{"fill_time_constant_s", "s", 0, 0, 5, 0.02, 0.2, "tau while the pressure rises"},
              {"vent_time_constant_s", "s", 0, 0, 5, 0.02, 0.2, "tau while the pressure falls"}},
             [](const EffectValues& v) { return std::make_unique<GrowingLag>(v); }),
       "valve_lag"},
      {entry("orifice", Stage::pressure, muscle, "dp/dt = rate psi(pressure ratio) sat((u - p) / 0.03), psi of ISO 6358",
             {{"fill_rate_per_s", "1/s", INFINITY, 0.01, INFINITY, 0.3, 2, "choked filling"},
              {"vent_rate_per_s", "1/s", INFINITY, 0.01, INFINITY, 0.3, 2, "choked venting at half of full scale"}},
             [](const EffectValues& v) { return std::make_unique<Orifice>(v); }),
       "flow_limit"},
      {entry("choked_leak", Stage::pressure, muscle, "dp/dt = (u - p) / tau - k (p + p_atm)^n",
             {{"leak_per_s", "1/s", 0, 0, 100, 0.2, 2, "k"},
              {"regulator_s", "s", 0.07, 1e-3, 5, 0.03, 0.12, "tau", true},
              {"exponent", "", 1, 0.3, 1.5, 0.5, 1, "n", true}},
             [](const EffectValues& v) { return std::make_unique<ChokedLeak>(v); }),
       "leak"},
      {entry("hurried_tail", Stage::pressure, muscle, "p = u - s (u - w), dw/dt = (u - w) (|u - w| / 0.2 + 1 / 4) / tau",
             {{"share", "", 0, 0, 0.5, 0.04, 0.3, "s"}, {"time_constant_s", "s", 1, 0.01, 1000, 0.4, 2, "tau", true}},
             [](const EffectValues& v) { return std::make_unique<HurriedTail>(v); }),
       "regulator_tail"},
      {entry("tank", Stage::pressure, {ComponentKind::all_muscles}, "ds/dt = (1 - s) / T - c sum max(0, du/dt), p = min(u, s)",
             {{"loss_per_fill", "", 0, 0, 10, 0.2, 0.8, "c"}, {"recovery_s", "s", 0.3, 0.01, 100, 0.1, 0.6, "T", true}},
             [](const EffectValues& v) { return std::make_unique<Tank>(v); }),
       "supply_droop"},
      {entry("braid_volume", Stage::pressure, muscle, "dp/dt = (u - p) / tau - n (p + p_atm) (dV/dt) / V, V ~ l (b^2 - l^2)",
             {{"coupling", "", 0, 0, 10, 1, 1.4, "n"}, {"regulator_time_constant_s", "s", 0.1, 1e-3, 10, 0.05, 0.5, "tau", true}},
             [](const EffectValues& v) { return std::make_unique<BraidVolume>(v); }),
       "volume_coupling"},
      {entry("bowed_calibration", Stage::pressure, muscle, "p' = g p + o + c p (1 - p)",
             {{"gain", "", 1, 0, 5, 0.88, 1.12, "g"}, {"offset", "", 0, -1, 1, -0.05, 0.05, "o"}, {"bow", "", 0, -1, 1, -0.03, 0.03, "c"}},
             [](const EffectValues& v) { return std::make_unique<BowedCalibration>(v); }),
       "pressure_calibration"},
  };
}

}  // namespace musclesim::out_of_catalogue
