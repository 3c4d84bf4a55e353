// Plants with several planted effects, and with one that a second might mend.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "../planted.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "support/out_of_catalogue_laws.h"
#include "support/support.h"

namespace musclesim {
namespace {

using planted::few;
using planted::measuredUnder;
using planted::plant;
using planted::withExactModel;

TEST(DiagnoseSeveral, FindsThreeEffectsOneBesideTheOther) {
  DiagnosisOptions options = few({"payload", "transport_delay", "sensor_gain", "force_drift"});
  options.max_effects = 3;
  const Diagnosis found = diagnose(withExactModel(plant({{"payload", "hand", {{"mass_kg", 0.3}}},
                                                         {"transport_delay", "all", {{"delay_s", 0.06}}},
                                                         {"sensor_gain", "signal_length_0", {{"gain", 1.1}}}})),
                                   options);
  std::vector<std::string> told = found.chosen.empty() ? found.attempt.effects : found.chosen;
  std::ranges::sort(told);
  EXPECT_EQ(told, (std::vector<std::string>{"payload@hand", "sensor_gain@signal_length_0", "transport_delay@muscle_0"}))
      << diagnosisSummary(found);
}

TEST(DiagnoseSeveral, FindsASecondCauseOfItsOwn) {
  const auto recordings =
      withExactModel(plant({{"payload", "hand", {{"mass_kg", 0.12}}}, {"transport_delay", "muscle_0", {{"delay_s", 0.06}}}}));
  Diagnosis found = diagnose(recordings, few({"payload", "transport_delay", "force_gain", "viscous_loss"}));
  std::ranges::sort(found.chosen);
  EXPECT_EQ(found.chosen, (std::vector<std::string>{"payload@hand", "transport_delay@muscle_0"})) << diagnosisSummary(found);
  EXPECT_TRUE(found.alternatives.empty()) << "a pair is not its own alternative";
  EXPECT_TRUE(found.next_experiment.commands.empty());
  EXPECT_TRUE(contains(diagnosisReport(found), "--robot rig"));
}

TEST(DiagnoseSeveral, TakesNoSecondCauseThatOnlyMendsTheLawOfTheFirst) {
  const auto recordings = plant({{"foreign.growing_lag", "muscle_0", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.1}}}});
  const Diagnosis found = diagnose(recordings, few({"valve_lag", "transport_delay", "sensor_delay", "viscous_loss"}));
  EXPECT_EQ(found.chosen, std::vector<std::string>{"valve_lag@muscle_0"}) << diagnosisSummary(found);
}

/// Recordings of a plant with pressures whose load something that no effect knows moves by much more than the noise.
std::vector<Recording> withUnknownMotion(const std::vector<ActiveEffect>& effects) {
  std::vector<Recording> recordings = plant(effects, planted::Pressure::measured);
  for (Recording& recording : recordings)
    for (Signal& signal : recording.signals)
      if (signal.name == "length_0_mm")
        for (std::size_t row = 0; row < recording.time_s.size(); ++row)
          signal.values[row] += 20 * std::sin(11 * recording.time_s[row]) * std::sin(0.9 * recording.time_s[row] * recording.time_s[row]);
  return recordings;
}

TEST(DiagnoseSeveral, NamesNothingForAnUnknownMotion) {
  const Diagnosis found = diagnose(withUnknownMotion({}), few({"transport_delay", "valve_lag", "payload", "sensor_gain"}));
  EXPECT_EQ(found.verdict, Verdict::unexplained) << diagnosisSummary(found);
  EXPECT_TRUE(found.chosen.empty());
  for (const FoundEffect& effect : found.effects) EXPECT_LT(effect.probability, 0.5) << effect.label();
}

/// The pressures are those of a dead time.
TEST(DiagnoseSeveral, NamesWhatExplainsThePressuresBesideAnUnknownMotion) {
  const std::vector<Recording> recordings = withUnknownMotion({{"transport_delay", "muscle_0", {{"delay_s", 0.06}}}});
  const Diagnosis found = diagnose(recordings, few({"transport_delay", "valve_lag", "payload", "sensor_gain"}));
  EXPECT_EQ(found.verdict, Verdict::effects_found) << diagnosisSummary(found);
  EXPECT_EQ(found.chosen, std::vector<std::string>{"transport_delay@muscle_0"}) << diagnosisSummary(found);
  EXPECT_GT(found.remainder.probability, 0.5);
  EXPECT_TRUE(found.remainder.is_significant);
  EXPECT_TRUE(contains(diagnosisReport(found), "<strong>Explained in part</strong>"));
}

