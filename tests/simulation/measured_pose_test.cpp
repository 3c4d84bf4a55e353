#include "simulation/measured_pose.h"

#include <gtest/gtest.h>

#include <limits>

namespace musclesim {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Replayed {
  Recording recording;
  std::vector<Snapshot> snapshots;
};

/// One second of a robot whose first muscle is filled and whose others are vented a little, with everything measured.
Replayed replayed(const std::string& robot, int muscle_count) {
  Recording commands;
  commands.info.robot = robot;
  commands.info.initial_state = "built";
  for (int i = 0; i < muscle_count; ++i) commands.signals.push_back({"command_" + std::to_string(i), {}});
  for (int row = 0; row < 20; ++row) {
    commands.time_s.push_back(0.05 * row);
    for (int i = 0; i < muscle_count; ++i) commands.signals[static_cast<std::size_t>(i)].values.push_back(i == 0 ? 0.7 : 0.2);
  }
  Replayed result;
  ReplayOptions options;
  options.watch = [&](Simulation& simulation) {
    return [&result, taker = std::make_shared<SnapshotTaker>(simulation)](const State& state) {
      result.snapshots.push_back(taker->take(state));
    };
  };
  result.recording = replayRecording(commands, options).simulated;
  return result;
}

void keepOnly(Recording& recording, const std::string& begin) {
  std::erase_if(recording.signals,
                [&](const Signal& signal) { return !signal.name.starts_with(begin) && !signal.name.starts_with("command_"); });
}

/// Expects that the ghost stands where the robot was simulated.
void expectPosesOf(const Replayed& robot, double tolerance_mm) {
  MeasuredPoses poses(robot.recording, {});
  ASSERT_TRUE(poses.areDetermined()) << poses.reason();
  double way_mm = 0;
  for (std::size_t row = 0; row < robot.snapshots.size(); ++row) {
    Snapshot snapshot = robot.snapshots[row];
    snapshot.ghost = poses.at(row, robot.snapshots[row]);
    EXPECT_LT(*distanceOfGhostMm(snapshot), tolerance_mm) << "row " << row << ", " << poses.reason();
    snapshot.ghost = poses.at(0, robot.snapshots[0]);
    way_mm = std::max(way_mm, *distanceOfGhostMm(snapshot));
  }
  EXPECT_GT(way_mm, 10 * tolerance_mm) << "the robot moves";
}

TEST(MeasuredPoses, FollowFromJointAngles) {
  Replayed elbow = replayed("elbow", 2);
  keepOnly(elbow.recording, "angle_");
  EXPECT_EQ(MeasuredPoses(elbow.recording, {}).reason(), "from the joint angles");
  expectPosesOf(elbow, 0.1);
}

TEST(MeasuredPoses, FollowFromLengths) {
  Replayed elbow = replayed("elbow", 2);
  keepOnly(elbow.recording, "length_");
  EXPECT_EQ(MeasuredPoses(elbow.recording, {}).reason(), "from the muscle lengths");
  expectPosesOf(elbow, 0.1);
  Replayed rig = replayed("rig", 1);
  keepOnly(rig.recording, "length_");
  expectPosesOf(rig, 0.1);
}

TEST(MeasuredPoses, FollowFromTheHand) {
  Replayed elbow = replayed("elbow", 2);
  keepOnly(elbow.recording, "hand_");
  EXPECT_EQ(MeasuredPoses(elbow.recording, {}).reason(), "from the hand's position");
  expectPosesOf(elbow, 0.1);
}

/// The arm's radius and ulna form a loop, and its muscles run in curves.
TEST(MeasuredPoses, OfTheArmNeedAnglesAndLengths) {
  const Replayed arm = replayed("arm", 10);
  EXPECT_EQ(MeasuredPoses(arm.recording, {}).reason(), "from the joint angles and the muscle lengths");
  expectPosesOf(arm, 3);
}

TEST(MeasuredPoses, AreNotDeterminedByPressures) {
  Replayed elbow = replayed("elbow", 2);
  keepOnly(elbow.recording, "pressure_");
  MeasuredPoses poses(elbow.recording, {});
  EXPECT_FALSE(poses.areDetermined());
  EXPECT_EQ(poses.reason(), "neither joint angles nor muscle lengths nor the hand's position are measured");
  EXPECT_EQ(poses.at(0, elbow.snapshots[0]), nullptr);
}

TEST(MeasuredPoses, MissingValuesKeepTheLastOnes) {
  Replayed elbow = replayed("elbow", 2);
  keepOnly(elbow.recording, "angle_");
  for (Signal& signal : elbow.recording.signals)
    if (signal.name.starts_with("angle_"))
      for (const std::size_t row : {std::size_t{0}, std::size_t{6}}) signal.values[row] = nan;
  MeasuredPoses poses(elbow.recording, {});
  const auto expectSame = [&](std::size_t one, std::size_t other) {
    Snapshot snapshot = elbow.snapshots[0];
    snapshot.parts = poses.at(one, elbow.snapshots[one])->parts;
    snapshot.ghost = poses.at(other, elbow.snapshots[other]);
    EXPECT_EQ(*distanceOfGhostMm(snapshot), 0) << one << ", " << other;
  };
  expectSame(0, 1);
  expectSame(6, 5);
}

}  // namespace
}  // namespace musclesim
