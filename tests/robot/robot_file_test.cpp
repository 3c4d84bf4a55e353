/// Robots from files: what the reader refuses, what it builds.
#include "musclesim/robot/robot_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "../../robot/robotic_arm_file.h"
#include "musclesim/base/error.h"
#include "musclesim/robot/line_of_pull.h"
#include "musclesim/robot/robot_registry.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// A lever on a hinge between two line muscles; every wrong description below changes one thing in it.
const std::string lever = R"(format = "musclesim-robot-1"
name = "lever"

[parameter.lever_mm]
value = 80
range = [20, 200]
meaning = "distance of the attachments from the hinge"

[[body]]
name = "bar"
at_mm = [0, 0, 0]
shape = { type = "box", size_mm = [200, 20, 20] }
mass_g = 400

[[joint]]
name = "lever"
type = "hinge"
body = "bar"
at_mm = [0, 0, 0]
axis = "z"
limits_deg = [-40, 40]

[[pulley]]
name = "drum"
at_mm = [40, -100, 0]
axis = "z"
radius_mm = 10

[[muscle]]
name = "right"
from = { body = "world", at_mm = ["lever_mm", -260, 0] }
to = { body = "bar", at_mm = ["lever_mm", -10, 0] }
length_mm = [150, 320]
model = "line"

[[muscle]]
name = "left"
from = { body = "world", at_mm = ["-lever_mm", -260, 0] }
to = { body = "bar", at_mm = ["-lever_mm", -10, 0] }
length_mm = [150, 320]
model = "line"

[hand]
body = "bar"
at_mm = [100, 0, 0]
)";

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = lever;
  const auto place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

struct Built {
  explicit Built(const std::string& text, SimulationOptions options = {}) : simulation(std::move(options)) {
    robot = &simulation.build([&](World& world) { return makeRobotFromText(text, "lever.toml", world); });
  }
  Simulation simulation;
  Robot* robot;
};

TEST(RobotFile, BuildsBodiesJointsMusclesAndHand) {
  Built built(lever);
  EXPECT_EQ(built.robot->name(), "lever");
  EXPECT_EQ(built.robot->actuatorCount(), 2);
  EXPECT_EQ(built.robot->actuators()[0]->name(), "right");
  EXPECT_NEAR(built.robot->actuators()[0]->lengthMm(), 250, 1e-9);
  EXPECT_NEAR(built.robot->getState().hand_mm->x(), 100, 1e-9);
  EXPECT_EQ(built.robot->signalNames().back(), "hand_z_mm");
  EXPECT_EQ(built.robot->angles().front().name, "lever");
  EXPECT_NEAR(built.robot->hand()->massG(), 400, 1e-9);
}

TEST(RobotFile, ParametersMoveWhatTheyDescribe) {
  SimulationOptions options;
  options.parameters.setFromText("lever.lever_mm=60", "test");
  Built built(lever, std::move(options));
  EXPECT_NEAR(built.robot->actuators()[0]->line()->pointsMm().front().x(), 60, 1e-12);
  SimulationOptions wrong;
  wrong.parameters.setFromText("lever.lever_mm=10", "test");
  EXPECT_THROW(Built(lever, std::move(wrong)), BadParameter);
}

TEST(RobotFile, HasTolerancesOfItsOwnParametersAndOfTheModels) {
  std::string text = replaced("range = [20, 200]", "range = [20, 200]\ntolerance = 0.02");
  text += "[parameter_tolerance]\n\"muscle.slider_friction_N\" = 0.5\nforce_law.c_kgf = 0.05\n";
  const Built built(text);
  const std::map<std::string, double> tolerances = {{"lever.lever_mm", 0.02}, {"muscle.slider_friction_N", 0.5}, {"force_law.c_kgf", 0.05}};
  EXPECT_EQ(built.robot->parameterTolerances(), tolerances);
  EXPECT_NO_THROW(built.robot->requireTolerances());
  EXPECT_TRUE(Built(lever).robot->parameterTolerances().empty());
  Simulation arm;
  EXPECT_TRUE(arm.build("arm").parameterTolerances().empty());
}

