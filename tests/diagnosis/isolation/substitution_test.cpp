// Substitution tests on short recordings of the elbow and of the rig.
#include "diagnosis/isolation/substitution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "diagnosis/isolation/fault_isolation.h"
#include "musclesim/base/random.h"
#include "musclesim/simulation/replay.h"

namespace musclesim {
namespace {

const std::map<std::string, double> noise = {{"pressure_0", 0.003}, {"pressure_1", 0.003}, {"force_0_N", 0.3},       {"force_1_N", 0.3},
                                             {"length_0_mm", 0.05}, {"length_1_mm", 0.05}, {"angle_elbow_deg", 0.05}};

/// A recording of `signals` of a plant under waves, with noise and then with a fault.
Recording recorded(const std::string& robot, const std::vector<std::string>& signals, const std::vector<ActiveEffect>& effects,
                   std::uint64_t seed, const std::function<void(Recording&)>& fault) {
  Recording plan;
  plan.file = robot + std::to_string(seed) + ".csv";
  plan.info.robot = robot;
  const int muscle_count = robot == "rig" ? 1 : 2;
  for (int muscle = 0; muscle < muscle_count; ++muscle) plan.signals.push_back({"command_" + std::to_string(muscle), {}});
  for (int row = 0; row < 300; ++row) {
    plan.time_s.push_back(0.01 * row);
    const double wave = 0.08 * std::sin(2 * std::numbers::pi * 0.5 * static_cast<double>(seed) * 0.01 * row);
    for (int muscle = 0; muscle < muscle_count; ++muscle)
      plan.signals[static_cast<std::size_t>(muscle)].values.push_back(0.4 + (muscle ? -wave : wave));
  }
  ReplayOptions options;
  options.effects = effects;
  Recording recording = replayRecording(plan, options).simulated;
  recording.file = plan.file;
  recording.info.active_effects.clear();
  std::erase_if(recording.signals, [&](const Signal& signal) {
    return !signal.name.starts_with("command_") && std::ranges::find(signals, signal.name) == signals.end();
  });
  RandomStream random(seed, "substitution");
  recording.info.noise_std.clear();
  for (Signal& signal : recording.signals) {
    if (signal.name.starts_with("command_")) continue;
    recording.info.noise_std[signal.name] = noise.at(signal.name);
    for (double& value : signal.values) value += noise.at(signal.name) * random.normal();
  }
  fault(recording);
  return recording;
}

/// A plant and the residual of the model without effects on two recordings of it.
struct Compared {
  Compared(
      const std::string& robot, const std::vector<std::string>& signals, const std::vector<ActiveEffect>& effects,
      const std::function<void(Recording&)>& fault = [](Recording&) {})
      : plant({recorded(robot, signals, effects, 1, fault), recorded(robot, signals, effects, 2, fault)}, options),
        comparison(plant, {{0, 0, 300}, {1, 0, 300}}, Comparison::Derived::with),
        residual(comparison.measured() - comparison.predicted(Model{})) {}
  DiagnosisOptions options;
  Plant plant;
  Comparison comparison;
  Eigen::VectorXd residual;
};

/// Adds a hum to one signal.
std::function<void(Recording&)> hum(const std::string& name, double amplitude) {
  return [=](Recording& recording) {
    for (Signal& signal : recording.signals)
      if (signal.name == name)
        for (std::size_t row = 0; row < signal.values.size(); ++row)
          signal.values[row] += amplitude * std::sin(2 * std::numbers::pi * 7 * recording.time_s[row]);
  };
}

const std::vector<std::string> motion = {"length_0_mm", "length_1_mm", "angle_elbow_deg"};
const ActiveEffect pull{"external_force", "hand", {{"force_x_N", 1.0}}};

bool isRuledOut(const FaultIsolation& isolation, const std::string& stage) {
  return std::ranges::any_of(isolation.places, [&](const Place& place) { return place.stage == stage && place.is_ruled_out; });
}

TEST(MotionTest, FindsTheSensorThatTheOthersContradict) {
  const Compared elbow("elbow", motion, {}, hum("length_1_mm", 0.5));
  const auto test = testMotion(elbow.comparison, elbow.residual);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->odd, "length_1_mm");
  EXPECT_TRUE(test->others_right);
  EXPECT_FALSE(test->agree);
  EXPECT_NEAR(test->odd_ratio, 0.5 / std::sqrt(2) / 0.07, 2.5) << "RMS of the hum over the noise of two signals";
}

TEST(MotionTest, FindsItAmongTwoByWhatIsPredicted) {
  const Compared elbow("elbow", {"length_1_mm", "angle_elbow_deg"}, {}, hum("angle_elbow_deg", 0.5));
  const auto test = testMotion(elbow.comparison, elbow.residual);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->odd, "angle_elbow_deg");
  EXPECT_TRUE(test->others_right);
}

