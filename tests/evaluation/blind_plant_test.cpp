// Plants of a blind check: kinds, machines, numbers nobody measured, robots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "evaluation/blind/cause.h"
#include "evaluation/blind/contribution.h"
#include "evaluation/blind/excitation.h"
#include "evaluation/blind/key.h"
#include "evaluation/blind/machine.h"
#include "evaluation/blind/plant.h"
#include "musclesim/base/error.h"
#include "musclesim/simulation/replay.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim::blind {
namespace {

PlantRequest request(const std::string& kind, std::uint64_t seed, const std::string& robot = "rig") {
  return {"case001", robot, 0, {kind}, {}, false, 1, seed, [] { return false; }};
}

TEST(BlindKind, HasTheSharesOfTheBenchmark) {
  RandomStream random(1, "test");
  std::map<std::string, int> counts;
  constexpr int draw_count = 20000;
  double sum = 0;
  for (int i = 0; i < draw_count; ++i) ++counts[drawKind({}, random).name];
  for (const Kind& kind : kinds()) {
    EXPECT_NEAR(counts[kind.name] / static_cast<double>(draw_count), kind.share, 0.01) << kind.name;
    sum += kind.share;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(drawKind({"mixed"}, random).name, "mixed");
  EXPECT_TRUE(contains(messageOf<BadParameter>([] { kindOf("quintuple"); }), "quadruple"));
}

TEST(BlindKind, KnowsItsVerdict) {
  EXPECT_EQ(kindOf("null").verdict(), "no_gap");
  EXPECT_EQ(kindOf("open").verdict(), "unexplained");
  EXPECT_EQ(kindOf("mixed").verdict(), "effects_found");
  EXPECT_TRUE(kindOf("mixed").isSeveral());
  EXPECT_FALSE(kindOf("open").isSeveral() || kindOf("single").isSeveral());
}

double valueOf(const Cause& cause, const std::string& name) {
  return std::get<double>(cause.law.parameters.at(name));
}

TEST(BlindMachine, DrawsMeasuredSizes) {
  Simulation simulation;
  const Robot& elbow = simulation.build("elbow");
  RandomStream random(2, "test");
  std::set<std::string> drawn;
  for (int i = 0; i < 50; ++i) {
    const std::vector<Cause> causes = drawMachine(most_machine_causes, elbow, random);
    std::set<std::string> ids;
    for (const Cause& cause : causes) {
      ids.insert(cause.id);
      EXPECT_EQ(cause.component, "all");
      EXPECT_NE(cause.law.id, cause.id) << "another law than the catalogue's";
      if (cause.id == "transport_delay") {
        EXPECT_TRUE(valueOf(cause, "delay_s") >= 0.044 && valueOf(cause, "delay_s") <= 0.096);
      }
      if (cause.id == "flow_limit") {
        EXPECT_GT(valueOf(cause, "fill_rate_per_s"), valueOf(cause, "vent_rate_per_s"));
      }
      if (cause.id == "pressure_calibration") {
        EXPECT_NEAR(valueOf(cause, "offset"), -0.05, 0.0101);
      }
    }
    EXPECT_EQ(ids.size(), causes.size()) << "none twice";
    EXPECT_FALSE(ids.contains("valve_lag") && ids.contains("flow_limit"));
    drawn.insert(ids.begin(), ids.end());
  }
  EXPECT_EQ(drawn.size(), 6u);
  EXPECT_THROW(drawMachine(6, elbow, random), BadParameter);
}

TEST(BlindCause, ActsBesideOthersThatCanBeTold) {
  const auto law = [](const std::string& cause) { return *std::ranges::find(outOfCatalogueLaws(), cause, &OutOfCatalogueLaw::stands_for); };
  const auto beside = [&](const std::string& one, const std::string& other) {
    return canActBeside(law(one), {Cause{.id = other, .component = "all", .law = {law(other).info.id, "all", {}}}});
  };
  EXPECT_TRUE(beside("valve_lag", "pressure_calibration")) << "of the same stage";
  EXPECT_FALSE(beside("creep", "creep"));
  EXPECT_FALSE(beside("valve_lag", "flow_limit"));
  EXPECT_FALSE(beside("transport_delay", "sensor_delay"));
}

TEST(BlindCause, IsADeadBandThatCommandsEnterAndLeave) {
  const OutOfCatalogueLaw& law = *std::ranges::find(outOfCatalogueLaws(), "command_dead_band", &OutOfCatalogueLaw::stands_for);
  const auto drawn = [&](double amplitude) {
    RandomStream random(1, "test");
    const Recording plan = planned("rig", 1, {"steps", amplitude, 1}, 1, random);
    const Truth truth({plan, plan}, {"pressure_0"}, {{"pressure_0", 0.004}}, 1);
    auto cause = causeOfSize(law, "muscle_0", "strong", truth, random);
    return std::pair(cause, cause ? truth.motion({cause->law}).front().find("pressure_0")->values : std::vector<double>{});
  };
  const auto [cause, pressure] = drawn(0.2);
  ASSERT_TRUE(cause);
  const auto shut = std::ranges::count(pressure, 0.0);
  EXPECT_GE(20 * shut, std::ssize(pressure));
  EXPECT_LE(20 * shut, 19 * std::ssize(pressure));
  EXPECT_FALSE(drawn(0).first) << "a command that never changes is in the band or not";
}

TEST(BlindPlant, DemandsWhatCanBeSeen) {
  const std::map<std::string, double> gap = {{"angle", 100}, {"pressure", 4}};
  const auto demanded = [&](double angle, double pressure, std::size_t cause_count) {
    return isDemanded({{"angle", angle}, {"pressure", pressure}}, gap, cause_count);
  };
  EXPECT_FALSE(demanded(9, 2.9, 2));
  EXPECT_TRUE(demanded(10, 0, 2));
  EXPECT_TRUE(demanded(9, 3, 2)) << "one signal shows it";
  EXPECT_TRUE(demanded(2, 2, 1)) << "a lone cause";
  EXPECT_FALSE(demanded(9, 0.9, 1)) << "but not beside a gap that it does not make";
}

/// A recording of one second without motion, as a plan.
Recording rest() {
  RandomStream random(1, "test");
  return planned("rig", 1, {"triangle", 0.01, 1}, 1, random);
}

TEST(BlindNumbers, LieAroundTheModelsByTheirTolerance) {
  RandomStream random(3, "test");
  const Recording plan = rest();
  std::map<double, int> scales;
  double load_squares = 0, count = 0;
  for (int i = 0; i < 400; ++i) {
    const NumberErrors errors = drawNumbers(plan, random);
    ++scales[errors.scale];
    EXPECT_EQ(errors.truth.empty(), errors.scale == 0);
    if (errors.scale != 1) continue;
    EXPECT_EQ(errors.nominal.at("rig.load_kg"), 2);
    EXPECT_TRUE(errors.truth.contains("muscle.slider_friction_N") && errors.truth.contains("force_law.c_kgf"));
    load_squares += std::pow(std::log(errors.truth.at("rig.load_kg") / 2), 2);
    ++count;
  }
  EXPECT_NEAR(scales[1], 280, 30);
  EXPECT_NEAR(scales[2], 40, 20);
  EXPECT_NEAR(std::sqrt(load_squares / count), 0.02, 0.003);
}

TEST(BlindPlant, TellsInTheKeyWhatEachCauseContributes) {
  Simulation simulation;
  const Robot& rig = simulation.build("rig");
  const auto plant = drawPlant(request("triple", 4));
  ASSERT_TRUE(plant);
  const nlohmann::json key = keyOf(*plant, rig), again = keyOf(*drawPlant(request("triple", 4)), rig);
  EXPECT_EQ(key, again) << "the same seed, the same plant";
  ASSERT_EQ(key["effects"].size(), 3u);
  EXPECT_EQ(key["acceptable"].size(), 3u);
  const auto noise_std = key["noise_std"].get<std::map<std::string, double>>();
  for (std::size_t i = 0; i < 3; ++i) {
    const nlohmann::json& effect = key["effects"][i];
    const double contribution = effect["contribution_over_noise"];
    std::vector<ActiveEffect> others = lawsOf(plant->causes);
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const Truth& truth = plant->truth;
    EXPECT_LE(contribution, truth.gapOverNoise(truth.rmse(truth.motion(others), truth.motion(lawsOf(plant->causes)))))
        << "the others stand in for it";
    double largest = 0;
    bool demanded = false;
    for (const auto& [signal, value] : effect["contribution_per_signal"].items()) {
      largest = std::max(largest, value.get<double>());
      demanded =
          demanded || value.get<double>() >= std::max(3.0, 0.1 * key["noise_free_rmse"][signal].get<double>() / noise_std.at(signal));
    }
    EXPECT_EQ(effect["demanded"], demanded);
    EXPECT_DOUBLE_EQ(largest, contribution);
  }
  EXPECT_TRUE(key["numbers_nominal"].contains("rig.load_kg"));
  EXPECT_EQ(key["number_error_scale"] == 0, key["numbers_true"].empty());
}

/// A plant at rest and moving whose only cause is a payload, beside a load that is known to 2 %.
TEST(BlindContribution, IsWhatNumbersWithinTheirTolerancesCannotMake) {
  RandomStream random(3, "test");
  const Truth truth({planned("rig", 1, {"triangle", 0.1, 1}, 1, random)}, {"length_0_mm", "force_0_N"},
                    {{"length_0_mm", 0.05}, {"force_0_N", 0.5}}, 1);
  NumberErrors numbers;
  numbers.nominal = {{"rig.load_kg", 2}};
  const ActiveEffect small{"payload", "hand", {{"mass_kg", 0.04}}}, large{"payload", "hand", {{"mass_kg", 0.4}}};
  const auto contribution = [&](const ActiveEffect& cause) {
    return truth.gapOverNoise(truth.rmse(truth.clean(), truth.motion({cause}))) > 1
               ? contributionBeside({}, truth.motion({cause}), truth, numbers).at("length_0_mm")
               : 0;
  };
  const double small_alone = contribution(small), large_alone = contribution(large);
  numbers.tolerance = {{"rig.load_kg", 0.02}};
  EXPECT_LT(contribution(small), 0.2 * small_alone) << "a load one tolerance larger does the same";
  EXPECT_GT(contribution(large), 0.1 * large_alone) << "ten tolerances are too many";
}

/// Beside a lag, a dead time of a valve: a longer lag stands in for a part of it only.
TEST(BlindContribution, IsWhatTheOtherCausesCannotMake) {
  RandomStream random(3, "test");
  const Truth truth({planned("rig", 1, {"triangle", 0.1, 1}, 2, random)}, {"length_0_mm"}, {{"length_0_mm", 0.05}}, 1);
  const ActiveEffect lag{"valve_lag", "all", {{"fill_time_constant_s", 0.06}, {"vent_time_constant_s", 0.06}}};
  const ActiveEffect delay{"transport_delay", "all", {{"delay_s", 0.03}}};
  const auto both = truth.motion({lag, delay});
  const double as_they_are = truth.rmse(truth.motion({lag}), both).at("length_0_mm") / 0.05;
  const double refitted = contributionBeside({lag}, both, truth, {}).at("length_0_mm");
  EXPECT_LT(refitted, 0.6 * as_they_are);
  EXPECT_GT(refitted, 0.01 * as_they_are);
}

TEST(BlindPlant, HasTheModelsNumbersIfAsked) {
  PlantRequest exact = request("null", 1);
  exact.exact_numbers = true;
  const auto plant = drawPlant(exact);
  EXPECT_TRUE(plant->numbers.truth.empty());
  const Truth& truth = plant->truth;
  EXPECT_EQ(truth.gapOverNoise(truth.rmse(truth.model(), plant->motion)), plant->gap_of_step_over_noise);
}

TEST(BlindPlant, HasAnUnknownCauseBesideKnownOnes) {
  Simulation simulation;
  const nlohmann::json key = keyOf(*drawPlant(request("mixed", 2)), simulation.build("rig"));
  const nlohmann::json& unknown = key["effects"].back();
  EXPECT_EQ(unknown["known"], false);
  EXPECT_EQ(unknown["id"], unknown["law"]);
  EXPECT_EQ(key["acceptable"].size() + 1, key["effects"].size());
  EXPECT_TRUE(key.contains("oracle_shrink_percent"));
}

/// The wrist's stops lie at -2 and 90 degrees; its hand stays in a plane.
TEST(BlindPlan, IsDrawnForAnyRobot) {
  Simulation simulation;
  const Robot& wrist = simulation.build("wrist");
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    RandomStream random(seed, "test");
    const Plan plan = drawPlan("case001", "wrist", wrist, {"null"}, 1, random);
    ASSERT_EQ(plan.recordings.size(), 4u);
    EXPECT_EQ(plan.recordings[0].muscleCount(), 2);
    EXPECT_TRUE(std::ranges::count(plan.signals, "angle_wrist_deg"));
    EXPECT_FALSE(std::ranges::count(plan.signals, "hand_z_mm"));
    const Recording motion = replayRecording(plan.recordings[0]).simulated;
    for (const double angle_deg : motion.find("angle_wrist_deg")->values) EXPECT_TRUE(angle_deg > 10 && angle_deg < 77) << angle_deg;
  }
}

}  // namespace
}  // namespace musclesim::blind
