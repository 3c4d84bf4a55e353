#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/robot/chou_hannaford.h"
#include "musclesim/robot/force_law_choice.h"
#include "musclesim/robot/force_map.h"
#include "musclesim/robot/sarosi.h"
#include "musclesim/simulation/simulation.h"
#include "support/not_finite.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// A value worked out by hand for each law: every term counts.
TEST(ChouHannaford, AgreesWithTheFormulaWorkedOutByHand) {
  ChouHannafordConstants constants;
  constants.braid_N = 3000;
  constants.bore_N = 1400;
  constants.elastic_N = 200;
  constants.threshold_N = 300;
  constants.stretch_N = 180;
  constants.stretch_exponent = 40;
  const ChouHannafordForceLaw law(300, constants);
  // s = 0.95: 0.8 (3000 * 0.9025 - 1400) + 200 * -0.05 - 300 + 180 exp(-2) = 0.8 * 1307.5 - 10 - 300 + 24.360350981
  EXPECT_NEAR(law.tensionN(0.8, 285), 760.360350981, 1e-8);
  // s = 1: 0.8 * 1600 - 300 + 180
  EXPECT_NEAR(law.tensionN(0.8, 300), 1160, 1e-9);
  // s = 1.1, tangent 1 + 4: 0.8 (3630 - 1400) + 20 - 300 + 900
  EXPECT_NEAR(law.tensionN(0.8, 330), 2404, 1e-9);
  EXPECT_EQ(law.tensionN(0.1, 240), 0) << "slack: 0.1 (1920 - 1400) - 40 - 300 + 0.06 is negative";
}

TEST(Sarosi, AgreesWithTheFormulaWorkedOutByHand) {
  SarosiConstants constants;
  constants.a1_N = 40;
  constants.a2_N = 200;
  constants.a3 = -50;
  constants.a4_N = -5800;
  constants.a5_N = 1700;
  constants.a6_N = -310;
  const SarosiForceLaw law(300, constants);
  // k = 0.04: (32 + 200) exp(-2) - 5800 * 0.04 * 0.8 + 1360 - 310 = 31.397785703 - 185.6 + 1050
  EXPECT_NEAR(law.tensionN(0.8, 288), 895.797785703, 1e-8);
  // k = -0.1, tangent 1 + 5: 232 * 6 + 464 + 1050
  EXPECT_NEAR(law.tensionN(0.8, 330), 2906, 1e-9);
  EXPECT_EQ(law.tensionN(0.1, 240), 0);
}

TEST(Sarosi, ContainsEquation1) {
  const BraunConstants braun;
  const BraunForceLaw equation_1(120, 300, braun);
  const SarosiForceLaw converted(300, SarosiConstants::ofEquation1(braun, 0.4)), by_default(300, SarosiConstants());
  for (const double p : {0.0, 0.3, 1.0})
    for (const double l : {120.0, 200.0, 290.0, 300.0}) {
      EXPECT_NEAR(converted.tensionN(p, l), equation_1.tensionN(p, l), 1e-11) << p << ", " << l;
      EXPECT_NEAR(by_default.tensionN(p, l), equation_1.tensionN(p, l), 1e-9) << p << ", " << l;
    }
}

TEST(NaturalSpline, ReproducesStraightLinesEverywhere) {
  const NaturalSpline spline(6);
  for (const double x : {-0.7, 0.0, 0.13, 0.5, 0.99, 1.0, 1.4}) {
    const Eigen::VectorXd weights = spline.weights(x);
    EXPECT_NEAR(weights.sum(), 1, 1e-12) << x;
    EXPECT_NEAR(weights.dot(Eigen::VectorXd::LinSpaced(6, 0, 1)), x, 1e-12);
  }
}

