// Plants with a planted effect, noise added; candidates are few to keep the tests short.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/error.h"
#include "planted.h"
#include "support/support.h"

namespace musclesim {
namespace {

using planted::few;
using planted::plant;
using planted::recorded;

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
  EXPECT_NE(page.find("class=\"view\""), std::string::npos);  // curves that zoom
  EXPECT_NE(page.find("while filling"), std::string::npos);   // regimes
  EXPECT_NE(page.find("robot from the front"), std::string::npos);
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

TEST(Diagnose, FindsTheNumberOfBits) {
  const Diagnosis found = diagnose(plant({{"command_quantisation", "all", {{"bits", 6.0}}}}), few({"command_quantisation", "valve_lag"}));
  ASSERT_FALSE(found.effects.empty());
  EXPECT_EQ(found.effects.front().id, "command_quantisation");
  EXPECT_EQ(found.effects.front().parameters.at("bits").value, 6);
}

Signal& lengthOf(Recording& recording) {
  return recording.signals[1];
}

TEST(Diagnose, RefusesLengthsInMetres) {
  std::vector<Recording> recordings = plant({});
  for (Recording& recording : recordings)
    for (double& value : lengthOf(recording).values) value /= 1000;
  try {
    diagnose(recordings);
    FAIL();
  } catch (const BadParameter& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("length_0_mm"), std::string::npos);
    EXPECT_NE(message.find("thousand"), std::string::npos);
  }
}

TEST(Diagnose, RefusesRecordingsWhoseOnlySignalIsDead) {
  std::vector<Recording> recordings = plant({});
  for (Recording& recording : recordings)
    for (double& value : lengthOf(recording).values) value = 240;
  EXPECT_THROW(diagnose(recordings), BadParameter);
}

TEST(Diagnose, SaysWhatRowsAreMissing) {
  std::vector<Recording> recordings = plant({});
  for (std::size_t row = 100; row < 150; ++row) lengthOf(recordings[0]).values[row] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t row = 200; row < recordings[1].time_s.size(); ++row) recordings[1].time_s[row] += 0.5;
  const Diagnosis found = diagnose(recordings, few({"payload"}));
  const auto says = [&](const std::string& words) {
    return std::ranges::any_of(found.notes, [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(says("50 of 400 rows have no number for length_0_mm"));
  EXPECT_TRUE(says("no rows between 1.990 and 2.500 s"));
}

TEST(Diagnose, RestingCommandsAreNotExcited) {
  std::vector<Recording> recordings = {recorded({}, 0, 1), recorded({}, 0, 2)};
  EXPECT_EQ(diagnose(recordings).verdict, Verdict::not_excited);
}

}  // namespace
}  // namespace musclesim
