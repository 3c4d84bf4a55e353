// Sensitivities if the typical strength is far from the right one.
#include "diagnosis/sensitivity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/refit.h"
#include "planted.h"

namespace musclesim {
namespace {

/// A rig with one effect, screened for a single effect: the same or another one.
struct Looked {
  enum class Strengths { adapted, kept };
  Looked(const ActiveEffect& effect, Strengths strengths, const std::string& for_effect = "")
      : options(planted::few({for_effect.empty() ? effect.id : for_effect})),
        plant(planted::plant({effect}), options),
        hypothesis(hypotheses(plant, options).back()) {  // the law without further shares
    std::vector<Hypothesis> all = {hypothesis};
    if (strengths == Strengths::adapted) {
      sensitivity = sensitivitiesOf(comparison, all, nominal, Model{}, 2, [] {}).front();
    } else {
      sensitivity = changesOf(comparison, all, nominal, Model{}, 2, [] {}).front();
      fitLinearly(comparison, all.front(), comparison.measured() - nominal, sensitivity);
    }
    hypothesis = all.front();
  }
  /// From the typical strength.
  FitResult fitted() const {
    FitProblem problem;
    problem.start = hypothesis.typical();
    problem.clamped = [&](const Eigen::VectorXd& z) { return hypothesis.clamped(z); };
    problem.predicted = [&](const Eigen::VectorXd& z) { return comparison.predicted(Model{{hypothesis.at(z)}, {}}); };
    return fit(comparison, problem, 8);
  }
  double before() const { return comparison.misfit(comparison.measured() - nominal); }
  double valueAt(double strength) const {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(hypothesis.coordinateCount());
    z[hypothesis.strengths().front()] = strength;
    return hypothesis.valuesAt(z).front().second;
  }
  DiagnosisOptions options;
  Plant plant;
  Comparison comparison{plant, {{0, 0, 400}, {1, 0, 400}}, Comparison::Derived::with};
  Eigen::VectorXd nominal = comparison.predicted(Model{});
  Hypothesis hypothesis;
  Sensitivity sensitivity;
};

/// The usual thresholds, 0.02 to 0.1, are below all commands.
const ActiveEffect wide_dead_band = {"command_dead_band", "muscle_0", {{"threshold", 0.32}}};

TEST(SensitivityAtAThreshold, BeginsWhereTheEffectShows) {
  const Looked adapted(wide_dead_band, Looked::Strengths::adapted);
  EXPECT_TRUE(adapted.sensitivity.from_threshold);
  EXPECT_NEAR(adapted.valueAt(1), 0.32, 0.005);
  EXPECT_LT(adapted.fitted().cost, 0.2 * adapted.before());
  ASSERT_TRUE(adapted.sensitivity.excitation_ratio.has_value());
  EXPECT_LT(*adapted.sensitivity.excitation_ratio, 0.01) << "as strong as usual it shows nothing";
}

TEST(SensitivityAtAThreshold, LeavesStrengthsThatAreToBeKept) {
  const Looked kept(wide_dead_band, Looked::Strengths::kept);
  EXPECT_FALSE(kept.sensitivity.from_threshold);
  EXPECT_GT(kept.fitted().cost, 0.9 * kept.before()) << "where nothing shows no fit finds the way";
  EXPECT_LT(kept.valueAt(1), 0.1);
}

TEST(SensitivityRelinearised, FollowsAnEffectThatIsManyTimesAsStrongAsTypical) {
  const ActiveEffect tiring = {"force_drift", "muscle_0", {{"rate_per_min", -1.0}}};
  const Looked adapted(tiring, Looked::Strengths::adapted), kept(tiring, Looked::Strengths::kept);
  EXPECT_GE(std::abs(adapted.valueAt(1)), 5 * kept.valueAt(1));
  EXPECT_NEAR(adapted.valueAt(adapted.sensitivity.amount[0]), -1.0, 0.2);
  EXPECT_LT(adapted.sensitivity.misfit, kept.sensitivity.misfit - 1.25 * adapted.comparison.scale()) << "e^1.25 times less in all blocks";
}

TEST(SensitivityRelinearised, EndsWhereTheEffectIsImpossible) {
  // To be 120 mm higher, the load of 2 kg would have to weigh less than nothing.
  const Looked adapted({"sensor_bias", "signal_length_0", {{"offset", -120.0}}}, Looked::Strengths::adapted, "payload");
  EXPECT_LT(adapted.sensitivity.misfit, adapted.before());
  EXPECT_DOUBLE_EQ(adapted.sensitivity.amount[0], -5) << "more is asked for";
}

}  // namespace
}  // namespace musclesim