TEST(NaturalSpline, PassesThroughItsKnotsAndAgreesWithAHandComputedBump) {
  const NaturalSpline spline(3);
  const Eigen::Vector3d bump(0, 1, 0);
  for (const double x : {0.0, 0.5, 1.0}) EXPECT_NEAR(spline.weights(x).dot(bump), x == 0.5 ? 1 : 0, 1e-12);
  // Knots 0, 1/2, 1, M_1 = 6 (0 - 2 + 0)/4 = -3; at x = 1/4: 1/2 + (1/8 - 1/2)/6 * -3 = 0.6875.
  EXPECT_NEAR(spline.weights(0.25).dot(bump), 0.6875, 1e-12);
  // Slope at the end: per interval 1 - M_1/6 * -1 ... = 1 + 3/6 = 1.5; continued by half an interval: -0.75.
  EXPECT_NEAR(spline.weights(-0.25).dot(bump), -0.75, 1e-12);
  EXPECT_NEAR(spline.weights(1.25).dot(bump), -0.75, 1e-12);
}

TEST(NaturalSpline, HasContinuousSlopesAtItsKnotsAndEnds) {
  const NaturalSpline spline(5);
  Eigen::VectorXd values(5);
  values << 1, -2, 3, 0, 5;
  const double h = 1e-5;
  for (const double x : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double left = (spline.weights(x).dot(values) - spline.weights(x - h).dot(values)) / h;
    const double right = (spline.weights(x + h).dot(values) - spline.weights(x).dot(values)) / h;
    EXPECT_NEAR(left, right, 0.02) << x;
  }
}

TEST(ForceMap, PassesThroughItsNodesAndDoesNotPush) {
  ForceMapTable table;
  table.shortest_ratio = 0.8;
  table.force_N.resize(2, 3);
  table.force_N << -50, 0, 10, 20, 100, 400;
  const ForceMap map(200, table);
  EXPECT_NEAR(map.tensionN(1, 160), 20, 1e-9);
  EXPECT_NEAR(map.tensionN(1, 180), 100, 1e-9);
  EXPECT_NEAR(map.tensionN(1, 200), 400, 1e-9);
  EXPECT_NEAR(map.tensionN(0.5, 200), 205, 1e-9);
  EXPECT_EQ(map.tensionN(0, 160), 0);
}

TEST(ForceMap, DefaultTableIsEquation1AtItsNodes) {
  Parameters parameters;
  const ForceMap map(300, ForceMapTable(parameters));
  const BraunForceLaw equation_1(120, 300);
  for (const double p : {0.0, 0.5, 1.0})
    for (int j = 0; j < 7; ++j) EXPECT_NEAR(map.tensionN(p, 120 + 30 * j), equation_1.tensionN(p, 120 + 30 * j), 1e-9);
}

TEST(ForceLaws, RefuseWhatCannotBe) {
  for (const double length_mm : {0.0, -1.0, nan}) {
    EXPECT_THROW(ChouHannafordForceLaw(length_mm, {}), BadParameter);
    EXPECT_THROW(SarosiForceLaw(length_mm, {}), BadParameter);
  }
  ChouHannafordConstants shrinking;
  shrinking.stretch_exponent = -1;
  EXPECT_THROW(ChouHannafordForceLaw(300, shrinking), BadParameter);
  SarosiConstants broken;
  broken.a4_N = nan;
  EXPECT_THROW(SarosiForceLaw(300, broken), BadParameter);
  ForceMapTable table;
  table.force_N.setZero(1, 3);
  EXPECT_THROW(ForceMap(300, table), BadParameter);
  table.force_N.setConstant(2, 3, nan);
  EXPECT_THROW(ForceMap(300, table), BadParameter);
  table.force_N.setZero(2, 3);
  table.shortest_ratio = 1;
  EXPECT_THROW(ForceMap(300, table), BadParameter);
}

TEST(ForceLawChoice, DefaultIsEquation1WithTheMusclesOwnLengths) {
  Parameters parameters;
  const auto law = makeForceLaw(parameters, 120, 300);
  EXPECT_EQ(law->name(), "braun");
  EXPECT_EQ(law->tensionN(0.7, 231), BraunForceLaw(120, 300).tensionN(0.7, 231));
}

TEST(ForceLawChoice, EveryNameGivesItsLawAndKnowsOnlyItsOwnConstants) {
  for (const auto& name : forceLawNames()) {
    Parameters parameters;
    parameters.set("force_law.name", name, "test");
    EXPECT_EQ(makeForceLaw(parameters, 120, 300)->name(), name);
    parameters.set("force_law.braid_N", 1.0, "test");
    if (name == "chou-hannaford")
      EXPECT_NO_THROW(parameters.requireAllKnown());
    else
      EXPECT_THROW(parameters.requireAllKnown(), BadParameter) << name;
  }
  Parameters unknown;
  unknown.set("force_law.name", std::string("sarosy"), "test");
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { makeForceLaw(unknown, 120, 300); }), "chou-hannaford"));
}

