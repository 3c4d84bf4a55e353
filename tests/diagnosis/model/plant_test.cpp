// Preparation of recordings: segments for screening, dead sensors, effects that the model already has.
#include "diagnosis/model/plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../planted.h"
#include "musclesim/base/error.h"
#include "musclesim/simulation/replay.h"
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

/// What the machine did before the recording decides the first readings; without them a segment would be empty.
TEST(ScreeningSegments, LastAFewSecondsFromTheFirstReading) {
  DiagnosisOptions options;
  options.skip_start_s = 13;
  const std::vector<Segment> late = Plant({stepped(0.01, 0, 25, "a.csv"), stepped(0.01, 0, 25, "b.csv")}, options).screeningSegments();
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(late.front().end_row, 2500);
  options.skip_start_s = 3;
  EXPECT_EQ(Plant({stepped(0.01, 0, 25, "a.csv"), stepped(0.01, 0, 25, "b.csv")}, options).screeningSegments().front().end_row, 1500);
}

TEST(ScreeningSegments, LeaveOutARecordingWithoutReadings) {
  const DiagnosisOptions options;
  std::vector<Recording> recordings = {stepped(0.01, 0, 3, "a.csv"), stepped(0.01, 0, 3, "b.csv"), stepped(0.02, 0, 3, "c.csv")};
  for (double& value : recordings[1].signals[1].values) value = 240;  // a dead sensor
  for (const Segment& segment : Plant(recordings, options).screeningSegments()) EXPECT_NE(segment.recording, 1);
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

/// Left out with a note it would leave the pressure alone, which agrees whatever the motion does.
TEST(Plant, RefusesAMisspeltColumnThatIsTheOnlyMotion) {
  std::vector<Recording> recordings = planted::plant({}, planted::Pressure::measured);
  for (Recording& recording : recordings)
    for (Signal& signal : recording.signals)
      if (signal.name == "length_0_mm") signal.name = "angle_load_deg";
  try {
    const Plant plant(recordings, {});
    FAIL() << "the motion is not compared";
  } catch (const BadFile& refused) {
    EXPECT_TRUE(contains(refused.what(), "rig has no angle_load_deg")) << refused.what();
    EXPECT_TRUE(contains(refused.what(), "--ignore-columns")) << refused.what();
  }
}

TEST(Plant, SaysThatTheRobotsDescriptionIsAnotherOne) {
  std::vector<Recording> recordings = planted::plant({});
  EXPECT_TRUE(Plant(recordings, {}).notes().empty());
  for (Recording& recording : recordings) recording.info.robot_hash = "another";
  const Plant plant(recordings, {});
  ASSERT_FALSE(plant.notes().empty());
  EXPECT_TRUE(contains(plant.notes().front(), "is not the one with which the recording was made"));
}

/// The muscles of this arm end one millimetre outside their drums: an end that is off by three lies within, and no such robot can be built.
TEST(Plant, LeavesOutWhatDependsOnCommandsInADropout) {
  Recording recording = planted::recorded({}, 0.1, 1);  // other commands every half second
  const auto cut = [&](int first, int last) {
    recording.time_s.erase(recording.time_s.begin() + first, recording.time_s.begin() + last);
    for (Signal& signal : recording.signals) signal.values.erase(signal.values.begin() + first, signal.values.begin() + last);
  };
  cut(30, 60);  // 0.3 .. 0.6 s, over a change of the command
  const DiagnosisOptions options;
  const Plant changed({recording}, options);
  const std::vector<double>& y = changed.measured(0, 0);
  EXPECT_TRUE(std::isfinite(y[29]));
  EXPECT_TRUE(std::isnan(y[30]) && std::isnan(y[130]));
  EXPECT_TRUE(std::isfinite(y[131]));
  recording = planted::recorded({}, 0.1, 1);
  cut(10, 40);  // within one step
  const Plant held({recording}, options);
  EXPECT_TRUE(std::isfinite(held.measured(0, 0)[10]));
}

TEST(Plant, AnEffectWithWhichARobotFileCannotBeBuiltDiverges) {
  std::vector<Recording> recordings;
  for (const double phase : {0.0, 1.0}) {
    Recording plan;
    plan.info.robot = "pulley_arm";
    for (int row = 0; row <= 200; ++row) plan.time_s.push_back(0.01 * row);
    for (int muscle = 0; muscle < 6; ++muscle) {
      plan.signals.push_back({"command_" + std::to_string(muscle), {}});
      for (const double t : plan.time_s) plan.signals.back().values.push_back(0.4 + 0.1 * std::sin(4 * t + phase + muscle));
    }
    recordings.push_back(replayRecording(plan).simulated);
    recordings.back().file = "run" + std::to_string(recordings.size()) + ".csv";
  }
  const DiagnosisOptions options;
  const Plant plant(std::move(recordings), options);
  const auto with = [&](double rise_mm) {
    return plant.predict(0, Model{{{"attachment_offset", "muscle_3", {{"attachment", "end"}, {"rise_mm", rise_mm}}}}, {}}).diverged;
  };
  EXPECT_FALSE(with(-3));
  EXPECT_TRUE(with(3));
}

/// The same bits, and a body is simulated only where the pressures depend on it.
TEST(Plant, PredictsPressuresAloneWithoutTheBody) {
  const DiagnosisOptions options;
  const Plant plant(planted::plant({}, planted::Pressure::measured), options);
  const auto pressures = std::ranges::find(plant.signals(), "pressure_0", &ComparedSignal::name) - plant.signals().begin();
  ASSERT_LT(pressures, std::ssize(plant.signals()));
  const ActiveEffect lag = {"valve_lag", "all", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.06}}},
                     coupling = {"volume_coupling", "all", {{"polytropic_exponent", 1.4}}};
  for (const auto& [effects, simulation_count] :
       {std::pair{std::vector{lag}, 0L}, std::pair{std::vector{lag, coupling}, 1L}, std::pair{std::vector<ActiveEffect>{}, 0L}}) {
    const long before = plant.simulationCount();
    const Prediction alone = plant.predict(0, Model{effects, {}}, 0, Fidelity::fine, Focus::pressures);
    EXPECT_EQ(plant.simulationCount() - before, simulation_count);
    const Prediction whole = plant.predict(0, Model{effects, {}});
    EXPECT_EQ(alone.values[static_cast<std::size_t>(pressures)], whole.values[static_cast<std::size_t>(pressures)]);
    EXPECT_FALSE(alone.diverged);
  }
}

