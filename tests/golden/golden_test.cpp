/// Compares runs with the project's own golden trajectories, which detect any change of the model.
#include "golden.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace musclesim {
namespace {

/// Tolerances of the signals, in their units. The data were written with the stepper `ode`, so with it only rounding may differ.
void expectGolden(const std::string& robot, StepperKind stepper, double tolerance) {
  const Recording golden = readRecording((std::filesystem::path(MUSCLESIM_GOLDEN_FOLDER) / (robot + ".csv")).string());
  ASSERT_EQ(golden.time_s.size(), goldenCommands(robot).time_s.size());
  const ReplayResult result = replayRecording(golden, goldenOptions(stepper));
  ASSERT_FALSE(result.divergence) << *result.divergence;
  ASSERT_FALSE(result.errors.empty());
  for (const SignalError& error : result.errors) {
    EXPECT_EQ(error.sample_count, static_cast<long>(golden.time_s.size())) << error.name;
    EXPECT_LT(error.largest, tolerance) << error.name << " with stepper " << result.stepper;
  }
}

TEST(Golden, RigWithDWorldStep) {
  expectGolden("rig", StepperKind::ode, 1e-6);
}

TEST(Golden, ElbowWithDWorldStep) {
  expectGolden("elbow", StepperKind::ode, 1e-6);
}

TEST(Golden, RigWithTheAutomaticStepper) {
  expectGolden("rig", StepperKind::automatic, 1e-3);
}

TEST(Golden, ElbowWithTheAutomaticStepper) {
  expectGolden("elbow", StepperKind::automatic, 1e-3);
}

}  // namespace
}  // namespace musclesim