/// Three recordings of a rig with a line muscle under random steps of command, which hide a dead time behind the steep edges of a lag.
/// `unlike_the_model`: numbers of the machine that its sidecar does not tell.
std::vector<Recording> underRandomSteps(const std::vector<ActiveEffect>& effects,
                                        const std::map<std::string, double>& unlike_the_model = {}, int row_count = 400) {
  std::vector<Recording> recordings;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Recording plan;
    plan.file = fmt::format("steps_{}.csv", seed);
    plan.info.robot = "rig";
    plan.info.robot_parameters["muscle.model"] = std::string("line");
    plan.signals = {{"command_0", {}}};
    RandomStream random(seed, "steps");
    double command = 0.45;
    for (int row = 0; row < row_count; ++row) {
      if (row % 40 == 0) command = random.uniform(0.1, 0.9);
      plan.time_s.push_back(0.01 * row);
      plan.signals[0].values.push_back(command);
    }
    const RecordingInfo told = plan.info;
    for (const auto& [name, value] : unlike_the_model) plan.info.robot_parameters[name] = value;
    recordings.push_back(measuredUnder(effects, plan, seed, planted::Pressure::measured));
    recordings.back().info.robot_parameters = told.robot_parameters;
  }
  return recordings;
}

TEST(DiagnoseSeveral, IntervalsOfDeadTimeAndLagHoldTheTruth) {
  const std::map<std::string, double> truth = {{"delay_s", 0.025}, {"fill_time_constant_s", 0.04}, {"vent_time_constant_s", 0.07}};
  const auto recordings = underRandomSteps(
      {{"transport_delay", "muscle_0", {{"delay_s", truth.at("delay_s")}}},
       {"valve_lag",
        "muscle_0",
        {{"fill_time_constant_s", truth.at("fill_time_constant_s")}, {"vent_time_constant_s", truth.at("vent_time_constant_s")}}}});
  const Diagnosis found = diagnose(recordings, few({"valve_lag", "transport_delay", "sensor_delay"}));
  ASSERT_EQ(std::set<std::string>(found.chosen.begin(), found.chosen.end()),
            (std::set<std::string>{"transport_delay@muscle_0", "valve_lag@muscle_0"}))
      << diagnosisSummary(found);
  for (const FoundEffect& effect : found.effects)
    for (const auto& [name, value] : truth)
      if (const auto estimate = effect.parameters.find(name); effect.probability > 0.5 && estimate != effect.parameters.end()) {
        EXPECT_TRUE(estimate->second.is_determined) << name;
        EXPECT_LT(estimate->second.low, value) << name;
        EXPECT_GT(estimate->second.high, value) << name;
        EXPECT_LT(estimate->second.high - estimate->second.low, 0.1 * value) << name;
      }
}

/// A second lag is nearly a dead time: the law of one lag alone would be sure of a dead time that is too long.
TEST(DiagnoseSeveral, TheIntervalOfADeadTimeHoldsTheTruthBesideAValveOfTwoLags) {
  const std::map<std::string, double> truth = {{"delay_s", 0.037}, {"fill_time_constant_s", 0.06}, {"vent_time_constant_s", 0.067}};
  std::map<std::string, Parameter::Value> lag = {{"next_lag_ratio", 0.25}};
  for (const char* name : {"fill_time_constant_s", "vent_time_constant_s"}) lag[name] = truth.at(name);
  const Diagnosis found =
      diagnose(underRandomSteps({{"transport_delay", "muscle_0", {{"delay_s", truth.at("delay_s")}}}, {"valve_lag", "muscle_0", lag}}),
               few({"valve_lag", "transport_delay"}));
  ASSERT_EQ(std::set<std::string>(found.chosen.begin(), found.chosen.end()),
            (std::set<std::string>{"transport_delay@muscle_0", "valve_lag@muscle_0"}))
      << diagnosisSummary(found);
  for (const FoundEffect& effect : found.effects)
    for (const auto& [name, estimate] : effect.parameters)
      if (const auto value = truth.find(name); effect.probability > 0.5 && value != truth.end()) {
        EXPECT_LT(estimate.low, value->second) << diagnosisSummary(found);
        EXPECT_GT(estimate.high, value->second) << diagnosisSummary(found);
      }
}

