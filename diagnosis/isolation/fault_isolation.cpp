#include "fault_isolation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "actuation_phases.h"
#include "substitution.h"

namespace musclesim {

namespace {

constexpr std::size_t stage_count = 5;
constexpr double per_misfit = 5;              ///< ln odds of a stage per unit of log misfit of its best disturbance
constexpr double per_further_strength = 0.3;  ///< and per further strength of it: a flexible effect resembles many residuals
constexpr double hardly = 0.03;               ///< factor for a stage that a substitution contradicts

using StageWeights = std::array<double, stage_count>;

std::size_t indexOf(Stage stage) {
  return static_cast<std::size_t>(stage);
}

/// Whether a hypothesis is a fault of the sensor of one of these signals.
bool isSensorOf(const Hypothesis& hypothesis, const std::vector<std::string>& signals) {
  return hypothesis.info().stage == Stage::sensor && hypothesis.component() != "all" &&
         std::ranges::any_of(signals, [&](const std::string& signal) { return Plant::isComponentOf(hypothesis.component(), signal); });
}

/// Shares of the stages by likeness alone, without the sensors of the signals in `acquitted`.
StageWeights byLikeness(const Comparison& comparison, const std::vector<Hypothesis>& hypotheses,
                        const std::vector<Sensitivity>& sensitivities, const std::vector<std::string>& acquitted) {
  StageWeights best;
  best.fill(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    if (isSensorOf(hypotheses[i], acquitted)) continue;
    double& misfit = best[indexOf(hypotheses[i].info().stage)];
    const double further = std::max(0.0, static_cast<double>(hypotheses[i].strengths().size()) - 1);
    misfit = std::min(misfit, sensitivities[i].misfit / comparison.scale() + per_further_strength / per_misfit * further);
  }
  const double least = *std::ranges::min_element(best);
  StageWeights weights{};
  for (std::size_t i = 0; i < stage_count; ++i) weights[i] = std::isfinite(best[i]) ? std::exp(-per_misfit * (best[i] - least)) : 0;
  return weights;
}

void normalise(StageWeights& weights) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  for (double& weight : weights) weight = sum > 0 ? weight / sum : 1.0 / stage_count;
}

/// The most probable component of a stage; for the sensor stage that of the wrong signal, if it is known.
std::string componentOf(Stage stage, const std::vector<Hypothesis>& hypotheses, const std::vector<Sensitivity>& sensitivities,
                        const std::string& wrong_signal) {
  if (stage == Stage::sensor && !wrong_signal.empty())
    for (const Hypothesis& hypothesis : hypotheses)
      if (hypothesis.info().stage == stage && hypothesis.component() != "all" && Plant::isComponentOf(hypothesis.component(), wrong_signal))
        return hypothesis.component();
  std::string component = "all";
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hypotheses.size(); ++i)
    if (hypotheses[i].info().stage == stage && sensitivities[i].misfit < least) {
      least = sensitivities[i].misfit;
      component = hypotheses[i].component();
    }
  return component;
}

/// Evidence from substitution and from the consistency of signals: the stages that it contradicts, and why.
class SignalEvidence {
 public:
  SignalEvidence(const Comparison& comparison, const Eigen::VectorXd& residual) : comparison_(comparison), residual_(residual) {
    askMotion();
    if (allPressuresMeasured(comparison)) askPressures();
    askTensions();
  }
  bool speaksAgainst(Stage stage) const { return against_.contains(stage) && against_.size() < stage_count; }
  /// Signals whose sensors read correctly.
  const std::vector<std::string>& acquittedSignals() const { return acquitted_signals_; }
  /// The signal whose sensor reads wrong, if the evidence shows one; empty otherwise.
  const std::string& wrongSignal() const { return wrong_signal_; }
  std::string words() const {
    if (reasons_.empty())
      return "too few signals for substitution: shares say how much typical disturbances of each stage resemble the gap";
    return fmt::format("{}{}", fmt::join(reasons_, "; "),
                       against_.size() < stage_count ? ""
                                                     : ": there is more than one cause, and shares say how much typical disturbances of "
                                                       "each stage resemble the whole gap");
  }

 private:
  void say(const std::string& reason, std::initializer_list<Stage> against) {
    reasons_.push_back(reason);
    against_.insert(against.begin(), against.end());
  }
  void sayItIsTheSensor(const std::string& signal, const std::string& reason) {
    say(reason, {Stage::command, Stage::pressure, Stage::force, Stage::body});
    wrong_signal_ = signal;
  }

  void askMotion() {
    const auto motion = testMotion(comparison_, residual_);
    if (!motion) return;
    const std::string contradicts =
        fmt::format("{} contradicts the other signals of motion by {:.1f} times the noise", motion->odd, motion->odd_ratio);
    if (!motion->odd.empty() && motion->others_right)
      sayItIsTheSensor(motion->odd, contradicts + ", and these are as predicted");
    else if (!motion->odd.empty())
      say(contradicts + ": its sensor, or where something is mounted", {Stage::command, Stage::pressure, Stage::force});
    else if (motion->agree) {
      acquitted_signals_ = motion->compared;
      say(motion->compared_all
              ? "the signals of motion agree with each other, so none of them alone reads wrong"
              : fmt::format("{} agree with each other, so none of them alone reads wrong", fmt::join(motion->compared, ", ")),
          {});
    }
  }