/// The bits of a simulation with the effects, in the order in which they act, and no simulation of their own.
TEST(Plant, ComputesReadingsOfSensorsWithoutMemory) {
  const DiagnosisOptions options;
  const Plant plant(planted::plant({}, planted::Pressure::measured), options);
  const ActiveEffect lag = {"valve_lag", "all", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.06}}},
                     gain = {"sensor_gain", "signal_length_0", {{"gain", 1.07}}},
                     bias = {"sensor_bias", "signal_length_0", {{"offset", 0.3}}}, gain_of_all = {"sensor_gain", "all", {{"gain", 0.9}}},
                     play = {"sensor_backlash", "signal_length_0", {{"width_mm", 1.0}}};
  plant.predict(0, Model{{lag}, {}});
  for (const auto& [effects, simulation_count] :
       {std::pair{std::vector{lag, gain, bias}, 0L}, std::pair{std::vector{bias, lag, gain_of_all}, 0L},
        std::pair{std::vector{bias, lag, play}, 1L}}) {
    const long before = plant.simulationCount();
    const Prediction predicted = plant.predict(0, Model{effects, {}});
    EXPECT_EQ(plant.simulationCount() - before, simulation_count);
    ReplayOptions with_effects;
    with_effects.effects = effects;
    const ReplayResult simulated = replayRecording(plant.recordings().front(), with_effects);
    for (std::size_t i = 0; i < plant.signals().size(); ++i)
      EXPECT_EQ(predicted.values[i], simulated.simulated.find(plant.signals()[i].name)->values) << plant.signals()[i].name;
  }
}

/// A rig with a massless muscle under steps of its pressure, as a machine would record it: the sidecar does not say how it was simulated.
Recording ofAMachine(double noise_mm) {
  Recording plan = planted::recorded({}, 0.1, 1);
  plan.info.robot_parameters["muscle.model"] = "line";
  Recording recording = planted::measuredUnder({}, plan, 1);
  recording.info.extra_json.clear();
  recording.info.noise_std = {{"length_0_mm", noise_mm}};
  return recording;
}