/// Six muscles make more hypotheses than are screened. Where both muscles of a joint creep, either alone explains little.
TEST(DiagnoseSeveral, FindsOneEffectOnBothMusclesOfAJoint) {
  std::vector<Recording> recordings;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Recording plan;
    plan.file = fmt::format("arm_{}.csv", seed);
    plan.info.robot = "pulley_arm";
    for (int m = 0; m < 6; ++m) plan.signals.push_back({fmt::format("command_{}", m), {}});
    RandomStream random(seed, "levels");
    std::vector<double> levels(6);
    for (int row = 0; row < 600; ++row) {
      if (row % 50 == 0)
        for (double& level : levels) level = random.uniform(0.1, 0.5);
      plan.time_s.push_back(0.01 * row);
      for (std::size_t m = 0; m < 6; ++m) plan.signals[m].values.push_back(levels[m]);
    }
    ReplayOptions options;
    options.effects = {{"valve_lag", "all", {{"fill_time_constant_s", 0.04}, {"vent_time_constant_s", 0.04}}}};
    for (const char* muscle : {"muscle_0", "muscle_1"})
      options.effects.push_back({"creep", muscle, {{"amount", 0.12}, {"time_constant_s", 1.5}}});
    Recording recording = replayRecording(plan, options).simulated;
    recording.file = plan.file;
    recording.info.active_effects.clear();
    RandomStream noise(seed, "noise");
    std::erase_if(recording.signals, [](const Signal& s) {
      return !(s.name.starts_with("command_") || s.name.starts_with("pressure_") || s.name.starts_with("angle_"));
    });
    for (Signal& signal : recording.signals) {
      if (signal.name.starts_with("command_")) continue;
      const double deviation = signal.name.starts_with("angle_") ? 0.05 : 0.002;
      recording.info.noise_std[signal.name] = deviation;
      for (double& value : signal.values) value += deviation * noise.normal();
    }
    recordings.push_back(std::move(recording));
  }
  const Diagnosis found = diagnose(recordings, few({"valve_lag", "creep", "length_offset", "attachment_offset", "force_gain"}));
  EXPECT_EQ(std::set<std::string>(found.chosen.begin(), found.chosen.end()),
            (std::set<std::string>{"creep@muscle_0", "creep@muscle_1", "valve_lag@all"}))
      << diagnosisSummary(found);
}

/// A load 4 % too heavy, half as much friction again, and a force law 3 % too strong, none of which is tuned.
TEST(DiagnoseSeveral, NumbersThatNobodyMeasuredHideNoCause) {
  const std::map<std::string, double> off = {{"rig.load_kg", 2.08}, {"muscle.slider_friction_N", 1.5}, {"force_law.c_kgf", 1.03 * 9.7996}};
  const std::vector<std::vector<ActiveEffect>> plants = {
      {{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.06}, {"vent_time_constant_s", 0.09}}}},
      {{"transport_delay", "muscle_0", {{"delay_s", 0.05}}},
       {"braid_hysteresis", "muscle_0", {{"relative_width", 0.1}, {"presliding_mm", 1.0}}}}};
  for (const std::vector<ActiveEffect>& effects : plants) {
    const Diagnosis found = diagnose(underRandomSteps(effects, off), {});
    EXPECT_EQ(found.chosen.size(), effects.size()) << diagnosisSummary(found);
    for (const ActiveEffect& effect : effects) {
      const auto named = std::ranges::find(found.effects, effect.id, &FoundEffect::id);
      ASSERT_NE(named, found.effects.end()) << diagnosisSummary(found);
      EXPECT_GE(named->probability, 0.8) << diagnosisSummary(found);
    }
  }
}

