#include "musclesim/controller/asm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "controller/request.h"
#include "controller/surrogate_plant.h"
#include "musclesim/base/error.h"
#include "musclesim/controller/random_pressures.h"
#include "support/support.h"

namespace musclesim {
namespace {

using test::Prepared;
using test::stateAtHeight;
using test::stateWithHand;

TEST(AsmController, FollowsEquation5StepByStep) {
  // One attractor xi, two steps per decision, no noise, activity 1 (hand at the target), step 0.5:
  // x = 0 -> 0.5 xi -> 0.75 xi, at the next decision 0.9375 xi.
  Prepared prepared{"asm.attractor_count=1", "asm.steps_per_decision=2", "asm.noise_std=0", "asm.step_ratio=0.5"};
  RandomStream stream(prepared.request.seed, "asm.attractors");
  const auto mixture = AttractorMixture::random(2, 1, 0.25, 0.25, stream);
  const Eigen::VectorXd xi = mixture.attractors().col(0);
  AsmController controller(prepared.request);
  EXPECT_FALSE(controller.activity()) << "no decision yet";
  const Action action = controller.output(stateAtHeight(0));
  EXPECT_TRUE(controller.x().isApprox(0.75 * xi, 1e-14));
  EXPECT_DOUBLE_EQ(action[0], (std::tanh(3 * 0.75 * xi[0]) + 1) / 2);
  EXPECT_EQ(controller.activity(), 1.0);
  for (int i = 0; i < 4; ++i) controller.output(stateAtHeight(0));
  EXPECT_TRUE(controller.x().isApprox(0.9375 * xi, 1e-14));
}

TEST(AsmController, DecidesByCountAndHoldsBetween) {
  // Four control steps per decision.
  Prepared prepared{"asm.steps_per_decision=1", "asm.attractor_count=5", "height_task.error_scale_mm=5"};
  AsmController controller(prepared.request);
  Action last;
  for (int step = 0; step < 400; ++step) {
    // Only the hand's position at decisions matters; the state's time does not.
    const Action action = controller.output(stateAtHeight(step % 4 == 0 ? -240 : 0));
    ASSERT_EQ(action != last, step % 4 == 0);
    ASSERT_DOUBLE_EQ(*controller.activity(), 5.0 / 245);
    last = action;
  }
}

TEST(AsmController, RepeatsWithTheSeedOnly) {
  Prepared first, second, third;
  third.request.seed = 2;
  AsmController a(first.request), b(second.request), c(third.request);
  int different = 0;
  for (int step = 0; step < 40; ++step) {
    const State state = stateAtHeight(-240 + step);
    const Action action = a.output(state);
    ASSERT_EQ(action, b.output(state));
    different += action != c.output(state);
  }
  EXPECT_EQ(different, 40);
}

TEST(AsmController, NegativeActivityIsLoggedAndLeavesFluctuationOnly) {
  // The hand moves away from the target at every decision. Without noise the state must then stay where it is: there is no pull in either
  // direction.
  Prepared prepared{"asm.noise_std=0"};
  prepared.request.task = "reach";
  prepared.request.decision_interval_s = 0.01;
  AsmController controller(prepared.request);
  EXPECT_EQ(controller.targetMm(), Vector(-300, 0, 150));
  EXPECT_FALSE(controller.targetIsHeight());
  for (int step = 0; step < 20; ++step) {
    EXPECT_EQ(controller.output(stateWithHand({0, -100.0 * step, 0})), Action({0.5, 0.5}));
    EXPECT_TRUE(step == 0 ? *controller.activity() == 0 : *controller.activity() < 0);
  }
}

TEST(AsmController, ActionsStayInRangeForHostileStates) {
  Prepared prepared{"asm.attractor_count=5", "asm.steps_per_decision=1", "asm.noise_std=2", "height_task.gain=1e6"};
  prepared.request.muscle_count = 10;
  prepared.request.decision_interval_s = 0.01;
  AsmController height(prepared.request);
  prepared.request.task = "reach";
  AsmController reach(prepared.request);
  RandomStream stream(1, "hostile");
  for (int decision = 0; decision < 100000; ++decision) {
    const double size = std::pow(10, stream.uniform(-300, 9));
    const State state = stateWithHand({size * stream.uniform(-1, 1), size * stream.uniform(-1, 1), decision % 7 == 0 ? 0 : size});
    ASSERT_TRUE(test::allInUnitRange(height.output(state)));
    ASSERT_TRUE(test::allInUnitRange(reach.output(state)));
    ASSERT_TRUE(std::isfinite(*height.activity()) && std::isfinite(*reach.activity()));
  }
}

TEST(AsmController, SaysWhenTheHandIsMissingOrLost) {
  Prepared prepared;
  AsmController controller(prepared.request);
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { controller.output(State()); }), "reports the position of its hand"));
  AsmController other(prepared.request);
  EXPECT_THROW(other.output(stateAtHeight(std::nan(""))), Diverged);
}

/// Result of a height run of 300 s with a decision every 6 s, evaluated at the end of each decision interval.
struct HeightRun {
  bool reached = false;   ///< |error| below 20 mm at some time
  double held_after = 0;  ///< share of the intervals from then on with |error| below 20 mm
};

HeightRun runHeight(Controller& controller, std::uint64_t seed) {
  test::SurrogatePlant plant(seed);
  int first = -1, held = 0;
  for (int decision = 0; decision < 50; ++decision) {
    for (int step = 0; step < 60; ++step) plant.step(controller.output(plant.state()), 0.1);
    const bool near = std::abs(plant.state().hand_mm->y()) < 20;
    if (near && first < 0) first = decision;
    held += near;
  }
  if (first < 0) return {};
  return {true, static_cast<double>(held) / (50 - first)};
}

TEST(AsmController, LiftsASurrogateArmAndHoldsIt) {
  int reached = 0, held = 0;
  double held_after = 0, held_after_random = 0;
  constexpr int runs = 20;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    Parameters parameters;  // parameters for this plant, which settles faster than the arm
    parameters.set("height_task.error_scale_mm", 5.0, "test");
    parameters.set("asm.noise_std", 0.13, "test");
    const ControllerRequest request{parameters, 10, 0.1, 6, seed, "height", std::nullopt};
    AsmController controller(request);
    RandomPressuresController baseline(request);
    const HeightRun run = runHeight(controller, seed);
    reached += run.reached;
    held += run.held_after > 0.5;
    held_after += run.held_after / runs;
    held_after_random += runHeight(baseline, seed).held_after / runs;
  }
  RecordProperty("reached", reached);
  RecordProperty("held", held);
  EXPECT_GE(reached, 18);
  EXPECT_GE(held, 12) << "runs that hold the height for most of the time after first reaching it";
  EXPECT_GT(held_after, 4 * held_after_random) << held_after << " against " << held_after_random;
}

}  // namespace
}  // namespace musclesim