TEST(MotionTest, AcquitsSensorsWhereAllMovesTogether) {
  const Compared elbow("elbow", motion, {pull});
  EXPECT_GT(largestMotionRatio(elbow.comparison, elbow.residual), 10);
  const auto test = testMotion(elbow.comparison, elbow.residual);
  ASSERT_TRUE(test);
  EXPECT_TRUE(test->agree);
  EXPECT_TRUE(test->odd.empty());
}

/// A sensor that reads wrong and a force besides: one signal is odd, but not alone in being wrong.
TEST(MotionTest, DoesNotAcquitTheRestWhereMoreIsWrong) {
  const Compared elbow("elbow", motion, {pull}, hum("length_1_mm", 0.5));
  const auto test = testMotion(elbow.comparison, elbow.residual);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->odd, "length_1_mm");
  EXPECT_FALSE(test->others_right);
}

TEST(MotionTest, SaysNothingOfASingleSignalOrWithoutAGap) {
  const Compared one("elbow", {"angle_elbow_deg"}, {pull});
  EXPECT_FALSE(testMotion(one.comparison, one.residual));
  const Compared clean("elbow", motion, {});
  const auto test = testMotion(clean.comparison, clean.residual);
  ASSERT_TRUE(test);
  EXPECT_FALSE(test->agree) << "there is nothing to acquit of";
  EXPECT_TRUE(test->odd.empty());
}

/// A pull on the hand leaves the law alone, whether pressures are measured or only commanded; a weak muscle does not.
TEST(TensionTest, TellsTheLawFromTheBody) {
  for (const bool measured : {true, false}) {
    std::vector<std::string> signals = {"length_0_mm", "length_1_mm", "force_0_N", "force_1_N"};
    if (measured) signals.insert(signals.end(), {"pressure_0", "pressure_1"});
    const ActiveEffect strong_pull{"external_force", "hand", {{"force_x_N", 4.0}}}, weak{"force_gain", "muscle_0", {{"gain", 0.8}}};
    const Compared pulled("elbow", signals, {strong_pull}), weakened("elbow", signals, {weak});
    const auto by_pull = testTension(pulled.comparison, pulled.residual), by_weakness = testTension(weakened.comparison, weakened.residual);
    ASSERT_TRUE(by_pull && by_weakness);
    EXPECT_LT(by_pull->found, agrees);
    EXPECT_GT(by_pull->expected, disagrees);
    EXPECT_GT(by_weakness->found, disagrees);
    EXPECT_EQ(by_pull->all_commanded, !measured);
  }
}

TEST(TensionTest, TakesNoCommandForAPressureThatAnEffectMakes) {
  DiagnosisOptions options;
  options.model.effects = {{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.1}}}};
  auto nothing = [](Recording&) {};
  const Plant plant(
      {recorded("rig", {"length_0_mm", "force_0_N"}, {}, 1, nothing), recorded("rig", {"length_0_mm", "force_0_N"}, {}, 2, nothing)},
      options);
  const Comparison comparison(plant, {{0, 0, 300}});
  EXPECT_FALSE(testTension(comparison, comparison.measured() - comparison.predicted(Model{})));
}

/// The tension of a muscle whose pressure is not measured tells nothing of the other one's valve.
TEST(TensionTest, OfACommandedPressureAcquitsNoOtherMuscle) {
  const ActiveEffect lag{"valve_lag", "muscle_1", {{"fill_time_constant_s", 0.15}, {"vent_time_constant_s", 0.15}}};
  const Compared elbow("elbow", {"length_0_mm", "length_1_mm", "force_0_N", "force_1_N", "pressure_1"}, {lag});
  const auto test = testTension(elbow.comparison, elbow.residual);
  ASSERT_TRUE(test);
  EXPECT_LT(test->found, agrees);
  EXPECT_TRUE(test->some_commanded && !test->all_commanded && test->of_all_muscles);
  const FaultIsolation isolation = isolateFault(elbow.comparison, elbow.residual, elbow.comparison, {}, {});
  for (const char* stage : {"command", "pressure"}) EXPECT_FALSE(isRuledOut(isolation, stage)) << isolation.method;
  EXPECT_TRUE(isRuledOut(isolation, "force")) << isolation.method;
}

TEST(TensionTest, OfSomeMusclesRulesNothingOut) {
  const ActiveEffect strong_pull{"external_force", "hand", {{"force_x_N", 4.0}}};
  const Compared elbow("elbow", {"length_0_mm", "length_1_mm", "force_0_N"}, {strong_pull});
  const FaultIsolation isolation = isolateFault(elbow.comparison, elbow.residual, elbow.comparison, {}, {});
  EXPECT_FALSE(isRuledOut(isolation, "force")) << isolation.method;
}

