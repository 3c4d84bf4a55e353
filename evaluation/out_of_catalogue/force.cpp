/// Out-of-catalogue laws of the force stage: Bouc-Wen hysteresis (Bouc 1967, Wen 1976), a loss with a power of speed, two Kelvin elements,
/// a pressure threshold without a kink, a gain that depends on the length, an offset that grows with the length, a tendon that stiffens, a
/// drift that ends (warm-up), Eq. 1 times a parabola.
#include <algorithm>
#include <cmath>

#include "laws_by_stage.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/actuator.h"

namespace musclesim::out_of_catalogue {

namespace {

/// F' = F + w ((1 - c) F + c p F_0) z,  F_0 tension at full pressure and length,  dz = dl / s (1 - (0.5 + 0.5 sign(z dl)) |z|^n)
class BoucWen final : public ForceEffect {
 public:
  explicit BoucWen(const EffectValues& v)
      : width_(v["relative_width"]), scale_mm_(v["scale_mm"]), exponent_(v["exponent"]), share_(v["pressure_share"]) {}
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override {
    const double tension_N = below(input), full_N = actuator().forceLaw().tensionN(1, actuator().restLengthMm());
    const double friction_N = width_ * ((1 - share_) * tension_N + share_ * std::max(0.0, input.pressure_ratio) * full_N);
    return std::max(0.0, tension_N + friction_N * stateAt(input.length_mm));
  }
  void advance(const MuscleInput& input) override {
    state_ = stateAt(input.length_mm);
    length_mm_ = input.length_mm;
  }
  void settle(const MuscleInput& input) override {
    state_ = 0;
    length_mm_ = input.length_mm;
  }

 private:
  double stateAt(double length_mm) const {
    const double dl = length_mm - length_mm_;
    const double slope = 1 - (state_ * dl > 0 ? std::pow(std::abs(state_), exponent_) : 0);
    return std::clamp(state_ + dl / scale_mm_ * slope, -1.0, 1.0);
  }
  double width_, scale_mm_, exponent_, share_, state_ = 0, length_mm_ = 0;
};

/// F' = F + D,  D -> c sign(v) |v|^0.7 within 2 ms
class PowerLoss final : public ForceEffect {
 public:
  explicit PowerLoss(const EffectValues& v) : loss_N_(v["loss_at_100_mm_per_s_N"]) {}
  void reset() override { now_N_ = 0; }
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override { return below(input) + now_N_; }
  void advance(const MuscleInput& input) override {
    constexpr double exponent = 0.7, reference_mm_per_s = 100, rise_s = 2e-3;
    const double v = input.rate_mm_per_s / reference_mm_per_s;
    const double target = loss_N_ * std::copysign(std::pow(std::abs(v), exponent), v);
    now_N_ = target + (now_N_ - target) * std::exp(-input.time.h_s / rise_s);
  }

 private:
  double loss_N_, now_N_ = 0;
};

/// Two creep elements in series, 60 % with tau and 40 % with 6 tau.
class TwoKelvinElements final : public ForceEffect {
 public:
  explicit TwoKelvinElements(const EffectValues& v) : amount_(v["amount"]), tau_s_(v["time_constant_s"]) {}
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override {
    MuscleInput inside = input;
    inside.length_mm -= fast_mm_ + slow_mm_;
    return below(inside);
  }
  void advance(const MuscleInput& input) override {
    const double immediate_mm = input.length_mm - fast_mm_ - slow_mm_ - actuator().restLengthMm();
    fast_mm_ += input.time.h_s / tau_s_ * (fast_share * amount_ * immediate_mm - fast_mm_);
    slow_mm_ += input.time.h_s / (slow_factor * tau_s_) * ((1 - fast_share) * amount_ * immediate_mm - slow_mm_);
  }
  void settle(const MuscleInput& input) override {
    const double total_mm = amount_ / (1 + amount_) * (input.length_mm - actuator().restLengthMm());
    fast_mm_ = fast_share * total_mm;
    slow_mm_ = (1 - fast_share) * total_mm;
  }

 private:
  static constexpr double fast_share = 0.6, slow_factor = 6;
  double amount_, tau_s_, fast_mm_ = 0, slow_mm_ = 0;
};

/// p' = p^2 (1 + p_t) / (p + p_t): no kink; approaches p - p_t far above p_t.
class GradualOnset final : public ForceEffect {
 public:
  explicit GradualOnset(const EffectValues& v) : threshold_(v["threshold"]) {}
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override {
    MuscleInput inside = input;
    const double p = std::max(0.0, input.pressure_ratio);
    if (p > 0) inside.pressure_ratio = p * p * (1 + threshold_) / (p + threshold_);
    return below(inside);
  }

 private:
  double threshold_;
};

double lengthRatio(const Actuator& actuator, double length_mm) {
  return (length_mm - actuator.contractedLengthMm()) / (actuator.restLengthMm() - actuator.contractedLengthMm());
}

/// F' = (g + s (r - 1/2) + c (r - 1/2)^2) F
class BentForce final : public ForceEffect {
 public:
  BentForce(double gain, double slope, double curvature) : gain_(gain), slope_(slope), curvature_(curvature) {}
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override {
    const double x = lengthRatio(actuator(), input.length_mm) - 0.5;
    return below(input) * (gain_ + slope_ * x + curvature_ * x * x);
  }

 private:
  double gain_, slope_, curvature_;
};

/// F' = F(p, l + d (3 + 2 r) / 4): the muscle's end straightens as the muscle is stretched
class BendingEnd final : public ForceEffect {
 public:
  explicit BendingEnd(const EffectValues& v) : offset_mm_(v["offset_mm"]) {}
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override {
    MuscleInput inside = input;
    inside.length_mm += offset_mm_ * (3 + 2 * lengthRatio(actuator(), input.length_mm)) / 4;
    return below(inside);
  }