  void askPressures() {
    const std::optional<double> ratio = ratioOf(comparison_, residual_, "pressure_");
    if (!ratio) return;
    if (*ratio < agrees) {
      say("measured pressures are as predicted, so the gap arises behind the pressure stage", {Stage::command, Stage::pressure});
      return;
    }
    const Plant& plant = comparison_.plant();
    if (plant.holds(Stage::command) || plant.holds(Stage::pressure) || plant.holds(Stage::sensor)) {
      say("pressures differ from the predicted ones; the model holds effects on them beforehand, so they cannot be put in the place of "
          "commands: shares say how much typical disturbances of each stage resemble the gap",
          {});
      return;
    }
    const auto test = testPressures(comparison_, residual_);
    if (!test)
      say("pressures differ from the predicted ones, but the model cannot follow them or they are not complete: shares say how much "
          "typical disturbances of each stage resemble the gap",
          {});
    else if (test->misfit > small_misfit)
      askWhatPressuresMake(*test);
    else if (test->misfit_increase > 2 * small_misfit)
      sayItIsTheSensor(mostAffected(comparison_, residual_, "pressure_"),
                       "measured pressures are not as predicted, but the motion is, and would not be under the pressures that were read");
  }

  void askWhatPressuresMake(const PressureTest& test) {
    constexpr double most = 0.5, sure = 2;  // share of the gap; number of standard deviations
    const double uncertainty = sure * test.share_deviation;
    const bool moves_otherwise = test.misfit_increase >= 2 * small_misfit;
    if (test.share > most && test.share > uncertainty && !moves_otherwise)
      say(fmt::format("the measured pressures in place of the simulated ones make {:.0f} % of the motion's gap, give or take {:.0f}",
                      100 * test.share, std::max(1.0, std::ceil(100 * uncertainty))),
          {Stage::force, Stage::body, Stage::sensor});
    else if (test.share + uncertainty < most)
      say("pressures differ from the predicted ones, but most of the motion's gap stays when they are put in their place: there is more "
          "than one cause, and shares say how much typical disturbances of each stage resemble the whole gap",
          {});
    else
      say(fmt::format("pressures differ from the predicted ones, but {}: shares say how much typical disturbances of each stage resemble "
                      "the gap",
                      moves_otherwise ? "the motion would be another under them" : "how much of the motion's gap they make is uncertain"),
          {});
  }

  void askTensions() {
    const auto tension = testTension(comparison_, residual_);
    if (!tension) return;
    const std::string at = tension->all_commanded    ? "at the commanded pressures and the measured lengths"
                           : tension->some_commanded ? "at the measured lengths and the pressures, measured or commanded"
                                                     : "at the measured pressures and lengths";
    const bool agreed = tension->found < agrees;
    if (agreed && tension->expected > disagrees) {
      if (!tension->of_all_muscles) {
        say("the tensions that are measured follow the force law " + at, {});
        return;
      }
      say("tensions follow the force law " + at, {Stage::force});
      if (tension->all_commanded) against_.insert({Stage::command, Stage::pressure});
    } else if (agreed && !tension->some_commanded) {
      say("the gap is too small to show in tensions against the force law " + at, {});
    } else if (tension->found > disagrees && restIsAsPredicted()) {
      sayItIsTheSensor(
          mostAffected(comparison_, residual_, "force_"),
          fmt::format("tensions differ from the force law {} by {:.1f} times the noise, but all else is as predicted", at, tension->found));
    } else if (tension->found > disagrees) {
      say(fmt::format("tensions differ from the force law {} by {:.1f} times the noise", at, tension->found), {Stage::body});
    }
  }

  bool restIsAsPredicted() const {
    return largestMotionRatio(comparison_, residual_) < agrees && ratioOf(comparison_, residual_, "pressure_").value_or(1) < agrees;
  }

  static constexpr double small_misfit = 0.1;  ///< mean log misfit of motion and tension below which there is no gap to explain
  const Comparison& comparison_;
  const Eigen::VectorXd& residual_;
  std::set<Stage> against_;
  std::vector<std::string> acquitted_signals_;
  std::string wrong_signal_;
  std::vector<std::string> reasons_;
};

}  // namespace

FaultIsolation isolateFault(const Comparison& whole, const Eigen::VectorXd& residual_of_all, const Comparison& screening,
                            const std::vector<Hypothesis>& hypotheses, const std::vector<Sensitivity>& sensitivities) {
  const SignalEvidence evidence(whole, residual_of_all);
  StageWeights weights = byLikeness(screening, hypotheses, sensitivities, evidence.acquittedSignals());
  for (std::size_t i = 0; i < stage_count; ++i)
    if (evidence.speaksAgainst(static_cast<Stage>(i))) weights[i] *= hardly;
  normalise(weights);
  const std::string phase = phaseOf(whole, residual_of_all);
  FaultIsolation isolation{{}, evidence.words()};
  for (std::size_t i = 0; i < stage_count; ++i) {
    const auto stage = static_cast<Stage>(i);
    isolation.places.push_back({nameOf(stage), componentOf(stage, hypotheses, sensitivities, evidence.wrongSignal()), phase, weights[i],
                                evidence.speaksAgainst(stage)});
  }
  std::ranges::stable_sort(isolation.places, [](const Place& a, const Place& b) { return a.share > b.share; });
  return isolation;
}

}  // namespace musclesim
