/// Compares runs with trajectories of the program published with the paper, and with the same motion on the true time scale.
///
/// The trajectories are not part of this repository (support/support.h says where they are expected); the tests are skipped without them.
/// dWorldStep needs seconds per simulated second, so it compares only the beginning unless MUSCLESIM_LONG_TESTS=1; the chain stepper
/// compares all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "musclesim/base/random.h"
#include "musclesim/log/recording.h"
#include "musclesim/simulation/replay.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

Recording beginning(const Recording& whole, double duration_s) {
  Recording part = whole;
  const auto count = std::upper_bound(whole.time_s.begin(), whole.time_s.end(), duration_s + 1e-9) - whole.time_s.begin();
  part.time_s.resize(static_cast<std::size_t>(count));
  for (Signal& signal : part.signals) signal.values.resize(static_cast<std::size_t>(count));
  return part;
}

bool chainStepperExists() {
  Simulation simulation;
  simulation.build("elbow");
  return simulation.stepper().name() == "chain";
}

class Published : public ::testing::TestWithParam<const char*> {
 protected:
  /// Compares up to a given time, with tolerances of 0.01 mm in the first 10 s and 0.5 mm in the first 18 s.
  void compare(StepperKind stepper, double duration_s) {
    const auto file = sharedFolder() / "reference" / "trajectories" / (std::string(GetParam()) + ".csv");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no published trajectories at " << file << "; set MUSCLESIM_SHARED";
    const Recording published = beginning(readRecording(file.string()), duration_s);
    ReplayOptions options;
    options.stepper = stepper;
    const ReplayResult result = replayRecording(published, options);
    ASSERT_FALSE(result.divergence) << *result.divergence;
    EXPECT_EQ(result.substeps, 1);
    double worst_mm = 0;
    for (const double until_s : {10.0, 18.0}) {
      int compared_count = 0;
      for (const SignalError& error : compareSignals(beginning(result.simulated, until_s), published)) {
        EXPECT_LT(error.largest, until_s == 10 ? 0.01 : 0.5) << error.name << " in the first " << std::min(until_s, duration_s) << " s";
        worst_mm = std::max(worst_mm, error.largest);
        ++compared_count;
      }
      EXPECT_EQ(compared_count, 13) << "hand and ten lengths";
      if (until_s >= duration_s) break;
    }
    std::printf("[          ] %s, %s: largest difference in %g s: %.3g mm\n", GetParam(), result.stepper.c_str(), duration_s, worst_mm);
  }
};

TEST_P(Published, TrajectoryIsReproducedWithDWorldStep) {
  compare(StepperKind::ode, longTests() ? 18 : 3);
}

TEST_P(Published, TrajectoryIsReproducedWithTheAutomaticStepper) {
  if (!chainStepperExists()) GTEST_SKIP() << "the automatic stepper is dWorldStep: see the other test";
  compare(StepperKind::automatic, 18);
}

INSTANTIATE_TEST_SUITE_P(All, Published, ::testing::Values("steps_every_6s", "vented"),
                         [](const auto& tested) { return std::string(tested.param); });

/// Largest distance of the hands between `scaled` and `original` after equal numbers of steps; the step of `scaled` is sqrt(1000) times
/// shorter.
double scalingDifferenceMm(StepperKind stepper, double scaled_duration_s) {
  constexpr double original_step_s = 0.01, decision_interval_s = 6;
  SimulationOptions slow, fast;
  slow.physics = PhysicsKind::original;
  slow.step_s = original_step_s;
  fast.physics = PhysicsKind::scaled;
  fast.step_s = original_step_s / std::sqrt(1000.0);
  slow.stepper = fast.stepper = stepper;
  slow.substeps = fast.substeps = 1;
  Simulation original(slow), scaled(fast);
  original.build("arm");
  scaled.build("arm");
  RandomStream random(1, "golden.scaling");
  double difference_mm = 0;
  const auto steps_per_decision = std::lround(decision_interval_s / original_step_s);
  for (long i = 0; i < std::lround(scaled_duration_s / original_step_s); ++i) {
    if (i % steps_per_decision == 0) {
      Action action(10);
      for (double& pressure : action) pressure = random.uniform();
      original.robot().step(action);
      scaled.robot().step(action);
    }
    original.step();
    scaled.step();
    difference_mm = std::max(difference_mm, (*original.robot().getState().hand_mm - *scaled.robot().getState().hand_mm).norm());
  }
  std::printf("[          ] %s: largest distance of the hands in %g s: %.3g mm\n", original.stepper().name().c_str(), scaled_duration_s,
              difference_mm);
  return difference_mm;
}

TEST(Scaling, TheOriginalIsTheSameMotionSlowerByTheSquareRootOfAThousand) {
  EXPECT_LT(scalingDifferenceMm(StepperKind::ode, longTests() ? 10 : 1.5), 1);
}

TEST(Scaling, HoldsWithTheAutomaticStepperForTenSeconds) {
  if (!chainStepperExists()) GTEST_SKIP() << "the automatic stepper is dWorldStep: see the other test";
  EXPECT_LT(scalingDifferenceMm(StepperKind::automatic, 10), 1);
}

}  // namespace
}  // namespace musclesim
