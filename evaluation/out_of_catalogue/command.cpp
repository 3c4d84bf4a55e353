/// Out-of-catalogue laws of the command stage: a dead time that varies at random (buses and valves of different speeds), a truncating
/// converter with unequal steps, a dead band with hysteresis (static friction of a spool), two channels that exchange most of their
/// commands.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../effect/history.h"
#include "laws_by_stage.h"
#include "musclesim/robot/world.h"
#include "wander.h"

namespace musclesim::out_of_catalogue {

namespace {

/// u'(t) = u(t - T (1 + J w(t))),  w varies at random between -1 and 1
class WanderingDelay final : public MuscleRatioEffect {
 public:
  explicit WanderingDelay(const EffectValues& v) : delay_s_(v["delay_s"]), jitter_s_(v["jitter_ratio"] * v["delay_s"]) {}
  void attach(const EffectPlace& place) override {
    MuscleRatioEffect::attach(place);
    seed_ = place.world.seed() + static_cast<std::uint64_t>(place.muscle);
  }
  void reset() override { history_.clear(); }

 private:
  double output(double input, const StepTime& time) override {
    constexpr double interval_s = 0.05;
    history_.hold(time.clock_s, input);
    const double result = history_.at(time.clock_s - std::max(0.0, delay_s_ + jitter_s_ * wander(seed_, time.clock_s, interval_s)));
    history_.forgetBefore(time.clock_s - delay_s_ - jitter_s_);
    return result;
  }
  double settled(double input) override {
    history_.holdForEver(input);
    return input;
  }

  double delay_s_, jitter_s_;
  std::uint64_t seed_ = 0;
  HeldHistory history_;
};

/// u' = (k + c sin(2 pi k / n)) / n,  k = floor(n u)
class UnequalSteps final : public MuscleRatioEffect {
 public:
  explicit UnequalSteps(const EffectValues& v) : levels_(std::exp2(v["bits"])), bow_(v["bow_levels"]) {}

 private:
  double output(double input, const StepTime&) override { return settled(input); }
  double settled(double input) override {
    const double level = std::floor(input * levels_);
    return std::clamp((level + bow_ * std::sin(2 * std::numbers::pi * level / levels_)) / levels_, 0.0, 1.0);
  }

  double levels_, bow_;
};

/// Opens at u_t, closes at 0.75 u_t, and opens its orifice gradually: open, u' = u - u_t / 2 exp(-2 (u - 0.75 u_t) / u_t).
class StickingDeadBand final : public MuscleRatioEffect {
 public:
  explicit StickingDeadBand(const EffectValues& v) : threshold_(v["threshold"]) {}

 private:
  double output(double input, const StepTime&) override {
    open_ = input >= (open_ ? closing_ratio : 1) * threshold_;
    return delivered(input);
  }
  double settled(double input) override {
    open_ = input >= threshold_;
    return delivered(input);
  }
  double delivered(double input) const {
    if (!open_ || threshold_ <= 0) return open_ ? input : 0;
    return input - 0.5 * threshold_ * std::exp(-2 * (input / threshold_ - closing_ratio));
  }

  static constexpr double closing_ratio = 0.75;
  double threshold_;
  bool open_ = false;
};

/// u_i' = (1 - c) u_i + c u_j, and the same with i and j exchanged.
class MostlySwapped final : public RatioEffect {
 public:
  explicit MostlySwapped(const EffectValues& v) : share_(v["share"]) {}
  void attach(const EffectPlace& place) override {
    first_ = static_cast<std::size_t>(place.muscle);
    second_ = static_cast<std::size_t>(place.other_muscle);
  }
  void apply(std::vector<double>& ratios, const StepTime&) override { settle(ratios); }
  void settle(std::vector<double>& ratios) override {
    const double u = ratios[first_], w = ratios[second_];
    ratios[first_] = (1 - share_) * u + share_ * w;
    ratios[second_] = (1 - share_) * w + share_ * u;
  }

 private:
  double share_;
  std::size_t first_ = 0, second_ = 0;
};

}  // namespace

std::vector<OutOfCatalogueLaw> commandLaws() {
  const std::vector<ComponentKind> muscle = {ComponentKind::muscle};
  return {
      {entry("wandering_delay", Stage::command, muscle, "u'(t) = u(t - T (1 + J w(t))), w wanders in -1 .. 1",
             {{"delay_s", "s", 0, 0, 2, 0.01, 0.1, "T"}, {"jitter_ratio", "", 0.1, 0, 1, 0.05, 0.3, "J", true}},
             [](const EffectValues& v) { return std::make_unique<WanderingDelay>(v); }),
       "transport_delay"},
      {entry("unequal_steps", Stage::command, muscle, "u' = (k + c sin(2 pi k / n)) / n, k = floor(n u), n = 2^bits",
             {{"bits", "bit", INFINITY, 1, INFINITY, 4, 7, "resolution"}, {"bow_levels", "", 0.1, 0, 100, 0.05, 0.2, "c", true}},
             [](const EffectValues& v) { return std::make_unique<UnequalSteps>(v); }),
       "command_quantisation"},
      {entry("sticking_dead_band", Stage::command, muscle,
             "0 until u reaches the threshold, then u - u_t / 2 exp(-2 (u - 0.75 u_t) / u_t) until it falls below 0.75 of it",
             {{"threshold", "", 0, 0, 1, 0.1, 0.35, "of full scale"}},
             [](const EffectValues& v) { return std::make_unique<StickingDeadBand>(v); }),
       "command_dead_band"},
      {entry("mostly_swapped", Stage::command, {ComponentKind::muscle_pair}, "u_i' = (1 - c) u_i + c u_j and the other way round",
             {{"share", "", 0, 0, 1, 0.85, 0.97, "c"}}, [](const EffectValues& v) { return std::make_unique<MostlySwapped>(v); }),
       "channel_swap"},
  };
}

}  // namespace musclesim::out_of_catalogue