TEST(Plant, TakesAsManyInternalStepsAsTheNoiseAsksFor) {
  const DiagnosisOptions options;
  const Plant noisy({ofAMachine(10)}, options), quiet({ofAMachine(0.01)}, options), quieter({ofAMachine(0.001)}, options);
  EXPECT_FALSE(noisy.hasOwnSubsteps());
  EXPECT_EQ(noisy.substeps(), noisy.model().substeps());
  EXPECT_TRUE(quiet.hasOwnSubsteps());
  EXPECT_GE(quiet.substeps(), 2 * noisy.substeps());
  EXPECT_GE(quieter.substeps(), quiet.substeps());
  EXPECT_LE(quieter.substeps(), 8 * noisy.substeps());
}

TEST(Plant, RepeatsSimulationsInTheStepsInWhichTheyWereMade) {
  Recording simulated = ofAMachine(0.001);
  simulated.info.extra_json = R"({"substeps": 5, "substeps_automatic": true})";
  DiagnosisOptions options;
  EXPECT_FALSE(Plant({simulated}, options).hasOwnSubsteps());
  options.model.substeps = 7;
  const Plant given({ofAMachine(0.001)}, options);
  EXPECT_EQ(given.substeps(), 7);
  EXPECT_TRUE(given.hasOwnSubsteps()) << "a replay would take others by itself";
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

class NumbersOfAPlant : public testing::Test {
 protected:
  static const UncertainNumber* find(const Plant& plant, const std::string& name) {
    const auto found = std::ranges::find_if(plant.numbers(), [&](const UncertainNumber& number) { return number.parameter.name == name; });
    return found == plant.numbers().end() ? nullptr : &*found;
  }
  std::vector<Recording> recordings = planted::plant({});
  DiagnosisOptions options;
};

/// robots/rig.toml says 0.02 of its load and 0.5 of its friction.
TEST_F(NumbersOfAPlant, HaveTheTolerancesOfTheRobot) {
  const Plant plant(recordings, options);
  ASSERT_NE(find(plant, "rig.load_kg"), nullptr);
  EXPECT_EQ(find(plant, "rig.load_kg")->tolerance, 0.02);
  EXPECT_FALSE(find(plant, "rig.load_kg")->is_tuned);
  ASSERT_NE(find(plant, "muscle.slider_friction_N"), nullptr);
  EXPECT_EQ(find(plant, "muscle.slider_friction_N")->tolerance, 0.5);
  options.model.parameters.set("muscle.slider_friction_N", 0.0, "test");
  EXPECT_EQ(find(Plant(recordings, options), "muscle.slider_friction_N"), nullptr) << "a factor does not change 0";
}

TEST_F(NumbersOfAPlant, OfASidecarHaveItsTolerances) {
  recordings.front().info.parameter_tolerance = {{"rig.load_kg", 0.1}, {"rig.minimum_length_mm", 0.01}};
  const Plant plant(recordings, options);
  EXPECT_EQ(find(plant, "rig.load_kg")->tolerance, 0.1);
  ASSERT_NE(find(plant, "rig.minimum_length_mm"), nullptr);
  EXPECT_EQ(std::ranges::count(plant.numbers(), "rig.load_kg", [](const UncertainNumber& number) { return number.parameter.name; }), 1);
  recordings.front().info.parameter_tolerance = {{"rig.load", 0.1}};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { Plant(recordings, options); }), "did you mean \"rig.load_kg\""));
}

TEST_F(NumbersOfAPlant, AreExactWhereTolerancesAreLeftOut) {
  options.left_out = {MethodPart::nuisances};
  options.tune = {"rig.load_kg"};
  const Plant plant(recordings, options);
  ASSERT_EQ(plant.numberCount(), 1);
  EXPECT_TRUE(find(plant, "rig.load_kg")->is_tuned);
}

TEST_F(NumbersOfAPlant, ThatAreTunedMayBeOffByAFactorAndComeFirst) {
  options.tune = {"rig.load_kg"};
  const Plant plant(recordings, options);
  EXPECT_EQ(plant.numbers().front().parameter.name, "rig.load_kg");
  EXPECT_TRUE(plant.numbers().front().is_tuned);
  EXPECT_EQ(plant.numbers().front().tolerance, 0.5);
  EXPECT_EQ(std::ranges::count(plant.numbers(), "rig.load_kg", [](const UncertainNumber& number) { return number.parameter.name; }), 1);
}