 private:
  double offset_mm_;
};

/// F' = F(p, l - x) = k s (exp(x / s) - 1),  s = 4 mm, by bisection
class StiffeningTendon final : public ForceEffect {
 public:
  explicit StiffeningTendon(const EffectValues& v) : stiffness_(v["stiffness_N_per_mm"]) {}
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override {
    constexpr double scale_mm = 4, longest_mm = 60;
    constexpr int halvings = 45;
    auto muscle = [&](double x) {
      MuscleInput inside = input;
      inside.length_mm -= x;
      return below(inside);
    };
    auto tendon = [&](double x) { return stiffness_ * scale_mm * std::expm1(x / scale_mm); };
    double low = 0, high = longest_mm;
    if (!(muscle(0) > 0)) return 0;
    for (int i = 0; i < halvings; ++i) {
      const double middle = (low + high) / 2;
      (muscle(middle) > tendon(middle) ? low : high) = middle;
    }
    return muscle(low);
  }

 private:
  double stiffness_;
};

/// F' = F (1 + r T (1 - exp(-t / T)))
class WarmUp final : public ForceEffect {
 public:
  explicit WarmUp(const EffectValues& v) : rate_per_s_(v["rate_per_min"] / s_per_min), duration_s_(v["duration_s"]) {}
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override {
    const double t = std::max(0.0, input.time.clock_s);
    return below(input) * (1 - rate_per_s_ * duration_s_ * std::expm1(-t / duration_s_));
  }

 private:
  double rate_per_s_, duration_s_;
};

}  // namespace

std::vector<OutOfCatalogueLaw> forceLaws() {
  const std::vector<ComponentKind> muscle = {ComponentKind::muscle};
  return {
      {entry("bouc_wen", Stage::force, muscle, "F' = F + w ((1 - c) F + c p F_0) z, dz = dl / s (1 - |z|^n) away from 0, dl / s towards it",
             {{"relative_width", "", 0, 0, 1, 0.03, 0.12, "w"},
              {"scale_mm", "mm", 1.5, 0.05, 50, 0.5, 3, "s", true},
              {"exponent", "", 1.5, 1, 10, 1, 3, "n", true},
              {"pressure_share", "", 0, 0, 1, 0, 1, "c", true}},
             [](const EffectValues& v) { return std::make_unique<BoucWen>(v); }),
       "braid_hysteresis"},
      {entry("power_loss", Stage::force, muscle, "F' = F + c sign(v) |v / 100 mm/s|^0.7",
             {{"loss_at_100_mm_per_s_N", "N", 0, 0, 1e3, 2, 20, "c"}},
             [](const EffectValues& v) { return std::make_unique<PowerLoss>(v); }),
       "viscous_loss"},
      {entry("two_kelvin_elements", Stage::force, muscle, "60 % of the creep with tau, 40 % with 6 tau",
             {{"amount", "", 0, 0, 10, 0.05, 0.25, "of both together"}, {"time_constant_s", "s", 0.7, 1e-2, 1e3, 0.3, 3, "tau", true}},
             [](const EffectValues& v) { return std::make_unique<TwoKelvinElements>(v); }),
       "creep"},
      {entry("gradual_onset", Stage::force, muscle, "p' = p^2 (1 + p_t) / (p + p_t)", {{"threshold", "", 0, 0, 0.9, 0.04, 0.15, "p_t"}},
             [](const EffectValues& v) { return std::make_unique<GradualOnset>(v); }),
       "threshold_pressure"},
      {entry("sloping_gain", Stage::force, muscle, "F' = (1 + (g - 1) (1 + s (r - 1/2))) F",
             {{"gain", "", 1, 0, 10, 0.75, 1.25, "g"}, {"slope", "", 0.4, -5, 5, -0.6, 0.6, "s", true}},
             [](const EffectValues& v) { return std::make_unique<BentForce>(v["gain"], (v["gain"] - 1) * v["slope"], 0); }),
       "force_gain"},
      {entry("bending_end", Stage::force, muscle, "F' = F(p, l + d (3 + 2 r) / 4)", {{"offset_mm", "mm", 0, -500, 500, -15, 15, "d"}},
             [](const EffectValues& v) { return std::make_unique<BendingEnd>(v); }),
       "length_offset"},
      {entry("stiffening_tendon", Stage::force, muscle, "F' = F(p, l - x) = k s (exp(x / s) - 1), s = 4 mm",
             {{"stiffness_N_per_mm", "N/mm", INFINITY, 0.01, INFINITY, 1, 20, "k, of small stretch"}},
             [](const EffectValues& v) { return std::make_unique<StiffeningTendon>(v); }),
       "series_elasticity"},
      {entry("warm_up", Stage::force, muscle, "F' = F (1 + r T (1 - exp(-t / T)))",
             {{"rate_per_min", "1/min", 0, -10, 10, -0.6, 0.6, "r"}, {"duration_s", "s", 8, 0.1, 1e4, 4, 30, "T", true}},
             [](const EffectValues& v) { return std::make_unique<WarmUp>(v); }),
       "force_drift"},
      {entry("bent_law", Stage::force, muscle, "F' = F (1 + s x + c x^2), x = r - 1/2",
             {{"slope", "", 0, -5, 5, -0.4, 0.4, "s"}, {"curvature", "", 0, -20, 20, -0.7, 0.7, "c"}},
             [](const EffectValues& v) { return std::make_unique<BentForce>(1, v["slope"], v["curvature"]); }),
       "force_law"},
  };
}

}  // namespace musclesim::out_of_catalogue
