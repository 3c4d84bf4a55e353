#include "simulation/display/player.h"

#include <gtest/gtest.h>

#include "simulation/display/time_line.h"

namespace musclesim {
namespace {

Snapshot snapshotAt(float x_mm) {
  Snapshot snapshot;
  DrawnPart part{Shape::Kind::sphere, {10, 0, 0}, Eigen::Matrix4f::Identity(), {}};
  part.pose(0, 3) = x_mm;
  snapshot.parts.push_back(part);
  return snapshot;
}

/// Five rows, 1 s apart from 10 s on. With effects the simulation follows the ghost; without, it stays behind from the third row on, and a
/// last row is missing.
Player lagging() {
  std::vector<double> time_s = {10, 11, 12, 13, 14};
  Trajectory without{{}, {{"length_0_mm", time_s, {0, 1, 2, 3, 4}, {0, 1, 0, 0}, 0.1}}, "diverged at 14 s"};
  Trajectory with{{}, {{"length_0_mm", time_s, {0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, 0.1}}, std::nullopt};
  std::vector<std::shared_ptr<const DrawnGhost>> ghosts;
  for (int row = 0; row < 5; ++row) {
    with.snapshots.push_back(snapshotAt(static_cast<float>(row)));
    if (row < 4) without.snapshots.push_back(snapshotAt(row < 2 ? static_cast<float>(row) : 0));
    ghosts.push_back(std::make_shared<DrawnGhost>(DrawnGhost{snapshotAt(static_cast<float>(row)).parts, {}}));
  }
  return {time_s, {without, with}, ghosts, "from a test"};
}

TEST(Player, GoesToTimesAndStaysInTheRecording) {
  Player player = lagging();
  EXPECT_EQ(player.row(), 0u);
  player.seek(12.7);
  EXPECT_EQ(player.row(), 2u);
  player.step(1);
  EXPECT_EQ(player.timeS(), 13);
  player.step(-9);
  EXPECT_EQ(player.timeS(), 10);
  player.seek(99);
  EXPECT_EQ(player.timeS(), 14);
  player.seek(-1);
  EXPECT_EQ(player.timeS(), 10);
}

TEST(Player, LoopsOrStopsAtTheEnd) {
  Player player = lagging();
  player.seek(13.5);
  EXPECT_TRUE(player.advance(1));
  EXPECT_NEAR(player.timeS(), 10.5, 1e-12);
  player.setLooping(false);
  player.seek(13.5);
  EXPECT_FALSE(player.advance(1));
  EXPECT_EQ(player.timeS(), 14);
}

TEST(Player, EffectsMoveTheSimulationOntoTheGhostAndTakeTheMarksAway) {
  Player player = lagging();
  EXPECT_TRUE(player.withEffects()) << "the replay as it was asked for";
  EXPECT_TRUE(player.outsideS().empty());
  player.seek(13);
  EXPECT_EQ(distanceOfGhostMm(*player.snapshot()), 0);
  player.setEffects(false);
  EXPECT_EQ(distanceOfGhostMm(*player.snapshot()), 3);
  ASSERT_EQ(player.outsideS().size(), 1u);
  EXPECT_EQ(player.outsideS()[0], std::pair(12.0, 13.0));
}

TEST(Player, TheNextGapFollowsThePresentTime) {
  Player player = lagging();
  EXPECT_FALSE(player.seekNextGap()) << "there are none";
  player.setEffects(false);
  EXPECT_TRUE(player.seekNextGap());
  EXPECT_EQ(player.timeS(), 12);
  EXPECT_TRUE(player.seekNextGap()) << "again from the beginning";
  EXPECT_EQ(player.timeS(), 12);
}

TEST(Player, AfterADivergenceTheGhostGoesOn) {
  Player player = lagging();
  player.setEffects(false);
  player.seek(13);
  EXPECT_FALSE(player.divergence());
  player.seek(14);
  EXPECT_EQ(player.divergence(), "diverged at 14 s");
  EXPECT_EQ(distanceOfGhostMm(*player.snapshot()), 4);
  player.setEffects(true);
  EXPECT_FALSE(player.divergence());
}

TEST(Player, FastRecordingsAreThinnedOut) {
  EXPECT_EQ(playedRows({0, 0.001, 0.0099, 0.01, 0.012, 0.5}), (std::vector<std::size_t>{0, 3, 5}));
  EXPECT_EQ(playedRows({3}), std::vector<std::size_t>{0});
}

TEST(TimeLine, PixelsAndTimesCorrespond) {
  const Player player = lagging();
  const TimeLine line = TimeLine::in(700, 480);
  EXPECT_TRUE(line.contains(350, 480 - 19));
  EXPECT_FALSE(line.contains(350, 300));
  for (const double time_s : {10.0, 11.5, 14.0}) EXPECT_NEAR(line.timeAt(player, line.xOf(player, time_s)), time_s, 1e-4);
  EXPECT_EQ(line.timeAt(player, -50), 10);
}

}  // namespace
}  // namespace musclesim
