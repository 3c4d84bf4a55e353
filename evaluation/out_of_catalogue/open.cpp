/// Causes that are not in the catalogue: a shaker, cogging of a joint, pump ripple, a magnet that holds a joint at an angle, gusts, fatigue
/// that grows with the distance travelled, interference on a sensor, air that leaks from one muscle into another.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "laws_by_stage.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/world.h"
#include "wander.h"

namespace musclesim::out_of_catalogue {

namespace {

double wave(double frequency_Hz, double t) {
  return std::sin(2 * std::numbers::pi * frequency_Hz * t);
}

/// F = a sin(2 pi f t) along x and half of it along y
class Shaker final : public HandEffect {
 public:
  explicit Shaker(const EffectValues& v) : amplitude_N_(v["amplitude_N"]), frequency_Hz_(v["frequency_Hz"]) {}
  void apply(const StepTime& time) override {
    if (time.clock_s > 0) addForceN(amplitude_N_ * wave(frequency_Hz_, time.clock_s) * Vector(1, 0.5, 0));
  }

 private:
  double amplitude_N_, frequency_Hz_;
};

/// torque = a sin(n q)
class Cogging final : public JointEffect {
 public:
  explicit Cogging(const EffectValues& v) : torque_Nm_(v["torque_Nm"]), periods_(v["periods_per_turn"]) {}
  void apply(const StepTime&) override { addTorqueNm(torque_Nm_ * std::sin(periods_ * angleDeg() * rad_per_deg)); }

 private:
  double torque_Nm_, periods_;
};

/// p = u (1 + a sin(2 pi f t))
class PumpRipple final : public MuscleRatioEffect {
 public:
  explicit PumpRipple(const EffectValues& v) : ripple_(v["ripple"]), frequency_Hz_(v["frequency_Hz"]) {}

 private:
  double output(double input, const StepTime& time) override {
    return input * (1 + ripple_ * wave(frequency_Hz_, std::max(0.0, time.clock_s)));
  }
  double settled(double input) override { return input; }

  double ripple_, frequency_Hz_;
};

/// torque = -a x exp(1/2 - x^2 / 2),  x = (q - q_0) / 2 deg
class Magnet final : public JointEffect {
 public:
  explicit Magnet(const EffectValues& v) : torque_Nm_(v["torque_Nm"]), at_deg_(v["at_deg"]) {}
  void apply(const StepTime&) override {
    constexpr double reach_deg = 2;
    const double x = (angleDeg() - at_deg_) / reach_deg;
    addTorqueNm(-torque_Nm_ * x * std::exp(0.5 - x * x / 2));
  }

 private:
  double torque_Nm_, at_deg_;
};

/// F = a w(t) along x, w(t) = wander() with an interval of 0.3 s
class Gusts final : public HandEffect {
 public:
  explicit Gusts(const EffectValues& v) : force_N_(v["force_N"]) {}
  void attach(const EffectPlace& place) override {
    HandEffect::attach(place);
    seed_ = place.world.seed();
  }
  void apply(const StepTime& time) override {
    constexpr double interval_s = 0.3;
    if (time.clock_s > 0)
      addForceN({force_N_ * wander(seed_, time.clock_s, interval_s), force_N_ * wander(seed_ + 1, time.clock_s, interval_s), 0});
  }

 private:
  double force_N_;
  std::uint64_t seed_ = 0;
};

/// F' = F max(0, 1 - c s),  s distance travelled in m
class Fatigue final : public ForceEffect {
 public:
  explicit Fatigue(const EffectValues& v) : loss_per_m_(v["loss_per_m"]) {}
  void settle(const MuscleInput& input) override {
    travel_mm_ = 0;
    length_mm_ = input.length_mm;
  }
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override {
    return below(input) * std::max(0.0, 1 - loss_per_m_ * travel_mm_ / mm_per_m);
  }
  void advance(const MuscleInput& input) override {
    travel_mm_ += std::abs(input.length_mm - length_mm_);
    length_mm_ = input.length_mm;
  }

 private:
  double loss_per_m_, travel_mm_ = 0, length_mm_ = 0;
};

/// y' = y + a sin(2 pi f t)
class Interference final : public SensorEffect {
 public:
  explicit Interference(const EffectValues& v) : amplitude_(v["amplitude"]), frequency_Hz_(v["frequency_Hz"]) {}
  double reading(double value, const StepTime& time, long) override { return value + amplitude_ * wave(frequency_Hz_, time.clock_s); }

