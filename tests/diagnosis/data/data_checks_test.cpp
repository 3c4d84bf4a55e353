// What is checked of recordings before anything is diagnosed.
#include "diagnosis/data/data_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Recording recordingOf(const std::string& file, const std::vector<double>& command, const std::vector<double>& length) {
  Recording recording;
  recording.file = file;
  recording.info.robot = "rig";
  for (std::size_t row = 0; row < command.size(); ++row) recording.time_s.push_back(0.01 * static_cast<double>(row));
  recording.signals = {{"command_0", command}, {"length_0_mm", length}};
  return recording;
}

TEST(DataChecks, ACommandMovesIfItChangesByMoreThanTwoPercent) {
  const Recording still = recordingOf("a.csv", {0.4, 0.41, 0.42}, {1, 2, 3}), moving = recordingOf("b.csv", {0.4, 0.4, 0.43}, {1, 2, 3});
  EXPECT_FALSE(commandsMove({still}));
  EXPECT_TRUE(commandsMove({still, moving}));
  EXPECT_EQ(firstChange(still), 0) << "there is none";
  EXPECT_EQ(firstChange(moving), 2);
}

TEST(DataChecks, ASignalNeverChangesIfAllItsNumbersAreEqual) {
  const Recording held = recordingOf("a.csv", {0, 1, 0}, {5, nan, 5}), other = recordingOf("b.csv", {0, 1, 0}, {6, 6, 6});
  EXPECT_TRUE(neverChanges({held}, "length_0_mm"));
  EXPECT_FALSE(neverChanges({held, other}, "length_0_mm")) << "it differs between the recordings";
  EXPECT_FALSE(neverChanges({held}, "command_0"));
}

TEST(DataChecks, NamesDropoutsAndRowsWithoutANumber) {
  Recording recording = recordingOf("a.csv", {0, 1, 0, 1}, {1, nan, nan, 4});
  EXPECT_EQ(dataNotes({recording}), std::vector<std::string>{"a.csv: 2 of 4 rows have no number for length_0_mm; they are left out"});
  recording.signals[1].values = {1, 2, 3, 4};
  recording.time_s = {0, 0.01, 0.02, 0.5};
  EXPECT_EQ(dataNotes({recording}),
            std::vector<std::string>{"a.csv: no rows between 0.020 and 0.500 s; the simulation runs through with the command held, and "
                                     "since it is another one after that, the readings of the next 1 s are left out"});
  recording.time_s = {0, 0.9, 0.91, 0.92};
  recording.signals[1].values[0] = nan;
  ASSERT_EQ(dropoutsOf(recording).size(), 1U);
  EXPECT_FALSE(dropoutsOf(recording)[0].changes_commands) << "the machine rested before the first row";
  recording.signals[1].values[0] = 1;
  EXPECT_TRUE(dropoutsOf(recording)[0].changes_commands);
  recording.time_s = {0, 0.01, 0.02, 0.5};
  recording.signals[0].values.back() = 0;
  EXPECT_EQ(dataNotes({recording}),
            std::vector<std::string>{"a.csv: no rows between 0.020 and 0.500 s; the simulation runs through with the command held"});
}

TEST(DataChecks, ARepeatHasTheSameCommandsOrIsCalledSo) {
  const Recording first = recordingOf("day/a.csv", {0, 1}, {1, 2}), same = recordingOf("b.csv", {0, 1}, {3, 4});
  Recording other = recordingOf("c.csv", {1, 0}, {5, 6});
  EXPECT_TRUE(sameCommands(first, same) && isRepeat(first, same));
  EXPECT_FALSE(sameCommands(first, other) || isRepeat(first, other));
  other.info.repeat_of = "a";
  EXPECT_TRUE(isRepeat(first, other) && isRepeat(other, first));
  EXPECT_FALSE(sameCommands(first, other));
}

TEST(DataChecks, RefusesACopyOfARecording) {
  const Recording first = recordingOf("a.csv", {0, 1}, {1, nan}), repeat = recordingOf("b.csv", {0, 1}, {1.1, nan});
  EXPECT_NO_THROW(requireDifferentMeasurements({first, repeat}));
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { requireDifferentMeasurements({first, repeat, first}); }), "a.csv"));
}

TEST(DataChecks, MedianIgnoresSignsAndMissingNumbers) {
  EXPECT_EQ(medianSize({-3, nan, 1, 2}), 2);
  EXPECT_EQ(medianSize({nan}), 0);
}

}  // namespace
}  // namespace musclesim