/// The prior of a number stands about what the user gave, not about what a fit without effects made of it.
TEST_F(NumbersOfAPlant, ThatWereTunedKeepTheGivenValueAsTheirOrigin) {
  options.tune = {"rig.load_kg"};
  options.model.parameters.set("rig.load_kg", 3.0, "--tune");
  const Plant plant(recordings, options, {{"rig.load_kg", 2.0}});
  EXPECT_EQ(std::get<double>(plant.numbers().front().parameter.value), 2);
  Eigen::VectorXd eta = plant.numbersInForce();
  EXPECT_NEAR(eta[0], std::log(1.5) / 0.5, 1e-12);
  EXPECT_TRUE(eta.tail(eta.size() - 1).isZero(0));
  EXPECT_TRUE(plant.numbersAt(eta).empty()) << "the model has this value";
  eta.setZero();
  ASSERT_EQ(plant.numbersAt(eta).size(), 1U);
  EXPECT_EQ(plant.numbersAt(eta).front().second, 2);
}

TEST_F(NumbersOfAPlant, ThatVaryBetweenRecordingsAreKnown) {
  for (Recording& recording : recordings) recording.info.varies = {"rig.load_kg"};
  recordings.front().info.robot_parameters["rig.load_kg"] = 2.0;
  recordings.back().info.robot_parameters["rig.load_kg"] = 2.5;
  EXPECT_EQ(find(Plant(recordings, options), "rig.load_kg"), nullptr);
  options.tune = {"rig.load_kg"};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { Plant(recordings, options); }), "varies between the recordings"));
}

/// Value in force times exp(tolerance eta), within the parameter's range; four tolerances at most.
TEST_F(NumbersOfAPlant, AreFactorsOfTheValuesInForce) {
  recordings.front().info.parameter_tolerance = {{"rig.load_kg", 5.0}};
  const Plant plant(recordings, options);
  Eigen::VectorXd eta = Eigen::VectorXd::Zero(plant.numberCount());
  EXPECT_TRUE(plant.numbersAt(eta).empty()) << "all as they are";
  EXPECT_TRUE(plant.numbersAt({}).empty());
  const Eigen::Index load = find(plant, "rig.load_kg") - plant.numbers().data();
  eta[load] = -0.3;
  ASSERT_EQ(plant.numbersAt(eta).size(), 1U);
  EXPECT_EQ(plant.numbersAt(eta).front().first, "rig.load_kg");
  EXPECT_NEAR(plant.numbersAt(eta).front().second, 2 * std::exp(-1.5), 1e-12);
  EXPECT_EQ(plant.numberAt(load, 3), 1e3) << "the most that the robot's file allows";
  eta[load] = -7;
  EXPECT_EQ(plant.clampedNumbers(eta)[load], -4);
}

/// A body of mass m, a distance d from the hinge, needs an inertia about the hinge of more than m d^2.
TEST(NumbersThatDependOnEachOther, StayWhereTheRobotCanBeBuilt) {
  Recording recording = stepped(0.01, 0.2, 2, "a.csv");
  recording.info.robot = "elbow";
  recording.info.noise_std.clear();
  recording.signals.push_back({"command_1", recording.signals[0].values});
  DiagnosisOptions options;
  options.tune = {"elbow.forearm_kg", "elbow.forearm_inertia_kgm2"};
  const Plant plant({recording}, options);
  const auto least_inertia_kgm2 = [&](double eta_of_mass) { return plant.numberAt(0, eta_of_mass) * 0.12 * 0.12; };
  Eigen::VectorXd eta = Eigen::VectorXd::Zero(plant.numberCount());
  eta[0] = 0.3;
  EXPECT_EQ(plant.clampedNumbers(eta), eta) << "such a mass is possible";
  eta.head(2) << 1, 1;
  EXPECT_EQ(plant.clampedNumbers(eta), eta) << "with a larger inertia";
  eta[1] = -0.3;
  for (const double margin : {0.0, 0.1}) {
    const Eigen::VectorXd possible = plant.clampedNumbers(eta, margin);
    EXPECT_GT(plant.numberAt(1, possible[1] - margin), least_inertia_kgm2(possible[0]));
    EXPECT_GT(plant.numberAt(1, possible[1]), least_inertia_kgm2(possible[0] + margin));
    EXPECT_LT(plant.numberAt(1, possible[1] - margin - 0.1), least_inertia_kgm2(possible[0])) << "as far as it goes";
  }
}

}  // namespace
}  // namespace musclesim
