// Proposed schedules.
#include "diagnosis/planning/next_experiment.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "../planted.h"
#include "diagnosis/planning/schedule.h"
#include "musclesim/base/error.h"
#include "musclesim/diagnosis/proposed_recording.h"
#include "musclesim/simulation/replay.h"
#include "support/support.h"

namespace musclesim {
namespace {

std::pair<double, double> rangeOf(const Recording& recording, const std::string& signal) {
  const auto [low, high] = std::ranges::minmax(recording.find(signal)->values);
  return {low, high};
}

/// Commands of the planted recordings are within 0.25 .. 0.65.
TEST(Schedule, KeepsToTheCommandsOfTheRecordingsUnlessAnotherLevelIsAskedFor) {
  const std::vector<Recording> recordings = planted::plant({});
  for (const ScheduleChoice& choice : scheduleBank()) {
    const auto [low, high] = rangeOf(scheduled(choice, recordings), "command_0");
    EXPECT_GE(low, 0.25 + 0.4 * choice.level - 1e-9) << choice.name;
    EXPECT_LE(high, 0.65 + 0.4 * choice.level + 1e-9) << choice.name;
    EXPECT_GT(high - low, 0.15) << choice.name;
    const auto [low_half, high_half] = rangeOf(scheduled({choice.name, 0.5, choice.level}, recordings), "command_0");
    EXPECT_NEAR(high_half - low_half, (high - low) / 2, 1e-9) << choice.name;
  }
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { scheduled({"nonsense", 1, 0}, recordings); }), "nonsense"));
}

TEST(Schedule, KeepsCommandsWithinWhatACommandCanBe) {
  const std::vector<Recording> recordings = planted::plant({});
  const auto [low, high] = rangeOf(scheduled({"slow reversals", 1, 2}, recordings), "command_0");
  EXPECT_EQ(high, 1);
  EXPECT_GT(low, 0.9);
}

TEST(Schedule, SaysAtWhichPressures) {
  std::set<std::string> words;
  for (const ScheduleChoice& choice : scheduleBank()) words.insert(scheduleWords(choice));
  EXPECT_EQ(words.size(), scheduleBank().size());
  EXPECT_TRUE(contains(scheduleWords({"co-contraction", 1, -0.5}), "lower pressures"));
}