TEST(ForceLawChoice, RestLengthAndMinimumLengthScaleTheMeasuredMuscle) {
  Parameters parameters;
  parameters.set("force_law.rest_length_mm", 250.0, "test");
  parameters.set("force_law.minimum_length_ratio", 0.8, "test");
  EXPECT_EQ(makeForceLaw(parameters, 120, 300)->restLengthMm(), 250);
  EXPECT_EQ(makeForceLaw(parameters, 120, 300)->contractedLengthMm(), 200);
  EXPECT_NEAR(makeForceLaw(parameters, 120, 300)->tensionN(0.6, 230), BraunForceLaw(200, 250).tensionN(0.6, 230), 1e-9);
  Parameters other;
  other.set("force_law.name", std::string("sarosi"), "test");
  other.set("force_law.rest_length_mm", 250.0, "test");
  EXPECT_NEAR(makeForceLaw(other, 120, 300)->tensionN(0.6, 230), SarosiForceLaw(250, {}).tensionN(0.6, 230), 1e-9);
}

TEST(ForceLaw, StopsPullingAtItsContractedLength) {
  EXPECT_NEAR(SarosiForceLaw(250, {}).contractedLengthMm().value(), 100, 1e-6) << "as Eq. 1 for l_min / l_max = 0.4";
  ChouHannafordConstants wide_bore;
  wide_bore.bore_N = 20;
  const ChouHannafordForceLaw braid(300, wide_bore);
  const double contracted_mm = braid.contractedLengthMm().value();
  EXPECT_NEAR(braid.formulaN(1, contracted_mm), 0, 1e-9);
  EXPECT_GT(braid.formulaN(1, contracted_mm + 1), 0);
  EXPECT_LT(braid.formulaN(1, contracted_mm - 1), 0);
  ChouHannafordConstants never_slack;
  never_slack.bore_N = -1e3;
  EXPECT_EQ(ChouHannafordForceLaw(300, never_slack).contractedLengthMm(), 0);
  ChouHannafordConstants never_pulling;
  never_pulling.threshold_N = 1e4;
  EXPECT_EQ(ChouHannafordForceLaw(300, never_pulling).contractedLengthMm(), 0);
}

/// The same law under another name gives the same motion: Sarosi's defaults equal Eq. 1 for the rig's 120 and 300 mm.
TEST(ForceLaws, NoMusclePushesNeitherAChainNorALine) {
  for (const std::string model : {"chain", "line"})
    for (const PhysicsKind physics : {PhysicsKind::si, PhysicsKind::original}) {
      SimulationOptions options;
      options.physics = physics;
      options.parameters.set("muscle.model", model, "test");
      options.parameters.set("force_law.a", -0.07, "test");  // pushes when vented
      options.parameters.set("force_law.b", 0.0, "test");
      Simulation simulation(options);
      const Actuator& muscle = *simulation.build("rig").actuators()[0];
      ASSERT_LT(muscle.calculateForce(0, muscle.lengthMm()), -1);
      const bool is_original_chain = physics == PhysicsKind::original && model == "chain";
      EXPECT_EQ(muscle.tensionN() < 0, is_original_chain) << model << ": only the published program's chains push";
    }
}

TEST(ForceLawChoice, DrivesARobotsMuscles) {
  const auto settledLengthMm = [](const std::string& name) {
    SimulationOptions options;
    options.parameters.set("force_law.name", name, "test");
    Simulation simulation(options);
    Robot& rig = simulation.build("rig");
    simulation.start("settled", {0.5});
    EXPECT_EQ(rig.actuators()[0]->forceLaw().name(), name);
    return rig.actuators()[0]->lengthMm();
  };
  const double equation_1_mm = settledLengthMm("braun");
  EXPECT_NEAR(settledLengthMm("sarosi"), equation_1_mm, 1e-3);
  EXPECT_GT(std::abs(settledLengthMm("chou-hannaford") - equation_1_mm), 1);
}

}  // namespace
}  // namespace musclesim
