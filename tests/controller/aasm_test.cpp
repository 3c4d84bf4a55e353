#include "musclesim/controller/aasm.h"

#include <gtest/gtest.h>

#include <cmath>

#include "controller/request.h"
#include "controller/surrogate_plant.h"
#include "musclesim/base/error.h"
#include "musclesim/controller/random_pressures.h"
#include "support/support.h"

namespace musclesim {
namespace {

using test::Prepared;
using test::stateWithHand;

TEST(AasmActivity, MatchesItsFormulaWorkedOutByHand) {
  // length 100 mm, e_min 0.1, gamma 0.5; a = 1 / (e + 0.1):
  //   d = 200: e = 4, a = 0.243902, mean a itself: 25 exp(-8) = 0.00838657
  //   d = 100: e = 1, a = 0.909091, mean 0.243902: 66.518847 + 25 exp(-0.5) = 81.682113
  //   d =   0: e = 0, a = 10: clipped to 100;   then d = 500 with mean a above: clipped to 0
  Parameters parameters;
  for (const auto* assignment : {"aasm.length_mm=100", "aasm.error_floor=0.1", "aasm.discount=0.5"})
    parameters.setFromText(assignment, "test");
  AasmActivity activity(parameters);
  EXPECT_NEAR(activity.update(200), 0.008386565697562796, 1e-15);
  EXPECT_NEAR(activity.update(100), 81.68211349946772, 1e-11);
  EXPECT_EQ(activity.update(0), 100);
  EXPECT_EQ(activity.update(500), 0);
}

AttractorMixture pairOfAttractors() {
  Eigen::MatrixXd attractors(1, 2);
  attractors << -0.5, 0.5;
  return {attractors, 0.5};
}

TEST(AdaptiveAttractors, LearnAsWorkedOutByHandAndMoveAtThePeriodOnly) {
  // x = 0.25, N = (0.2689414, 0.7310586); rate 0.2, weight 0.5:
  //   m1 = -0.5 + 0.1 * 0.2689414 * 0.75 = -0.4798294,  m2 = 0.5 - 0.1 * 0.7310586 * 0.25 = 0.4817235
  AdaptiveAttractors adaptive(pairOfAttractors(), 0.2, 2);
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 0.25);
  adaptive.update(x, 0.5);
  EXPECT_EQ(adaptive.mixture().attractors(), pairOfAttractors().attractors());
  adaptive.update(x, 0);  // inactive: learns nothing, but completes the period
  EXPECT_NEAR(adaptive.mixture().attractors()(0, 0), -0.4798293933972503, 1e-14);
  EXPECT_NEAR(adaptive.mixture().attractors()(0, 1), 0.4817235355342497, 1e-14);
}

TEST(AdaptiveAttractors, RejectRatesAndPeriodsOutOfRange) {
  EXPECT_THROW(AdaptiveAttractors(pairOfAttractors(), 1.1, 1), BadParameter);
  EXPECT_THROW(AdaptiveAttractors(pairOfAttractors(), -0.1, 1), BadParameter);
  EXPECT_THROW(AdaptiveAttractors(pairOfAttractors(), 0.1, 0), BadParameter);
}

TEST(AasmController, DecidesByCountAndHoldsBetween) {
  Prepared prepared{"aasm.attractor_count=5", "aasm.steps_per_decision=1"};
  prepared.request.task = "reach";
  AasmController controller(prepared.request);
  EXPECT_FALSE(controller.activity());
  EXPECT_EQ(controller.targetMm(), Vector(-300, 0, 150));
  Action last;
  for (int step = 0; step < 400; ++step) {
    const Action action = controller.output(stateWithHand({0, -200, 0}));
    ASSERT_EQ(action != last, step % 4 == 0);
    last = action;
  }
}

TEST(AasmController, StepsByItsTimeConstantAndNoiseVariance) {
  // Far away from the target nothing pulls: one step is sqrt(0.36 * 0.01 / 0.1) N(0, 1) = 0.18974 N(0, 1).
  Prepared prepared{"aasm.steps_per_decision=1"};
  prepared.request.task = "reach";
  AasmController controller(prepared.request);
  controller.output(stateWithHand({1e6, 0, 0}));
  EXPECT_EQ(controller.activity(), 0.0);
  RandomStream noise(prepared.request.seed, "aasm.noise");
  EXPECT_NEAR(controller.x()[0], std::sqrt(0.036) * noise.normal(), 1e-15);
  EXPECT_NEAR(controller.x()[1], std::sqrt(0.036) * noise.normal(), 1e-15);
}

TEST(AasmController, RepeatsWithTheSeedOnly) {
  Prepared first, second, third;
  third.request.seed = 2;
  AasmController a(first.request), b(second.request), c(third.request);
  int different = 0;
  for (int step = 0; step < 40; ++step) {
    const State state = stateWithHand({0, -240.0 + 6 * step, 0});
    const Action action = a.output(state);
    ASSERT_EQ(action, b.output(state));
    different += action != c.output(state);
  }
  EXPECT_EQ(different, 40);
}

TEST(AasmController, ActionsStayInRangeForHostileStates) {
  Prepared prepared{"aasm.attractor_count=5", "aasm.steps_per_decision=1", "aasm.noise_variance=100",
                    "aasm.learning_rate=1",   "aasm.update_period=1",      "aasm.error_floor=1e-6"};
  prepared.request.task = "reach";
  prepared.request.muscle_count = 10;
  prepared.request.decision_interval_s = 0.01;
  AasmController controller(prepared.request);
  RandomStream stream(1, "hostile");
  for (int decision = 0; decision < 100000; ++decision) {
    const double size = std::pow(10, stream.uniform(-300, 9));
    const Vector offset(size * stream.uniform(-1, 1), decision % 7 == 0 ? 0 : size, size * stream.uniform(-1, 1));
    ASSERT_TRUE(test::allInUnitRange(controller.output(stateWithHand(offset + *controller.targetMm() * (decision % 2)))));
    ASSERT_TRUE(*controller.activity() >= 0 && *controller.activity() <= 100);
  }
  EXPECT_LE(controller.attractors().cwiseAbs().maxCoeff(), 1);
}

TEST(AasmController, SaysWhenTheHandIsMissingOrLost) {
  Prepared prepared;
  AasmController controller(prepared.request);
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { controller.output(State()); }), "reports the position of its hand"));
  EXPECT_THROW(controller.output(stateWithHand({std::nan(""), 0, 0})), Diverged);
}

