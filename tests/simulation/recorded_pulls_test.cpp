#include "simulation/recorded_pulls.h"

#include <gtest/gtest.h>

#include "musclesim/musclesim.h"

namespace musclesim {
namespace {

RecordingInfo infoWith(const std::string& pulls) {
  RecordingInfo info;
  info.extra_json = R"({"pulls": )" + pulls + "}";
  return info;
}

/// 0.1 + 0.2 and its like must come back to the bit.
InputHistory someHistory() {
  Hands hands(1);
  const Pull first{4, {0.1 + 0.2, 1.0 / 3, 0}, {-200, 30, 1e-17}}, second{4, first.point_mm, {-100, 0, 0}};
  for (long step = 0; step < 8; ++step) {
    if (step == 2) hands.pull(first);
    if (step == 3) hands.set(0, 0.5);
    if (step == 4) hands.pull(second);
    if (step == 6) hands.pull(std::nullopt);
    hands.sample(0.01 * static_cast<double>(step));
  }
  return hands.history();
}

TEST(RecordedPulls, ComeBackToTheBit) {
  const std::vector<TimedPull> pulls = pullsOf(someHistory(), 0.01);
  ASSERT_EQ(pulls.size(), 3u) << "the change of a pressure is none";
  EXPECT_DOUBLE_EQ(pulls[0].time_s, 0.02);
  EXPECT_FALSE(pulls[2].pull);
  const std::vector<TimedPull> read = recordedPulls(infoWith(toJson(pulls)), "a.json");
  ASSERT_EQ(read.size(), pulls.size());
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    EXPECT_EQ(read[i].time_s, pulls[i].time_s);
    EXPECT_EQ(read[i].pull, pulls[i].pull);
  }
}

TEST(RecordedPulls, RecordingsWithoutThemHaveNone) {
  EXPECT_TRUE(recordedPulls(RecordingInfo{}, "a.json").empty());
  EXPECT_THROW(recordedPulls(infoWith(R"([{"part": 3}])"), "a.json"), BadFile);
  EXPECT_THROW(recordedPulls(infoWith(R"([{"time_s": 1, "part": 3, "point_mm": [0, 1], "towards_mm": [0, 0, 0]}])"), "a.json"), BadFile);
}

/// The angle of an elbow that is pulled at its forearm for a while, or not at all.
Recording pulledElbow(const std::vector<TimedPull>& pulls) {
  Simulation simulation;
  Robot& robot = simulation.build("elbow");
  const Action action(2, 0.2);
  simulation.start("settled", action);
  Recording recording;
  recording.info = describeModel(simulation, "settled");
  recording.info.extra_json = R"({"pulls": )" + toJson(pulls) + "}";
  for (const std::string& name : robot.signalNames()) recording.signals.push_back({name, {}});
  std::size_t next = 0;
  for (long step = 0; step <= 40; ++step) {
    if (next < pulls.size() && simulation.time_s() >= pulls[next].time_s - 1e-9) simulation.pull(pulls[next++].pull);
    robot.step(action);
    recording.time_s.push_back(simulation.time_s());
    const std::vector<double> values = robot.signalValues(robot.getState());
    for (std::size_t i = 0; i < values.size(); ++i) recording.signals[i].values.push_back(values[i]);
    simulation.step();
  }
  return recording;
}

TEST(RecordedPulls, AreRepeatedByAReplay) {
  const std::vector<TimedPull> pulls = {{0.1, Pull{0, {0, 0, 0}, {200, -100, 0}}}, {0.3, std::nullopt}};
  const Recording recording = pulledElbow(pulls), still = pulledElbow({});
  const auto& angle = recording.find("angle_elbow_deg")->values;
  EXPECT_GT(std::abs(angle.back() - still.find("angle_elbow_deg")->values.back()), 1) << "the pull moves it";
  const ReplayResult replayed = replayRecording(recording);
  for (const SignalError& error : replayed.errors) EXPECT_EQ(error.largest, 0) << error.name;
  Recording forgetful = recording;
  forgetful.info.extra_json = "{}";
  EXPECT_NE(replayRecording(forgetful).simulated.find("angle_elbow_deg")->values[30], angle[30]);
}

}  // namespace
}  // namespace musclesim
