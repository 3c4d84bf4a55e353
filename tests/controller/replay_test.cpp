#include "musclesim/controller/replay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

State atTime(double time_s) {
  State state;
  state.time_s = time_s;
  return state;
}

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