ActiveEffect lag() {
  return {"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.1}}};
}
ActiveEffect weaker(double gain) {
  return {"force_gain", "muscle_0", {{"gain", gain}}};
}

/// Two effects whose predictions differ by speed: the best schedule of the bank separates them by more than the noise.
TEST(NextExperiment, TellsALagFromAWeakerMuscle) {
  DiagnosisOptions options;
  const Plant plant(planted::plant({}), options);
  const std::vector<Rival> rivals = {{"lag", {{lag()}, {}}, 0.6}, {"weaker", {{weaker(0.98)}, {}}, 0.4}};
  const Experiment experiment = nextExperiment(plant, rivals, Fidelity::coarse, 2, [] {});
  EXPECT_GT(experiment.difference, 3);
  EXPECT_EQ(experiment.separates, (std::vector<std::string>{"lag", "weaker"}));
  const Recording schedule = scheduled({experiment.schedule, experiment.amplitude, experiment.level}, plant.recordings());
  ASSERT_EQ(schedule.time_s.size(), experiment.commands.size());
  for (std::size_t row = 0; row < experiment.commands.size(); ++row)
    EXPECT_EQ(experiment.commands[row][0], schedule.find("command_0")->values[row]);
  EXPECT_TRUE(nextExperiment(plant, {rivals.front()}, Fidelity::coarse, 1, [] {}).commands.empty());
}

/// The planted muscle is never longer than 280 mm nor shorter than 150 (tests/diagnosis/planted.h leaves the rig as it is).
TEST(NextExperiment, KeepsAboutWhereThePlantHasBeenWhateverTheContender) {
  DiagnosisOptions options;
  const Plant plant(planted::plant({}), options);
  double low = 1e9, high = -1e9;
  for (const Recording& recording : plant.recordings())
    for (const double length_mm : recording.find("length_0_mm")->values) low = std::min(low, length_mm), high = std::max(high, length_mm);
  const std::vector<Rival> rivals = {{"lag", {{lag()}, {}}, 0.9}, {"stronger", {{weaker(1.3)}, {}}, 0.1}};
  const Experiment experiment = nextExperiment(plant, rivals, Fidelity::coarse, 2, [] {});
  ASSERT_FALSE(experiment.commands.empty());
  const Recording schedule = scheduled({experiment.schedule, experiment.amplitude, experiment.level}, plant.recordings());
  for (const Rival& rival : rivals) {
    const auto predicted = plant.predictSchedule(schedule, rival.model, Fidelity::coarse);
    ASSERT_TRUE(predicted);
    const auto [shortest, longest] = rangeOf(*predicted, "length_0_mm");
    EXPECT_GT(shortest, low - 0.3 * (high - low)) << rival.label;
    EXPECT_LT(longest, high + 0.3 * (high - low)) << rival.label;
  }
}

/// An elbow whose first muscle is so much fuller that the joint never leaves its stop at 70 degrees: pressures distinguish the rivals there
/// too.
TEST(NextExperiment, LetsThePlantRestOnAStopWhereItHasDoneSo) {
  std::vector<Recording> recordings;
  for (const double size : {0.06, 0.09}) {
    Recording plan;
    plan.file = fmt::format("pressed_{}.csv", recordings.size());
    plan.info.robot = "elbow";
    plan.info.initial_state = "settled";
    plan.signals = {{"command_0", {}}, {"command_1", {}}};
    for (int row = 0; row < 300; ++row) {
      const double turn = size * (row % 100 < 50 ? 1 : -1);
      plan.time_s.push_back(0.01 * row);
      plan.signals[0].values.push_back(0.85 + turn);
      plan.signals[1].values.push_back(0.15 - turn);
    }
    Recording measured = replayRecording(plan).simulated;
    measured.file = plan.file;
    measured.info.noise_std = {{"angle_elbow_deg", 0.05}, {"pressure_0", 0.003}};
    std::erase_if(measured.signals,
                  [](const Signal& s) { return !s.name.starts_with("command_") && s.name != "angle_elbow_deg" && s.name != "pressure_0"; });
    recordings.push_back(std::move(measured));
  }
  EXPECT_GT(rangeOf(recordings.back(), "angle_elbow_deg").first, 69);
  DiagnosisOptions options;
  const Plant plant(recordings, options);
  const std::vector<Rival> rivals = {{"lag", {{lag()}, {}}, 0.6}, {"weaker", {{weaker(0.98)}, {}}, 0.4}};
  const Experiment experiment = nextExperiment(plant, rivals, Fidelity::coarse, 2, [] {});
  ASSERT_FALSE(experiment.commands.empty());
  EXPECT_TRUE(contains(experiment.why, "pressure")) << experiment.why;
  const Recording schedule = scheduled({experiment.schedule, experiment.amplitude, experiment.level}, plant.recordings());
  for (const Rival& rival : rivals) {
    const auto predicted = plant.predictSchedule(schedule, rival.model, Fidelity::coarse);
    ASSERT_TRUE(predicted);
    EXPECT_LT(rangeOf(*predicted, "angle_elbow_deg").second, 70 + 0.02 * 140) << rival.label;
  }
}

/// A difference that refitting a rival removes does not count, unless its own recordings fix its parameters.
TEST(NextExperiment, CountsWhatIsLeftWhenContendersAreFittedAnew) {
  DiagnosisOptions options;
  const Plant plant(planted::plant({}), options);
  auto differenceOf = [&](double held) {
    std::vector<Rival> rivals;
    for (const double gain : {0.97, 0.98})
      rivals.push_back({"gain", {{weaker(gain)}, {}}, 0.5, {{{weaker(gain + 0.01)}, {}}}, Eigen::MatrixXd::Constant(1, 1, held)});
    return nextExperiment(plant, rivals, Fidelity::coarse, 2, [] {}).difference;
  };
  const double held = differenceOf(1e6), free = differenceOf(0);
  EXPECT_GT(held, 3);
  EXPECT_LT(free, 0.1 * held);
}

/// A schedule that separates one rival from the most probable one does not separate that one from its twin.
TEST(NextExperiment, SaysWhatItSeparatesAndWhatNot) {
  DiagnosisOptions options;
  const Plant plant(planted::plant({}), options);
  const Experiment experiment =
      nextExperiment(plant, {{"lag", {{lag()}, {}}, 0.45}, {"twin", {{lag()}, {}}, 0.45}, {"weaker", {{weaker(0.97)}, {}}, 0.05}},
                     Fidelity::coarse, 2, [] {});
  EXPECT_EQ(experiment.separates, (std::vector<std::string>{"lag", "weaker"}));
  EXPECT_GT(experiment.difference, 3);
  EXPECT_TRUE(contains(experiment.why, "the two of these that are most alike")) << experiment.why;
}

/// The worth of an experiment does not depend on the sum of the probabilities.
TEST(NextExperiment, DoesNotAskHowLikelyContendersAreInAll) {
  DiagnosisOptions options;
  const Plant plant(planted::plant({}), options);
  const std::vector<Rival> rivals = {{"lag", {{lag()}, {}}, 6e-4}, {"weaker", {{weaker(0.98)}, {}}, 4e-4}};
  EXPECT_FALSE(nextExperiment(plant, rivals, Fidelity::coarse, 2, [] {}).commands.empty());
}

/// A rival that no schedule separates from the most probable one does not justify an experiment.
TEST(NextExperiment, ProposesNothingWhereAllPredictTheSame) {
  DiagnosisOptions options;
  const Plant plant(planted::plant({}), options);
  const Model same{{lag()}, {}};
  EXPECT_TRUE(nextExperiment(plant, {{"lag", same, 0.5}, {"twin", same, 0.5}}, Fidelity::coarse, 2, [] {}).commands.empty());
  const Model nearly{{weaker(0.98)}, {}}, as_good_as{{weaker(0.980001)}, {}};
  EXPECT_TRUE(nextExperiment(plant, {{"a", nearly, 0.5}, {"b", as_good_as, 0.5}}, Fidelity::coarse, 2, [] {}).commands.empty());
}

TEST(ProposedRecording, NamesTheRobotFileFromWhereItsSidecarWillLie) {
  Diagnosis diagnosis;
  diagnosis.next_experiment.time_s = {0};
  diagnosis.next_experiment.commands = {{0.4}};
  RecordingInfo model;
  model.robot = "robots/leg.toml";
  EXPECT_TRUE(contains(proposedRecording(diagnosis, model, "answers/first/next.json").json, "\"../../robots/leg.toml\""));
  EXPECT_TRUE(contains(proposedRecording(diagnosis, model).json, "\"robots/leg.toml\""));
}

}  // namespace
}  // namespace musclesim