/// The error of requireTolerances for one entry of [parameter_tolerance].
std::string toleranceError(const std::string& entry, SimulationOptions options = {}) {
  const Built built(lever + "[parameter_tolerance]\n" + entry + "\n", std::move(options));
  return messageOf<BadFile>([&] { built.robot->requireTolerances(); });
}

TEST(RobotFile, RefusesTolerancesOfWhatNoFactorChanges) {
  const std::string unknown = toleranceError("\"muscle.slider_fricton_N\" = 0.5");
  EXPECT_TRUE(contains(unknown, "lever.toml:47:")) << unknown;
  EXPECT_TRUE(contains(unknown, "did you mean \"muscle.slider_friction_N\"")) << unknown;
  EXPECT_TRUE(contains(toleranceError("\"force_law.rest_length_mm\" = 0.1"), "force_law.rest_length_mm = 0: must not be 0"));
  EXPECT_TRUE(contains(toleranceError("\"force_law.name\" = 0.1"), "not a choice"));
}

TEST(RobotFile, MayHaveTolerancesOfTheDefaultForceLawUnderAnother) {
  SimulationOptions options;
  options.parameters.setFromText("force_law.name=sarosi", "test");
  const Built built(lever + "[parameter_tolerance]\n\"force_law.c_kgf\" = 0.05\n", std::move(options));
  EXPECT_NO_THROW(built.robot->requireTolerances());
}

TEST(RobotFile, ShippedRobotsHaveTolerancesThatTheirModelsKnow) {
  for (const ShippedRobot& shipped : shippedRobots()) {
    Simulation simulation;
    const Robot& robot = simulation.build(shipped.name);
    EXPECT_NO_THROW(robot.requireTolerances()) << shipped.name;
    const auto tolerances = robot.parameterTolerances();
    EXPECT_GE(tolerances.size(), 3U) << shipped.name;
    EXPECT_LE(tolerances.size(), 6U) << shipped.name << ": each costs a diagnosis simulations";
    EXPECT_EQ(tolerances.at("force_law.c_kgf"), 0.05) << shipped.name;
  }
}

struct Wrong {
  const char* name;
  std::string from, to;
  std::string message;  ///< a part of the error
  int line = 0;         ///< 0: any
};

std::ostream& operator<<(std::ostream& out, const Wrong& wrong) {
  return out << wrong.name;
}

