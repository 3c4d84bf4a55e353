// Proposed schedules.
#include "diagnosis/next_experiment.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "musclesim/error.h"
#include "planted.h"
#include "support/support.h"

namespace musclesim {
namespace {

TEST(NextExperiment, StaysWithinTheCommandsOfTheRecordings) {
  const std::vector<Recording> recordings = planted::plant({});
  for (const char* name :
       {"slow reversals", "three speeds", "steps of two sizes", "co-contraction", "vent and hold", "one muscle at a time"}) {
    const Recording whole = experimentSchedule(name, 1, recordings), half = experimentSchedule(name, 0.5, recordings);
    const auto [low, high] = std::ranges::minmax(whole.find("command_0")->values);
    EXPECT_GE(low, 0.25 - 1e-9) << name;
    EXPECT_LE(high, 0.65 + 1e-9) << name;
    EXPECT_GT(high - low, 0.15) << name;
    const auto [low_half, high_half] = std::ranges::minmax(half.find("command_0")->values);
    EXPECT_NEAR(high_half - low_half, (high - low) / 2, 1e-9) << name;
  }
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { experimentSchedule("nonsense", 1, recordings); }), "nonsense"));
}

/// Two effects whose predictions differ by speed: the bank's best tells them apart by more than the noise, and stays where the rig was.
TEST(NextExperiment, TellsALagFromAWeakerMuscle) {
  DiagnosisOptions options;
  const Plant plant(planted::plant({}), options);
  const ActiveEffect lag{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.1}}},
      weaker{"force_gain", "muscle_0", {{"gain", 0.98}}};
  const Experiment experiment = nextExperiment(plant, {"lag", "weaker"}, {{{lag}, {}}, {{weaker}, {}}}, Fidelity::coarse, 2, [] {});
  EXPECT_GT(experiment.difference, 3);
  EXPECT_EQ(experiment.separates, (std::vector<std::string>{"lag", "weaker"}));
  const Recording schedule = experimentSchedule(experiment.schedule, experiment.amplitude, plant.recordings());
  ASSERT_EQ(schedule.time_s.size(), experiment.commands.size());
  for (std::size_t row = 0; row < experiment.commands.size(); ++row)
    EXPECT_EQ(experiment.commands[row][0], schedule.find("command_0")->values[row]);
  EXPECT_TRUE(nextExperiment(plant, {"lag"}, {{{lag}, {}}}, Fidelity::coarse, 1, [] {}).commands.empty());
}

}  // namespace
}  // namespace musclesim