/// Mean distance from the target over the second half of a run of 300 s, control step 0.02 s, a decision every 6 s.
double lateDistanceMm(Controller& controller, std::uint64_t seed) {
  test::SurrogatePlant plant(seed);
  double sum_mm = 0;
  for (int step = 0; step < 15000; ++step) {
    plant.step(controller.output(plant.state()), 0.02);
    if (step >= 7500) sum_mm += (*plant.state().hand_mm - Vector(-300, 0, 150)).norm();
  }
  return sum_mm / 7500;
}

TEST(AasmController, AttractorsMoveWithin300SecondsAndTheHandComesNearer) {
  // Only a few of the 500 attractors move by more than 0.1: the ones visited while active. The farthest moves by more than 1 on average.
  double late_mm = 0, late_random_mm = 0, farthest = 0, moved = 0;
  constexpr int runs = 8;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    Parameters parameters;
    parameters.setFromText("aasm.learning_rate=0.02", "test");  // per control step, which is twice the usual one here
    const ControllerRequest request{parameters, 10, 0.02, 6, seed, "reach", std::nullopt};
    AasmController controller(request);
    RandomPressuresController baseline(request);
    const Eigen::MatrixXd before = controller.attractors();
    late_mm += lateDistanceMm(controller, seed) / runs;
    late_random_mm += lateDistanceMm(baseline, seed) / runs;
    const Eigen::ArrayXd path = (controller.attractors() - before).colwise().norm().transpose().array();
    EXPECT_GT(path.maxCoeff(), 0.1) << "seed " << seed;
    EXPECT_LE(controller.attractors().cwiseAbs().maxCoeff(), 1);
    farthest += path.maxCoeff() / runs;
    moved += static_cast<double>((path > 0.1).count()) / runs;
  }
  RecordProperty("moved", std::to_string(moved) + " attractors, the farthest by " + std::to_string(farthest));
  EXPECT_GT(farthest, 1);
  EXPECT_GT(moved, 3);
  EXPECT_LT(late_mm, 0.9 * late_random_mm) << late_mm << " mm against " << late_random_mm << " mm";
}

}  // namespace
}  // namespace musclesim