const std::vector<Wrong>& wrongDescriptions() {
  static const std::vector<Wrong> all = {
      {"not TOML", "value = 80", "value = = 80", "", 5},
      {"no format", "format = \"musclesim-robot-1\"\n", "", "\"format\" is missing"},
      {"another format", "musclesim-robot-1", "musclesim-robot-2", "must be \"musclesim-robot-1\"", 1},
      {"name of the program's own", "name = \"lever\"", "name = \"muscle\"", "choose another name", 2},
      {"unknown key", "mass_g = 400", "mas_g = 400", "did you mean \"mass_g\"", 13},
      {"unknown section", "[hand]", "[hnad]", "did you mean \"hand\""},
      {"text for a number", "mass_g = 400", "mass_g = true", "must be a number", 13},
      {"infinite number", "mass_g = 400", "mass_g = inf", "must be finite", 13},
      {"negative mass", "mass_g = 400", "mass_g = -400", "must be positive", 13},
      {"no mass", "mass_g = 400", "", "\"mass_g\" is missing", 9},
      {"two numbers for a vector", "[200, 20, 20]", "[200, 20]", "list of 3 numbers", 12},
      {"shape of another kind", "type = \"box\"", "type = \"bax\"", "did you mean \"box\"", 12},
      {"shape without size", ", size_mm = [200, 20, 20]", "", "\"size_mm\" is missing", 12},
      {"unknown parameter", "\"lever_mm\", -260", "\"levr_mm\", -260", "did you mean \"lever_mm\"", 31},
      {"expression that cannot be read", "\"lever_mm\", -260", "\"lever_mm * \", -260", "\"lever_mm * \"", 31},
      {"expression that is not finite", "\"lever_mm\", -260", "\"lever_mm / 0\", -260", "must be finite", 31},
      {"parameter outside its range", "value = 80", "value = 300", "must lie in its range 20 .. 200", 5},
      {"range in the wrong order", "range = [20, 200]", "range = [200, 20]", "in order", 6},
      {"two bodies of one name", "[[joint]]",
       "[[body]]\nname = \"bar\"\nat_mm = [0, 0, 0]\nshape = { type = \"none\" }\nmass_g = 1\ninertia_g_mm2 = "
       "[1, 1, 1]\nfree = true\n[[joint]]",
       "two bodies of the name \"bar\"", 15},
      {"two muscles of one name", "name = \"left\"", "name = \"right\"", "two muscles and actuators of the name \"right\""},
      {"joint of a body that is not there", "body = \"bar\"\nat_mm = [0, 0, 0]\naxis", "body = \"baar\"\nat_mm = [0, 0, 0]\naxis",
       "did you mean \"bar\"", 15},
      {"muscle of a body that is not there", "to = { body = \"bar\"", "to = { body = \"lever\"", "there is no \"lever\" among the bodies",
       32},
      {"muscle with both ends on one body", "from = { body = \"world\", at_mm = [\"lever_mm\"",
       "from = { body = \"bar\", at_mm = [\"lever_mm\"", "both ends are on \"bar\"", 29},
      {"muscle that is too short", "length_mm = [150, 320]", "length_mm = [260, 320]", "lie between its minimum and maximum length", 33},
      {"muscle that is too long", "length_mm = [150, 320]", "length_mm = [150, 240]", "lie between its minimum and maximum length", 33},
      {"path of a chain", "model = \"line\"", "model = \"chain\"\npath = [{ pulley = \"drum\" }]", "needs model = \"line\""},
      {"pulley that is not there", "model = \"line\"", "model = \"line\"\npath = [{ pulley = \"drums\" }]", "did you mean \"drum\"", 35},
      {"tendon of a chain", "model = \"line\"", "model = \"chain\"\ntendon_mm = 10", "needs model = \"line\""},
      {"unknown force law", "model = \"line\"", "force_law = { name = \"brown\" }", "braun", 34},
      {"unknown number of a force law", "model = \"line\"", "force_law = { name = \"chou-hannaford\", bore_M = 3 }", "bore_N", 34},
      {"limits without the pose as built", "limits_deg = [-40, 40]", "limits_deg = [10, 40]", "contain 0 deg", 21},
      {"limits that wrap", "limits_deg = [-40, 40]", "limits_deg = [-40, 200]", "where the engine can hold them", 21},
      {"limits in the wrong order", "limits_deg = [-40, 40]", "limits_deg = [40, -40]", "in order", 21},
      {"axis without direction", "axis = \"z\"", "axis = [0, 0, 0]", "have a direction", 20},
      {"axis of another name", "axis = \"z\"", "axis = \"w\"", "must be \"x\", \"y\", \"z\"", 20},
      {"joint of another type", "type = \"hinge\"", "type = \"hinges\"", "did you mean \"hinge\"", 17},
      {"joint to itself", "at_mm = [0, 0, 0]\naxis", "to = \"bar\"\nat_mm = [0, 0, 0]\naxis", "to itself", 15},
      {"inertia that no body has", "mass_g = 400", "mass_g = 400\ninertia_g_mm2 = [1, 1, 100]", "no body has", 9},
      {"two moments of inertia", "mass_g = 400", "mass_g = 400\ninertia_g_mm2 = [1, 1]", "must have 3", 14},
      {"body that nothing holds", "body = \"bar\"\nat_mm = [0, 0, 0]\naxis = \"z\"\nlimits_deg = [-40, 40]",
       "body = \"base\"\nat_mm = [0, 0, 0]\naxis = \"z\"\nlimits_deg = [-40, 40]\n[[body]]\nname = \"base\"\nat_mm = [0, 0, 0]\nshape = { "
       "type "
       "= \"sphere\", radius_mm = 5 }\nmass_g = 1",
       "nothing holds this body", 9},
      {"cycle of fixed joints", "[[pulley]]",
       "[[joint]]\nname = \"a\"\ntype = \"fixed\"\nbody = \"bar\"\n[[joint]]\nname = \"b\"\ntype = "
       "\"fixed\"\nbody = \"bar\"\n[[pulley]]",
       "cycle of fixed joints"},
      {"hand on a body that is not there", "[hand]\nbody = \"bar\"", "[hand]\nbody = \"bars\"", "did you mean \"bar\""},
      {"negative friction", "axis = \"z\"\nlimits", "axis = \"z\"\nfriction_Nm = -1\nlimits", "must not be negative", 21},
      {"friction of a slider on a hinge", "axis = \"z\"\nlimits", "axis = \"z\"\nfriction_N = 1\nlimits", "did you mean \"friction_Nm\"",
       21},
      {"color outside its range", "mass_g = 400", "mass_g = 400\ncolor = [2, 0, 0]", "lie in 0 .. 1", 14},
      {"letter for a place", "at_mm = [0, 0, 0]\naxis", "at_mm = \"y\"\naxis", "list of 3 numbers", 19},
      {"pulley without radius that no muscle uses", "radius_mm = 10", "radius_mm = 0", "must be positive", 27},
      {"density of a body with inertia", "mass_g = 400", "density_g_per_mm3 = 0.001\ninertia_g_mm2 = [1, 1, 1]", "needs mass_g", 14},
      {"assignment to a parameter", "\"lever_mm\", -260", "\"lever_mm = 3\", -260", "\"lever_mm = 3\"", 31},
      {"two values in one expression", "\"lever_mm\", -260", "\"lever_mm, 2\", -260", "must be one number", 31},
      {"tolerance of nothing", "range = [20, 200]", "range = [20, 200]\ntolerance = 0", "0 must be above 0 and at most 2", 7},
      {"tolerance above its range", "range = [20, 200]", "range = [20, 200]\ntolerance = 2.5", "2.5 must be above 0 and at most 2", 7},
      {"tolerance that is no number", "range = [20, 200]", "range = [20, 200]\ntolerance = \"lever_mm\"", "plain number", 7},
      {"tolerance of the model above its range", "[hand]", "[parameter_tolerance]\n\"force_law.c_kgf\" = -1\n[hand]", "-1 must be above 0",
       44},
      {"tolerance of the robot's own in the wrong place", "[hand]", "[parameter_tolerance]\n\"lever.lever_mm\" = 0.1\n[hand]",
       "write tolerance into [parameter.lever_mm]", 44},
      {"two tolerances of one name", "[hand]", "[parameter_tolerance]\n\"force_law.a\" = 0.1\nforce_law.a = 0.2\n[hand]", "given once"},
      {"start of another kind", "[hand]", "[start]\nstate = \"hanging\"\n[hand]", "built, settled"},
  };
  return all;
}

