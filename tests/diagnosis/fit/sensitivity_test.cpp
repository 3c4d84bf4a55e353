// Sensitivities on a rig, also where the typical strength is far from the right one.
#include "diagnosis/fit/sensitivity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../planted.h"
#include "../short_rig.h"
#include "diagnosis/fit/refit.h"

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

class LoadedRig : public planted::ShortRig {
 protected:
  LoadedRig() : ShortRig({{"payload", "hand", {{"mass_kg", 0.1}}}}, 0.05) {}
};

TEST_F(LoadedRig, FirstLookSeesThePayload) {
  options.candidates = {"payload", "valve_lag"};
  std::vector<Hypothesis> all = hypotheses(plant, options);
  const Eigen::VectorXd nominal = both.predicted(Model{});
  int simulations = 0;
  const std::vector<Sensitivity> sensitivities = sensitivitiesOf(both, all, nominal, Model{}, 1, [&] { ++simulations; });
  EXPECT_GT(simulations, 1);
  const double before = both.misfit(both.measured() - nominal);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].info().id == "payload") {
      EXPECT_LT(sensitivities[i].misfit, 0.4 * before);
      const auto values = all[i].valuesAt(sensitivities[i].amount);
      EXPECT_NEAR(values.front().second, 0.1, 0.03);
    } else {
      EXPECT_GT(sensitivities[i].misfit, 0.8 * before);
    }
  }
}

class SlightlyDampedRig : public planted::ShortRig {
 protected:
  SlightlyDampedRig() : ShortRig({{"viscous_loss", "muscle_0", {{"damping_Ns_per_m", damping}}}}, 0.05) {}
  static constexpr double damping = 3;  // the first look begins at 245
};

TEST_F(SlightlyDampedRig, StrengthsThatDoTooMuchAreWeakened) {
  options.candidates = {"viscous_loss"};
  std::vector<Hypothesis> all = hypotheses(plant, options);
  const Eigen::VectorXd nominal = both.predicted(Model{});
  const double typical = all.front().valuesAt(all.front().typical()).front().second;
  const std::vector<Sensitivity> sensitivities = sensitivitiesOf(both, all, nominal, Model{}, 1, [] {});
  Eigen::VectorXd z = Eigen::VectorXd::Zero(all.front().coordinateCount());
  z[all.front().strengths().front()] = 1;
  EXPECT_LT(all.front().valuesAt(z).front().second, 0.1 * typical);
  z[all.front().strengths().front()] = sensitivities.front().amount[0];
  EXPECT_NEAR(all.front().valuesAt(z).front().second, damping, 0.5 * damping);
  EXPECT_LT(sensitivities.front().misfit, 0.6 * both.misfit(both.measured() - nominal));
}

class PushedRig : public planted::ShortRig {
 protected:
  PushedRig() : ShortRig({{"external_force", "hand", {{"force_y_N", -2.0}}}}, 0.05) {}
};

/// The load of the rig moves up and down only.
TEST_F(PushedRig, StrengthsThatDoNothingAreLeftOut) {
  options.candidates = {"external_force"};
  std::vector<Hypothesis> all = hypotheses(plant, options);
  ASSERT_EQ(all.front().coordinateCount(), 3);
  const Eigen::VectorXd nominal = both.predicted(Model{});
  const std::vector<Sensitivity> sensitivities = sensitivitiesOf(both, all, nominal, Model{}, 1, [] {});
  ASSERT_EQ(all.front().coordinateCount(), 1);
  EXPECT_EQ(sensitivities.front().per_strength.size(), 1U);
  const auto values = all.front().valuesAt(sensitivities.front().amount);
  ASSERT_EQ(values.size(), 1U);
  EXPECT_EQ(values.front().first, "force_y_N");
  EXPECT_NEAR(values.front().second, -2, 0.5);
}

class TiltedRig : public planted::ShortRig {
 protected:
  TiltedRig() : ShortRig({{"base_tilt", "base", {{"tilt_z_deg", 6.0}}}}, 0.05) {}
};

/// On the rig a tilt to the front and one to the side act alike, in either direction: one of them is kept, and it explains the gap.
TEST_F(TiltedRig, OfStrengthsThatActAlikeOneIsLeft) {
  options.candidates = {"base_tilt"};
  std::vector<Hypothesis> all = hypotheses(plant, options), fresh = all;
  const Eigen::VectorXd nominal = both.predicted(Model{});
  const std::vector<Sensitivity> sensitivities = sensitivitiesOf(both, all, nominal, Model{}, 1, [] {});
  ASSERT_EQ(all.front().coordinateCount(), 1);
  const double before = both.misfit(both.measured() - nominal);
  EXPECT_LT(sensitivities.front().misfit, 0.2 * before);
  std::vector<Sensitivity> of_all = changesOf(both, fresh, nominal, Model{}, 1, [] {});
  ASSERT_GT(of_all.front().per_strength.size(), 1U);
  fitLinearly(both, fresh.front(), both.measured() - nominal, of_all.front());
  EXPECT_LT(of_all.front().misfit, 0.2 * before) << "two that act alike do not drive each other against their bounds";
}

}  // namespace
}  // namespace musclesim