/// Recordings of a logger that was switched on in the middle of a motion, 50 ms after a step.
TEST(DiagnoseSeveral, LeavesOutWhatTheMotionBeforeARecordingExplains) {
  const std::vector<ActiveEffect> effects = {{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.06}, {"vent_time_constant_s", 0.09}}},
                                             {"braid_hysteresis", "muscle_0", {{"relative_width", 0.1}, {"presliding_mm", 1.0}}}};
  std::vector<Recording> recordings = underRandomSteps(effects, {}, 600);
  constexpr std::ptrdiff_t before = 125;
  for (Recording& recording : recordings) {
    recording.info.initial_state.reset();
    recording.info.extra_json = "{}";
    recording.time_s.erase(recording.time_s.end() - before, recording.time_s.end());
    for (Signal& signal : recording.signals) signal.values.erase(signal.values.begin(), signal.values.begin() + before);
  }
  DiagnosisOptions options = few({"valve_lag", "braid_hysteresis", "transport_delay", "contact", "slide_friction"});
  const Diagnosis found = diagnose(recordings, options);
  EXPECT_TRUE(contains(found.unknown_start, "in another state than the model")) << diagnosisSummary(found);
  EXPECT_TRUE(contains(diagnosisSummary(found), found.unknown_start) && contains(diagnosisReport(found), found.unknown_start));
  EXPECT_LT(found.none_of_these, 0.1) << diagnosisSummary(found);
  for (const ActiveEffect& effect : effects) {
    const auto named = std::ranges::find(found.effects, effect.id, &FoundEffect::id);
    ASSERT_NE(named, found.effects.end()) << diagnosisSummary(found);
    EXPECT_GT(named->probability, 0.8) << diagnosisSummary(found);
  }
  options.skip_start_s = 0;
  const Diagnosis with_all = diagnose(recordings, options);
  EXPECT_EQ(with_all.unknown_start, "");
  EXPECT_GT(with_all.none_of_these, 2 * found.none_of_these) << "readings that no effect explains";
}

/// One of three recordings was made with another load, of which its sidecar says nothing.
TEST(DiagnoseSeveral, TellsWhichRecordingContradictsTheOthers) {
  const std::vector<ActiveEffect> lag = {{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.06}, {"vent_time_constant_s", 0.09}}}};
  std::vector<Recording> recordings = underRandomSteps(lag);
  const Diagnosis alike = diagnose(recordings, few({"valve_lag", "transport_delay"}));
  EXPECT_TRUE(alike.odd_recordings.empty()) << diagnosisSummary(alike);
  recordings[0] = underRandomSteps(lag, {{"rig.load_kg", 2.6}})[0];
  const Diagnosis found = diagnose(recordings, few({"valve_lag", "transport_delay"}));
  ASSERT_EQ(found.odd_recordings.size(), 1U) << diagnosisSummary(found);
  EXPECT_TRUE(found.odd_recordings.front().starts_with("steps_1.csv contradicts the other recordings: length_0_mm is left off by "))
      << found.odd_recordings.front();
  EXPECT_TRUE(contains(diagnosisReport(found), found.odd_recordings.front()));
}

/// A limited flow fills by whole internal steps, so that the dead time before it may change within one and no pressure with it.
TEST(DiagnoseSeveral, ADeadTimeIsNotKnownBetterThanTheInternalStep) {
  const std::vector<ActiveEffect> effects = {{"transport_delay", "muscle_0", {{"delay_s", 0.045}}},
                                             {"flow_limit", "muscle_0", {{"fill_rate_per_s", 1.2}, {"vent_rate_per_s", 1.2}}}};
  const Diagnosis found = diagnose(underRandomSteps(effects), few({"flow_limit", "transport_delay", "sensor_delay"}));
  ASSERT_EQ(std::set<std::string>(found.chosen.begin(), found.chosen.end()),
            (std::set<std::string>{"flow_limit@muscle_0", "transport_delay@muscle_0"}))
      << diagnosisSummary(found);
  const auto delay = std::ranges::find(found.effects, "transport_delay", &FoundEffect::id);
  const Estimate& delay_s = delay->parameters.at("delay_s");
  SimulationOptions line;
  line.parameters.setFromText("muscle.model=line", "test");
  Simulation simulation(line);
  simulation.build("rig");
  EXPECT_TRUE(delay_s.is_determined);
  EXPECT_LT(delay_s.low, 0.045) << diagnosisSummary(found);
  EXPECT_GT(delay_s.high, 0.045) << diagnosisSummary(found);
  EXPECT_LE(delay_s.high - delay_s.low, 2.001 * simulation.internalStepS()) << "an internal step to either side at most";
}

}  // namespace
}  // namespace musclesim
