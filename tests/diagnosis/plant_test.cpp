// Preparation of recordings: segments for screening, dead sensors, effects that the model already has.
#include "diagnosis/plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "planted.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// A rig's command rests and then changes in steps; its length follows at once.
Recording stepped(double step_s, double rest_s, double duration_s, const std::string& file) {
  Recording recording;
  recording.file = file;
  recording.info.robot = "rig";
  recording.info.noise_std = {{"length_0_mm", planted::noise_mm}};
  recording.signals = {{"command_0", {}}, {"length_0_mm", {}}};
  const auto row_count = static_cast<int>(std::lround(duration_s / step_s));
  for (int row = 0; row < row_count; ++row) {
    const double t = step_s * row;
    const bool high = t >= rest_s && std::fmod(t - rest_s, file == "a.csv" ? 1.0 : 1.4) < 0.5;
    recording.time_s.push_back(t);
    recording.signals[0].values.push_back(high ? 0.6 : 0.4);
    recording.signals[1].values.push_back(high ? 220 : 240);
  }
  return recording;
}

std::vector<Segment> segmentsOf(double step_s, double rest_s, double duration_s) {
  const DiagnosisOptions options;
  std::vector<Recording> recordings;
  for (const char* file : {"a.csv", "b.csv", "c.csv"}) recordings.push_back(stepped(step_s, rest_s, duration_s, file));
  recordings.back().signals[1].values.front() += 1;  // no recording is another one again
  return Plant(std::move(recordings), options).screeningSegments();
}

TEST(ScreeningSegments, LastAFewSecondsFromTheFirstChangeOfACommand) {
  for (const Segment& segment : segmentsOf(0.01, 0, 20)) EXPECT_EQ(segment.end_row, 650);
  const std::vector<Segment> late = segmentsOf(0.01, 5, 20);
  ASSERT_EQ(late.size(), 2u);
  for (const Segment& segment : late) EXPECT_EQ(segment.end_row, 1100);
}

TEST(ScreeningSegments, ComparesOnlySomeOfManyRows) {
  for (const Segment& segment : segmentsOf(0.001, 0.5, 10)) {
    EXPECT_EQ(segment.end_row, 6500);
    EXPECT_EQ(segment.every, 10);
  }
  for (const Segment& segment : segmentsOf(0.05, 0, 60)) {
    EXPECT_EQ(segment.end_row, 610) << "of few rows as many, whatever time they take";
    EXPECT_EQ(segment.every, 1);
  }
}

TEST(DeadSensor, InOneRecordingIsLeftOutThere) {
  const DiagnosisOptions options;
  std::vector<Recording> recordings = {stepped(0.01, 0, 3, "a.csv"), stepped(0.01, 0, 3, "b.csv"), stepped(0.02, 0, 3, "c.csv")};
  for (double& value : recordings[1].signals[1].values) value = 240;
  const Plant plant(recordings, options);
  ASSERT_EQ(plant.signals().size(), 1u);
  EXPECT_TRUE(std::isfinite(plant.measured(0, 0).front()));
  EXPECT_TRUE(std::isnan(plant.measured(1, 0).front()));
  ASSERT_FALSE(plant.notes().empty());
  EXPECT_TRUE(contains(plant.notes().front(), "b.csv: length_0_mm has the same value in every row"));
}

TEST(Plant, KnowsTheStagesOfWhatTheModelHoldsBeforehand) {
  std::vector<Recording> recordings = planted::plant({});
  DiagnosisOptions options;
  options.model.effects = {{"force_gain", "muscle_0", {{"gain", 0.9}}}};
  EXPECT_TRUE(Plant(recordings, options).holds(Stage::force));
  EXPECT_FALSE(Plant(recordings, options).holds(Stage::pressure));
  recordings.back().info.active_effects = {{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.1}}}};
  EXPECT_TRUE(Plant(recordings, options).holds(Stage::pressure));
}

}  // namespace
}  // namespace musclesim
