// Plants with a planted effect, noise added; candidates are few to keep the tests short.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/error.h"
#include "musclesim/random.h"
#include "support/support.h"

namespace musclesim {
namespace {

constexpr double noise_mm = 0.05;

/// What a rig with these effects measures under steps and a wave, 4 s.
Recording recorded(const std::vector<ActiveEffect>& effects, double amplitude, std::uint64_t seed) {
  Recording plan;
  plan.file = "plan_" + std::to_string(seed) + ".csv";
  plan.info.robot = "rig";
  plan.signals = {{"command_0", {}}};
  for (int row = 0; row < 400; ++row) {
    const double t = 0.01 * row;
    plan.time_s.push_back(t);
    const double step = std::fmod(t, 1.0) < 0.5 ? 1 : -1;
    plan.signals[0].values.push_back(0.45 + amplitude * (t < 2 ? step : std::sin(2 * std::numbers::pi * t)));
  }
  ReplayOptions options;
  options.effects = effects;
  Recording recording = replayRecording(plan, options).simulated;
  recording.file = plan.file;
  recording.info.active_effects.clear();
  recording.info.noise_std = {{"length_0_mm", noise_mm}};
  std::erase_if(recording.signals, [](const Signal& s) { return s.name != "command_0" && s.name != "length_0_mm"; });
  RandomStream random(seed, "diagnose_test");
  for (double& value : recording.signals[1].values) value += noise_mm * random.normal();
  return recording;
}

std::vector<Recording> plant(const std::vector<ActiveEffect>& effects) {
  return {recorded(effects, 0.15, 1), recorded(effects, 0.2, 2)};
}

DiagnosisOptions few(const std::vector<std::string>& candidates) {
  DiagnosisOptions options;
  options.candidates = candidates;
  options.job_count = 2;
  return options;
}

TEST(Diagnose, FindsAPlantedPayload) {
  const Diagnosis found = diagnose(plant({{"payload", "hand", {{"mass_kg", 0.2}}}}), few({"payload", "valve_lag", "force_gain", "creep"}));
  EXPECT_EQ(found.verdict, Verdict::effects_found);
  ASSERT_EQ(found.chosen, std::vector<std::string>{"payload@hand"});
  const Estimate mass = found.effects.front().parameters.at("mass_kg");
  EXPECT_NEAR(mass.value, 0.2, 0.01);
  EXPECT_LE(mass.low, mass.value);
  EXPECT_GE(mass.high, mass.value);
  EXPECT_GT(found.shrink_percent, 95);
  EXPECT_GT(found.shrink_percent, found.nominal_refit_shrink_percent);
}

TEST(Diagnose, SaysNoGapWhereThereIsOnlyNoise) {
  const Diagnosis found = diagnose(plant({}), few({"payload"}));
  EXPECT_EQ(found.verdict, Verdict::no_gap);
  EXPECT_TRUE(found.chosen.empty());
}

TEST(Diagnose, DoesNotBlameAnotherEffectWhenTheTrueOneIsLeftOut) {
  DiagnosisOptions options = few({"payload", "sensor_bias", "command_dead_band", "force_drift"});
  options.exclude = {"payload"};
  const Diagnosis found = diagnose(plant({{"payload", "hand", {{"mass_kg", 0.3}}}}), options);
  EXPECT_TRUE(found.verdict == Verdict::unexplained || found.effects.front().probability < 0.9) << diagnosisSummary(found);
}

TEST(Diagnose, DoesNotDependOnTheNumberOfThreads) {
  DiagnosisOptions options = few({"payload", "valve_lag"});
  std::vector<std::string> answers;
  for (const int jobs : {1, 3}) {
    options.job_count = jobs;
    Diagnosis found = diagnose(plant({{"valve_lag", "all", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.1}}}}), options);
    found.wall_s = 0;
    answers.push_back(diagnosisJson(found));
  }
  EXPECT_EQ(answers[0], answers[1]);
}

TEST(Diagnose, JsonHasWhatTheContractAsksFor) {
  const auto json = nlohmann::json::parse(diagnosisJson(diagnose(plant({{"payload", "hand", {{"mass_kg", 0.2}}}}), few({"payload"}))));
  EXPECT_EQ(json.at("format"), "musclesim-diagnosis-1");
  for (const char* name : {"robot", "recordings", "verdict", "where", "effects", "none_of_these", "explanations", "chosen", "ambiguity_set",
                           "gap", "unexplained_percent", "partial", "cost"})
    EXPECT_TRUE(json.contains(name)) << name;
  double probability = json.at("none_of_these").get<double>(), share = 0;
  for (const auto& explanation : json.at("explanations")) probability += explanation.at("probability").get<double>();
  for (const auto& place : json.at("where")) share += place.at("share").get<double>();
  EXPECT_NEAR(probability, 1, 0.05);  // explanations below 0.01 are not listed
  EXPECT_NEAR(share, 1, 1e-9);
}

TEST(Diagnose, ReportIsOneSelfContainedPage) {
  const std::string page = diagnosisReport(diagnose(plant({{"payload", "hand", {{"mass_kg", 0.2}}}}), few({"payload"})));
  EXPECT_NE(page.find("payload@hand"), std::string::npos);
  EXPECT_EQ(page.find("src="), std::string::npos);
  EXPECT_EQ(page.find("http://www.w3.org") == std::string::npos ? page.find("http") : std::string::npos, std::string::npos);
}

TEST(Diagnose, RefusesRecordingsItCannotUse) {
  std::vector<Recording> recordings = plant({});
  recordings[1].info.robot = "elbow";
  EXPECT_THROW(diagnose(recordings), BadParameter);
  recordings = plant({});
  recordings[0].signals.pop_back();
  recordings[1].signals.pop_back();
  EXPECT_THROW(diagnose(recordings), BadParameter);
  recordings = {recorded({}, 0.1, 3)};
  recordings[0].time_s.resize(3);
  for (Signal& signal : recordings[0].signals) signal.values.resize(3);
  EXPECT_THROW(diagnose(recordings), BadParameter);
  EXPECT_THROW(diagnose({}), BadParameter);
  EXPECT_THROW(diagnose(plant({}), few({"no_such_effect"})), BadParameter);
}

}  // namespace
}  // namespace musclesim
