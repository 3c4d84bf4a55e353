#include "musclesim/controller/replay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "controller/request.h"
#include "musclesim/base/error.h"
#include "musclesim/controller/controller_registry.h"
#include "support/support.h"

namespace musclesim {
namespace {

using test::atTime;

/// Rows at 1.0, 1.1 and 2.0 s for two muscles.
Recording threeRows() {
  Recording recording;
  recording.file = "three.csv";
  recording.time_s = {1.0, 1.1, 2.0};
  recording.signals = {{"command_0", {0.1, 0.2, 0.3}}, {"length_0_mm", {1, 2, 3}}, {"command_1", {1, 0, 0.5}}};
  return recording;
}

std::string refusal(const Recording& recording, int muscle_count = 2) {
  return messageOf<BadFile>([&] { ReplayController replay(recording, muscle_count); });
}

TEST(ReplayController, HoldsEachRowUntilTheNext) {
  ReplayController replay(threeRows(), 2);
  EXPECT_EQ(replay.output(atTime(1.0)), Action({0.1, 1}));
  EXPECT_EQ(replay.output(atTime(1.0999)), Action({0.1, 1}));
  EXPECT_EQ(replay.output(atTime(1.1)), Action({0.2, 0}));
  EXPECT_EQ(replay.output(atTime(1.99)), Action({0.2, 0}));
  EXPECT_EQ(replay.output(atTime(2.0)), Action({0.3, 0.5}));
}

TEST(ReplayController, HoldsTheFirstRowBeforeItAndTheLastAfterIt) {
  ReplayController replay(threeRows(), 2);
  EXPECT_EQ(replay.output(atTime(-5)), Action({0.1, 1}));
  EXPECT_EQ(replay.output(atTime(0)), Action({0.1, 1}));
  EXPECT_EQ(replay.output(atTime(1e6)), Action({0.3, 0.5}));
  EXPECT_EQ(replay.output(atTime(1.5)), Action({0.2, 0})) << "any order of times";
}

TEST(ReplayController, MovesOnAStraightLineIfAskedTo) {
  ReplayController replay(threeRows(), 2, true);
  EXPECT_EQ(replay.output(atTime(0)), Action({0.1, 1}));
  EXPECT_EQ(replay.output(atTime(1.1)), Action({0.2, 0})) << "the very number of the row";
  const Action between = replay.output(atTime(1.1 + 0.9 * 0.25));
  EXPECT_NEAR(between[0], 0.2 + 0.1 * 0.25, 1e-12);
  EXPECT_NEAR(between[1], 0.5 * 0.25, 1e-12);
  EXPECT_EQ(replay.output(atTime(3)), Action({0.3, 0.5}));
  EXPECT_EQ(replay.endS(), 2.0);
}

TEST(ReplayController, SaysWhichRowsAreNeverPlayed) {
  test::Prepared prepared;
  prepared.request.commands_file = testing::TempDir() + "fine.csv";
  std::ofstream(prepared.request.commands_file) << "time_s,command_0,command_1\n1,0,0\n1.004,0.5,0\n1.008,1,0\n1.01,0,1\n";
  const auto schedule = makeController("schedule", prepared.request);
  EXPECT_EQ(schedule->output(atTime(1.01)), Action({0, 1}));
  const auto notes = schedule->notes();
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_TRUE(contains(notes[0], "begin at 1 s")) << notes[0];
  EXPECT_TRUE(contains(notes[1], "2 of 4 rows")) << notes[1];
}

TEST(ReplayController, NeedsAFile) {
  test::Prepared prepared;
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { makeController("schedule", prepared.request); }), "--commands"));
}

TEST(ReplayController, RoundingOfTimesDelaysNoRow) {
  Recording recording;
  std::vector<double> values;
  for (int row = 0; row < 1000; ++row) {
    recording.time_s.push_back(0.1 * row);
    values.push_back(row / 1000.0);
  }
  recording.signals = {{"command_0", values}};
  ReplayController replay(recording, 1);
  double accumulated = 0;  // differs from 0.1 * row by rounding, in both directions
  for (int row = 0; row < 1000; ++row, accumulated += 0.1) ASSERT_EQ(replay.output(atTime(accumulated)).at(0), row / 1000.0);
}

TEST(ReplayController, NeedsOneCommandPerMuscle) {
  EXPECT_TRUE(contains(refusal(threeRows(), 3), "three.csv: there is no complete command_2"));
  EXPECT_TRUE(contains(refusal(threeRows(), 1), "more than the 1 muscles"));
  EXPECT_TRUE(contains(refusal(Recording(), 1), "no rows"));
}

TEST(ReplayController, RejectsRowsItCannotPlay) {
  Recording backwards = threeRows();
  backwards.time_s[2] = 1.1;
  EXPECT_TRUE(contains(refusal(backwards), "row 3"));
  Recording missing = threeRows();
  missing.signals[0].values[1] = std::nan("");
  EXPECT_TRUE(contains(refusal(missing), "command_0 = nan at 1.1 s"));
  Recording too_high = threeRows();
  too_high.signals[2].values[0] = 1.5;
  EXPECT_TRUE(contains(refusal(too_high), "command_1 = 1.5 at 1 s"));
  Recording short_column = threeRows();
  short_column.signals[0].values.pop_back();
  EXPECT_TRUE(contains(refusal(short_column), "no complete command_0"));
}

}  // namespace
}  // namespace musclesim