 private:
  double amplitude_, frequency_Hz_;
};

/// d(p_i)/dt = (u_i - p_i) / 0.05 s + k (p_j - p_i), j the other muscle of the pair
class Bypass final : public RatioEffect {
 public:
  explicit Bypass(const EffectValues& v) : flow_per_s_(v["flow_per_s"]) {}
  void attach(const EffectPlace& place) override {
    muscle_[0] = static_cast<std::size_t>(place.muscle);
    muscle_[1] = static_cast<std::size_t>(place.other_muscle);
  }
  void apply(std::vector<double>& ratios, const StepTime& time) override {
    const double exchange = flow_per_s_ * (pressure_[1] - pressure_[0]);
    for (int i = 0; i < 2; ++i) {
      const double rate = (ratios[muscle_[i]] - pressure_[i]) / regulator_s + (i == 0 ? exchange : -exchange);
      pressure_[i] += time.h_s * rate;
    }
    for (int i = 0; i < 2; ++i) ratios[muscle_[i]] = pressure_[i];
  }
  void settle(std::vector<double>& ratios) override {
    const double sum = ratios[muscle_[0]] + ratios[muscle_[1]];
    const double difference = (ratios[muscle_[0]] - ratios[muscle_[1]]) / (1 + 2 * flow_per_s_ * regulator_s);
    ratios[muscle_[0]] = pressure_[0] = (sum + difference) / 2;
    ratios[muscle_[1]] = pressure_[1] = (sum - difference) / 2;
  }

 private:
  static constexpr double regulator_s = 0.05;
  double flow_per_s_, pressure_[2] = {0, 0};
  std::size_t muscle_[2] = {0, 0};
};

}  // namespace

std::vector<OutOfCatalogueLaw> openEffects() {
  const std::vector<ComponentKind> joint = {ComponentKind::joint}, hand = {ComponentKind::hand}, muscle = {ComponentKind::muscle};
  return {
      {entry("shaker", Stage::body, hand, "F = a sin(2 pi f t)",
             {{"amplitude_N", "N", 0, 0, 1e3, 0.5, 3, "a"}, {"frequency_Hz", "Hz", 5, 0.01, 100, 2, 8, "f", true}},
             [](const EffectValues& v) { return std::make_unique<Shaker>(v); }),
       ""},
      {entry("cogging", Stage::body, joint, "torque = a sin(n q)",
             {{"torque_Nm", "N m", 0, 0, 100, 0.05, 0.3, "a"}, {"periods_per_turn", "", 14, 1, 1e3, 10, 30, "n", true}},
             [](const EffectValues& v) { return std::make_unique<Cogging>(v); }),
       ""},
      {entry("pump_ripple", Stage::pressure, muscle, "p = u (1 + a sin(2 pi f t))",
             {{"ripple", "", 0, 0, 1, 0.03, 0.12, "a"}, {"frequency_Hz", "Hz", 3, 0.01, 100, 1, 6, "f", true}},
             [](const EffectValues& v) { return std::make_unique<PumpRipple>(v); }),
       ""},
      {entry("magnet", Stage::body, joint, "torque = -a x exp(1/2 - x^2 / 2), x = (q - q_0) / 2 deg",
             {{"torque_Nm", "N m", 0, 0, 100, 0.1, 0.5, "a"}, {"at_deg", "deg", 5, -180, 180, -10, 10, "q_0", true}},
             [](const EffectValues& v) { return std::make_unique<Magnet>(v); }),
       ""},
      {entry("gusts", Stage::body, hand, "F = a w(t), w wanders every 0.3 s", {{"force_N", "N", 0, 0, 1e3, 1, 5, "a"}},
             [](const EffectValues& v) { return std::make_unique<Gusts>(v); }),
       ""},
      {entry("fatigue", Stage::force, muscle, "F' = F (1 - c s), s distance travelled", {{"loss_per_m", "1/m", 0, 0, 1e3, 0.1, 0.5, "c"}},
             [](const EffectValues& v) { return std::make_unique<Fatigue>(v); }),
       ""},
      {entry("interference", Stage::sensor, {ComponentKind::signal}, "y' = y + a sin(2 pi f t)",
             {{"amplitude", "unit of the signal", 0, 0, 1e4, 0.5, 3, "a"}, {"frequency_Hz", "Hz", 7, 0.01, 1e3, 3, 20, "f", true}},
             [](const EffectValues& v) { return std::make_unique<Interference>(v); }),
       ""},
      {entry("bypass", Stage::pressure, {ComponentKind::muscle_pair}, "dp_i/dt = (u_i - p_i) / 0.05 s + k (p_j - p_i)",
             {{"flow_per_s", "1/s", 0, 0, 1e3, 1, 6, "k"}}, [](const EffectValues& v) { return std::make_unique<Bypass>(v); }),
       ""},
  };
}

}  // namespace musclesim::out_of_catalogue