/// The law alone is not what a model predicts that holds a weak muscle beforehand.
TEST(TensionTest, IsNotMadeWhereTheModelChangesTensionsOrReadings) {
  for (const ActiveEffect& held :
       {ActiveEffect{"force_gain", "muscle_0", {{"gain", 0.9}}}, ActiveEffect{"sensor_gain", "signal_length_0", {{"gain", 1.1}}}}) {
    DiagnosisOptions options;
    options.model.effects = {held};
    auto nothing = [](Recording&) {};
    const Plant plant(
        {recorded("rig", {"length_0_mm", "force_0_N"}, {}, 1, nothing), recorded("rig", {"length_0_mm", "force_0_N"}, {}, 2, nothing)},
        options);
    const Comparison comparison(plant, {{0, 0, 300}});
    EXPECT_FALSE(testTension(comparison, comparison.measured() - comparison.predicted(Model{}))) << held.id;
  }
}

TEST(Pressures, ThatAreNotThereInOneRecordingAreNotAsPredicted) {
  const Compared lag("rig", {"pressure_0", "length_0_mm"},
                     {{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.1}}}}, [](Recording& recording) {
                       if (recording.file == "rig1.csv")
                         std::erase_if(recording.signals, [](const Signal& s) { return s.name == "pressure_0"; });
                     });
  EXPECT_FALSE(allPressuresMeasured(lag.comparison));
  const FaultIsolation isolation = isolateFault(lag.comparison, lag.residual, lag.comparison, {}, {});
  EXPECT_FALSE(isRuledOut(isolation, "pressure")) << isolation.method;
}

TEST(Pressures, ThatReadWrongWouldMoveWhatDoesNotMove) {
  const std::vector<std::string> signals = {"pressure_0", "length_0_mm"};
  const Compared wrong("rig", signals, {}, hum("pressure_0", 0.05));
  EXPECT_TRUE(allPressuresMeasured(wrong.comparison));
  EXPECT_GT(*ratioOf(wrong.comparison, wrong.residual, "pressure_"), disagrees);
  EXPECT_LT(largestMotionRatio(wrong.comparison, wrong.residual), disagrees);
  EXPECT_EQ(mostAffected(wrong.comparison, wrong.residual, "pressure_"), "pressure_0");
  const auto by_wrong = testPressures(wrong.comparison, wrong.residual);
  ASSERT_TRUE(by_wrong);
  EXPECT_LT(by_wrong->misfit, 0.1);
  EXPECT_GT(by_wrong->misfit_increase, 0.2);
  const Compared lag("rig", signals, {{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.1}}}});
  const auto by_lag = testPressures(lag.comparison, lag.residual);
  ASSERT_TRUE(by_lag);
  EXPECT_NEAR(by_lag->share, 1, 0.1);
  EXPECT_LT(by_lag->misfit_increase, -0.5 * by_lag->misfit);
}

/// The noise of measured pressures moves the model about as much as this short lag of the valve does.
TEST(Pressures, ThatAreNoisyStillTellWhereAWeakGapArises) {
  const Compared lag("rig", {"pressure_0", "length_0_mm"},
                     {{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.02}, {"vent_time_constant_s", 0.02}}}});
  const auto test = testPressures(lag.comparison, lag.residual);
  ASSERT_TRUE(test);
  EXPECT_NEAR(test->share, 1, 0.25);
  EXPECT_GT(test->share_deviation, 0.02);
  const FaultIsolation isolation = isolateFault(lag.comparison, lag.residual, lag.comparison, {}, {});
  for (const char* stage : {"force", "body", "sensor"}) EXPECT_TRUE(isRuledOut(isolation, stage)) << isolation.method;
  for (const char* stage : {"command", "pressure"}) EXPECT_FALSE(isRuledOut(isolation, stage)) << isolation.method;
}

/// The gap of a weak muscle does not come from the pressures, even if these are not as predicted.
TEST(Pressures, MakeNothingOfAGapBehindThem) {
  const Compared weak("rig", {"pressure_0", "length_0_mm"}, {{"force_gain", "muscle_0", {{"gain", 0.95}}}}, hum("pressure_0", 0.01));
  EXPECT_GT(*ratioOf(weak.comparison, weak.residual, "pressure_"), agrees);
  const auto test = testPressures(weak.comparison, weak.residual);
  ASSERT_TRUE(test);
  EXPECT_NEAR(test->share, 0, 0.1);
  EXPECT_FALSE(isRuledOut(isolateFault(weak.comparison, weak.residual, weak.comparison, {}, {}), "force"));
}

}  // namespace
}  // namespace musclesim