class WrongDescription : public testing::TestWithParam<Wrong> {};

TEST_P(WrongDescription, EndsWithFileLineAndWhatIsAllowed) {
  const std::string text = replaced(GetParam().from, GetParam().to);
  try {
    Built built(text);
    FAIL() << "accepted:\n" << text;
  } catch (const BadFile& error) {
    EXPECT_EQ(error.file(), "lever.toml");
    EXPECT_TRUE(contains(error.what(), GetParam().message)) << error.what();
    EXPECT_GT(error.line(), 0) << error.what();
    if (GetParam().line > 0) {
      EXPECT_EQ(error.line(), GetParam().line) << error.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(RobotFile, WrongDescription, testing::ValuesIn(wrongDescriptions()));

TEST(RobotFile, ThereAreAtLeastThirtyWrongDescriptions) {
  EXPECT_GE(wrongDescriptions().size(), 30U);
}

/// All bodies and beads after some steps, to the bit.
std::vector<double> poses(const std::function<Robot&(Simulation&)>& build, PhysicsKind physics, const std::string& muscle) {
  SimulationOptions options;
  options.physics = physics;
  options.parameters.setFromText("muscle.model=" + muscle, "test");
  Simulation simulation(std::move(options));
  Robot& robot = build(simulation);
  const auto count = static_cast<std::size_t>(robot.actuatorCount());
  simulation.start(robot.initialState(), Action(count, 0.3));
  Action action(count);
  for (std::size_t i = 0; i < count; ++i) action[i] = 0.1 * static_cast<double>(1 + i % 9);
  robot.step(action);
  for (int i = 0; i < 20; ++i) simulation.step();
  std::vector<double> all = robot.signalValues(robot.getState());
  for (const auto& body : simulation.world().bodies())
    for (int i = 0; i < 3; ++i) all.push_back(dBodyGetPosition(body->id)[i]);
  return all;
}

TEST(RobotFile, TheArmsFileBuildsTheSameArm) {
  for (const PhysicsKind physics : {PhysicsKind::si, PhysicsKind::original})
    for (const char* muscle : {"chain", "line"}) {
      const auto written = [](Simulation& s) -> Robot& {
        return s.build([](World& world) { return makeRobotFromText(roboticArmFile(), "arm.toml", world); });
      };
      EXPECT_EQ(poses([](Simulation& s) -> Robot& { return s.build("arm"); }, physics, muscle), poses(written, physics, muscle)) << muscle;
    }
}

TEST(RobotFile, ShippedRobotsCanBeReadFromTheirTexts) {
  EXPECT_EQ(shippedRobots().size(), 5U);
  for (const ShippedRobot& robot : shippedRobots()) {
    EXPECT_FALSE(robot.description.empty()) << robot.name;
    const auto fromText = [&](Simulation& s) -> Robot& {
      return s.build([&](World& world) { return makeRobotFromText(robot.text, robot.name + ".toml", world); });
    };
    EXPECT_EQ(poses([&](Simulation& s) -> Robot& { return s.build(robot.name); }, PhysicsKind::si, "chain"),
              poses(fromText, PhysicsKind::si, "chain"))
        << robot.name;
  }
}

TEST(RobotFile, ParametersOfShippedRobotsThatCannotBeAreTheCallersMistake) {
  SimulationOptions options;
  options.parameters.setFromText("elbow.forearm_inertia_kgm2=1e-6", "test");
  Simulation simulation(std::move(options));
  const auto message = messageOf<BadParameter>([&] { simulation.build("elbow"); });
  EXPECT_TRUE(contains(message, "moments of inertia of forearm")) << message;
}

TEST(RobotFile, IsReadAgainWhenItHasChanged) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("musclesim_robot_file_test_" + std::to_string(getpid()) + ".toml")).string();
  const auto massOf = [&](const std::string& text) {
    std::ofstream(file) << text;
    Simulation simulation;
    return simulation.build(file).hand()->massG();
  };
  EXPECT_NEAR(massOf(lever), 400, 1e-9);
  EXPECT_NEAR(massOf(replaced("mass_g = 400", "mass_g = 1400")), 1400, 1e-9);
  EXPECT_EQ(nameOfRobotFile(file), "lever");
  Simulation simulation;
  const Robot& robot = simulation.build(file);
  EXPECT_EQ(robot.name(), "lever");
  EXPECT_EQ(robot.descriptionFile(), file);
  EXPECT_EQ(robot.descriptionHash().size(), 16U);
  std::filesystem::remove(file);
}

TEST(RobotFile, AFileThatIsNotThereIsAnInputOutputError) {
  Simulation simulation;
  EXPECT_THROW(simulation.build("nowhere/lever.toml"), IoError);
}

TEST(RobotFile, FixedJointsMakeOneBody) {
  Built built(replaced("[[pulley]]", R"([[body]]
name = "weight"
at_mm = [100, 0, 0]
shape = { type = "cylinder", radius_mm = 10, length_mm = 40 }
density_g_per_mm3 = 0.0078

[[joint]]
name = "weld"
type = "fixed"
body = "weight"
to = "bar"

[[pulley]])"));
  EXPECT_EQ(built.simulation.world().bodies().size(), 1U);
  dMass mass;
  dBodyGetMass(built.robot->hand()->body().id, &mass);
  EXPECT_NEAR(mass.mass, 400 + 0.0078 * 3.14159265 * 100 * 40, 1e-3);
}

TEST(RobotFile, InertiaAndCentreOfMassCanBeGiven) {
  Built built(replaced("mass_g = 400", "mass_g = 400\ninertia_g_mm2 = [2e4, 1e6, 1e6, 10, 20, 30]\ncenter_of_mass_mm = [10, 0, 0]"));
  dMass mass;
  dBodyGetMass(built.robot->hand()->body().id, &mass);
  EXPECT_NEAR(mass.I[0], 2e4, 1e-9);
  EXPECT_NEAR(mass.I[1], 10, 1e-9);
  EXPECT_NEAR(mass.I[2], 20, 1e-9);
  EXPECT_NEAR(mass.I[6], 30, 1e-9);
  EXPECT_NEAR(built.robot->hand()->getPosition().x(), 10, 1e-9);
  EXPECT_NEAR(dGeomGetPosition(built.robot->hand()->geom())[0], 0, 1e-9) << "the shape stays";
  EXPECT_NEAR(built.robot->getState().hand_mm->x(), 100, 1e-9);
}

TEST(RobotFile, MusclesHaveLawsPathsAndTendonsOfTheirOwn) {
  Built built(replaced("length_mm = [150, 320]\nmodel = \"line\"",
                       "length_mm = [100, 320]\nmodel = \"line\"\npath = [{ pulley = \"drum\", side_mm = [20, -100, 0] }]\ntendon_mm = 50\n"
                       "force_law = { name = \"chou-hannaford\", bore_N = 700 }"));
  const Actuator& right = *built.robot->actuators()[0];
  EXPECT_EQ(right.forceLaw().name(), "chou-hannaford");
  EXPECT_EQ(built.robot->actuators()[1]->forceLaw().name(), "braun");
  // From (80, -260) around the left side of a drum of radius 10 about (40, -100) to (80, -10).
  const double lower = std::sqrt(40. * 40 + 160 * 160 - 100), upper = std::sqrt(40. * 40 + 90 * 90 - 100);
  const double turn = std::atan2(40, 160) + std::atan2(40, 90) + std::asin(10 / std::hypot(40., 160)) + std::asin(10 / std::hypot(40., 90));
  EXPECT_NEAR(right.lengthMm(), lower + upper + 10 * turn - 50, 1e-6);
}

TEST(RobotFile, LinearActuatorsPullByAnExpression) {
  Built built(replaced("[hand]", R"toml([[actuator]]
from = { body = "world", at_mm = [0, 250, 0] }
to = { body = "bar", at_mm = [50, 10, 0] }
length_mm = [0, 500]
force_N = "10 * p + 0.5 * max(0, l_mm - lever_mm)"

[hand])toml"));
  const Actuator& actuator = *built.robot->actuators()[2];
  EXPECT_NEAR(actuator.calculateForce(0.5, 180), 5 + 50, 1e-12);
}

/// Lines before chains in one robot: the steppers must not take a bead of one muscle for that of another.
TEST(RobotFile, LinesAndChainsMoveAlikeUnderBothSteppers) {
  std::vector<std::vector<double>> ends;
  for (const StepperKind stepper : {StepperKind::chain, StepperKind::ode}) {
    SimulationOptions options;
    options.stepper = stepper;
    options.parameters.setFromText("muscle.slider_friction_N=0", "test");
    options.parameters.setFromText("muscle.hinge_friction_Nm=0", "test");
    std::string text = lever;
    const auto second = text.find("name = \"left\"");
    text.replace(text.find("model = \"line\"", second), 14, "model = \"chain\"");
    Built built(text, std::move(options));
    built.simulation.start("built", {0.2, 0.4});
    for (int i = 0; i < 20; ++i) built.simulation.step();
    ends.push_back(built.robot->signalValues(built.robot->getState()));
  }
  for (std::size_t i = 0; i < ends[0].size(); ++i) EXPECT_NEAR(ends[0][i], ends[1][i], 1e-6 * (1 + std::abs(ends[1][i])));
}

}  // namespace
}  // namespace musclesim
