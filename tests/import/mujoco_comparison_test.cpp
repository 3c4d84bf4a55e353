/// Robots that were imported from MJCF against MuJoCo itself: lengths and moment arms of muscles, and falls.
#include <mujoco/mujoco.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fall.h"
#include "import_fixture.h"
#include "musclesim/base/file.h"
#include "musclesim/base/random.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/primitive.h"

namespace musclesim {
namespace {

/// A model with its data in the other program.
class Mujoco {
 public:
  explicit Mujoco(const std::string& file) {
    char error[1000] = "";
    model_ = mj_loadXML(file.c_str(), nullptr, error, sizeof error);
    if (!model_) throw std::runtime_error(error);
    data_ = mj_makeData(model_);
    mj_forward(model_, data_);
  }
  ~Mujoco() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  Mujoco(const Mujoco&) = delete;
  Mujoco& operator=(const Mujoco&) = delete;
  mjModel& model() { return *model_; }
  mjData& data() { return *data_; }
  int joint(const std::string& name) const { return mj_name2id(model_, mjOBJ_JOINT, name.c_str()); }
  double angleDeg(const std::string& name) const { return data_->qpos[model_->jnt_qposadr[joint(name)]] * deg_per_rad; }

 private:
  mjModel* model_;
  mjData* data_;
};

Eigen::Matrix3d toTarget() {
  return (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
}

Vector centerMm(const mjData& data, int body) {
  return mm_per_m * toTarget() * Eigen::Vector3d(data.xipos + 3 * body);
}

Eigen::Matrix3d rotationOf(const mjData& data, int body) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.xmat + 9 * body);
}

/// Bodies of a simulation that the other program has under the name of the body or of its geom; they follow its poses.
class Puppets {
 public:
  Puppets(Simulation& simulation, Mujoco& mujoco) : mujoco_(mujoco) {
    for (Primitive* primitive : simulation.world().primitives()) {
      int body = mj_name2id(&mujoco.model(), mjOBJ_BODY, primitive->name().c_str());
      if (const int geom = mj_name2id(&mujoco.model(), mjOBJ_GEOM, primitive->name().c_str()); body < 0 && geom >= 0)
        body = mujoco.model().geom_bodyid[geom];
      if (body > 0) puppets_.push_back({primitive, body, primitive->getRotation(), rotationOf(mujoco.data(), body)});
    }
  }
  std::size_t count() const { return puppets_.size(); }
  void follow() {
    for (const Puppet& puppet : puppets_) {
      const Eigen::Matrix3d turn = rotationOf(mujoco_.data(), puppet.body) * puppet.built_there.transpose();
      puppet.primitive->place(centerMm(mujoco_.data(), puppet.body), toTarget() * turn * toTarget().transpose() * puppet.built);
    }
  }

 private:
  struct Puppet {
    Primitive* primitive;
    int body;
    Eigen::Matrix3d built, built_there;
  };
  Mujoco& mujoco_;
  std::vector<Puppet> puppets_;
};

class MujocoComparison : public ImportedRobotTest {
 protected:
  void SetUp() override {
    ImportedRobotTest::SetUp();
    folder_of_robots_ = sharedFolder() / "data" / "robots";
    if (!std::filesystem::exists(folder_of_robots_ / "arm26.xml")) GTEST_SKIP() << folder_of_robots_ << " is not there";
  }
  std::string source(const std::string& name) const { return readTextFile((folder_of_robots_ / name).string(), 1 << 20); }

  /// The largest difference of the reported angles over a fall of 1 s, in degrees; the widest angle goes to widest_deg_.
  double fallDifferenceDeg(const std::string& text, int substeps = 100, double constraint_force_mixing = usual) {
    const std::string file = write("fall.xml", text);
    importFile(file);
    Mujoco mujoco(file);
    mujoco.model().opt.timestep = 1e-4;
    mujoco.model().opt.integrator = mjINT_RK4;
    mujoco.model().opt.disableflags |= mjDSBL_CONTACT;
    const auto simulation = simulationOf(robot_, substeps, constraint_force_mixing);
    const auto& angles = simulation->robot().angles();
    double worst_deg = 0;
    widest_deg_ = 0;
    fall(*simulation, [&](double until_s, const std::vector<double>& angle_deg) {
      while (mujoco.data().time < until_s - 0.5e-4) mj_step(&mujoco.model(), &mujoco.data());
      for (std::size_t i = 0; i < angles.size(); ++i) {
        worst_deg = std::max(worst_deg, std::abs(angle_deg[i] - mujoco.angleDeg(angles[i].name)));
        widest_deg_ = std::max(widest_deg_, std::abs(angle_deg[i]));
      }
    });
    RecordProperty("worst_deg", std::to_string(worst_deg));
    return worst_deg;
  }

  std::filesystem::path folder_of_robots_;
  double widest_deg_ = 0;
};

TEST_F(MujocoComparison, LengthsAndMomentArmsOfTheArmAgreeInAnyPose) {
  const std::string file = write("arm.xml", replaced(source("arm26.xml"), "upper arm", "upper_arm"));
  importFile(file);
  const auto simulation = simulationOf(robot_);
  Robot& robot = simulation->robot();
  Mujoco mujoco(file);
  Puppets puppets(*simulation, mujoco);
  ASSERT_EQ(puppets.count(), 2U);
  const auto lengths = [&](double shoulder_rad, double elbow_rad) {
    mujoco.data().qpos[0] = shoulder_rad;
    mujoco.data().qpos[1] = elbow_rad;
    mj_forward(&mujoco.model(), &mujoco.data());
    puppets.follow();
    std::vector<double> lengths_mm;
    for (const Actuator* muscle : robot.actuators()) lengths_mm.push_back(muscle->lengthMm());
    return lengths_mm;
  };
  RandomStream random(1, "test");
  double worst_mm = 0, worst_mm_per_rad = 0;
  for (int pose = 0; pose < 1000; ++pose) {
    const double q[2] = {random.uniform(0, 120 * rad_per_deg), random.uniform(0, 120 * rad_per_deg)};
    for (int joint = 0; joint < 2; ++joint) {
      constexpr double h_rad = 1e-5;
      const auto more = lengths(q[0] + (joint == 0 ? h_rad : 0), q[1] + (joint == 1 ? h_rad : 0));
      const auto less = lengths(q[0] - (joint == 0 ? h_rad : 0), q[1] - (joint == 1 ? h_rad : 0));
      const auto here = lengths(q[0], q[1]);
      for (int muscle = 0; muscle < 6; ++muscle) {
        worst_mm = std::max(worst_mm, std::abs(here[muscle] - mm_per_m * mujoco.data().ten_length[muscle]));
        worst_mm_per_rad = std::max(
            worst_mm_per_rad, std::abs((more[muscle] - less[muscle]) / (2 * h_rad) - mm_per_m * mujoco.data().ten_J[2 * muscle + joint]));
      }
    }
  }
  RecordProperty("worst_mm", std::to_string(worst_mm));
  RecordProperty("worst_mm_per_rad", std::to_string(worst_mm_per_rad));
  EXPECT_LT(worst_mm, 0.05);
  EXPECT_LT(worst_mm_per_rad, 0.05);
}

/// Takes <tendon> and <actuator> out.
std::string withoutMuscles(std::string text) {
  const std::size_t begin = text.find("<tendon>"), end = text.find("</actuator>");
  return text.erase(begin, end + std::string("</actuator>").size() - begin);
}

TEST_F(MujocoComparison, TheFallOfTheTwoLinkArmAgrees) {
  // Its hinges are vertical: turn its plane up, or it does not fall.
  std::string text = replaced(withoutMuscles(source("arm26.xml")), "limited=\"true\" range=\"0 120\"", "");
  text = replaced(text, "<body pos=\"0 0 0\">", "<body pos=\"0 0 0\" euler=\"70 0 10\">");
  EXPECT_LT(fallDifferenceDeg(text), 0.2);
  EXPECT_GT(widest_deg_, 60);
}

/// The file names meshes that are not there. The importer takes cubes of their mass; so both programs get these cubes here.
std::string withCubes(std::string text) {
  const std::size_t assets = text.find("<asset>"), end = text.find("</asset>");
  text.erase(assets, end + std::string("</asset>").size() - assets);
  for (std::size_t at = text.find("type = \"mesh\""); at != std::string::npos; at = text.find("type = \"mesh\"", at + 1)) {
    const std::size_t mass_at = text.find("mass=\"", at) + 6;
    const double half_m = std::cbrt(std::stod(text.substr(mass_at)) / 1000) / 2;
    const std::size_t mesh = text.find("mesh=\"", at);
    text.erase(mesh, text.find('"', mesh + 6) + 1 - mesh);
    text.replace(at, std::string("type = \"mesh\"").size(),
                 "type=\"box\" size=\"" + std::to_string(half_m) + " " + std::to_string(half_m) + " " + std::to_string(half_m) + "\"");
  }
  return text;
}

TEST_F(MujocoComparison, MusclesWithCablesChangeTheirLengthsAsTheCablesDo) {
  const std::string file = write("arm.xml", withCubes(source("pamy.xml")));
  importFile(file);
  Mujoco mujoco(file);
  const auto simulation = simulationOf(robot_);
  Puppets puppets(*simulation, mujoco);
  ASSERT_GE(puppets.count(), 4U);
  const auto& muscles = simulation->robot().actuators();
  ASSERT_EQ(muscles.size(), 8U);
  std::vector<double> built_mm, built_there_mm;
  for (int i = 0; i < 8; ++i) {
    built_mm.push_back(muscles[i]->lengthMm());
    built_there_mm.push_back(mm_per_m * mujoco.data().ten_length[i]);
  }
  RandomStream random(2, "test");
  double worst_mm = 0, widest_mm = 0;
  for (int pose = 0; pose < 1000; ++pose) {
    for (const char* joint : {"joint_base_rotation", "dof2", "dof3", "dof4"})
      mujoco.data().qpos[mujoco.model().jnt_qposadr[mujoco.joint(joint)]] = random.uniform(-89, 89) * rad_per_deg;
    mj_forward(&mujoco.model(), &mujoco.data());
    puppets.follow();
    for (int i = 0; i < 8; ++i) {
      const double change_mm = mm_per_m * mujoco.data().ten_length[i] - built_there_mm[i];
      worst_mm = std::max(worst_mm, std::abs(muscles[i]->lengthMm() - built_mm[i] - change_mm));
      widest_mm = std::max(widest_mm, std::abs(change_mm));
    }
  }
  RecordProperty("worst_mm", std::to_string(worst_mm));
  EXPECT_LT(worst_mm, 0.05);
  EXPECT_GT(widest_mm, 50);
}

/// Takes an attribute out everywhere.
std::string without(std::string text, const std::string& attribute) {
  for (std::size_t at = text.find(attribute); at != std::string::npos; at = text.find(attribute, at))
    text.erase(at, text.find('"', text.find('"', at) + 1) + 1 - at);
  return text;
}

/// The four-joint arm of the file without muscles, limits and air.
std::string fourJoints(std::string text) {
  text = replaced(withCubes(withoutMuscles(std::move(text))), "limited=\"true\"", "limited=\"false\"");
  return replaced(without(without(text, "solreffriction"), "solimpfriction"), "density=\"1.2\"", "density=\"0\"");
}

// It starts upright and folds up near the axis of its first joint, which makes much of small differences: half a degree would be left
// with 0.1 ms steps.
constexpr int fine_substeps = 400;

TEST_F(MujocoComparison, TheFallOfTheFourJointArmAgrees) {
  EXPECT_LT(fallDifferenceDeg(without(fourJoints(source("pamy.xml")), "frictionloss"), fine_substeps, hard), 0.2);
  EXPECT_GT(widest_deg_, 60);
}

/// The other program's friction creeps by default; with these numbers it hardly does.
std::string withHardFriction(const std::string& text) {
  return replaced(text, "frictionloss", "solreffriction=\"0.0002 1\" solimpfriction=\"0.9999 0.9999 0.001\" frictionloss");
}

TEST_F(MujocoComparison, FrictionHoldsTheFourJointArmInBothPrograms) {
  EXPECT_LT(fallDifferenceDeg(withHardFriction(fourJoints(source("pamy.xml"))), 100, hard), 0.2);
  EXPECT_LT(widest_deg_, 0.2);
}

TEST_F(MujocoComparison, TheFallOfTheFourJointArmAgreesWithLittleFriction) {
  std::string text = fourJoints(source("pamy.xml"));
  for (const auto& [given, little] : {std::pair("114.0189", "0.1"), {"111.0899", "0.5"}, {"7.7682", "0.3"}, {"111.9529", "0.05"}})
    text = replaced(text, given, little);
  EXPECT_LT(fallDifferenceDeg(withHardFriction(text), fine_substeps, hard), 0.2);
  EXPECT_GT(widest_deg_, 20);
}

/// Bodies of every shape, one with a part beside it, under compilers that change masses.
class MassComparison : public MujocoComparison, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override { ImportedRobotTest::SetUp(); }
};

TEST_P(MassComparison, MassesAndMomentsAgree) {
  const char* const geoms[] = {R"(type="sphere" size="0.1")",
                               R"(type="capsule" size="0.05" fromto="0 0 0 0.3 0.1 0.2" density="300")",
                               R"(type="capsule" size="0.05 0.2" euler="10 20 30")",
                               R"(type="cylinder" size="0.1 0.05" mass="2" axisangle="1 2 3 40")",
                               R"(type="cylinder" size="0.1" fromto="0.1 0 0 0.3 0.1 0.2")",
                               R"(type="box" size="0.1 0.2 0.3" pos="1 2 3" xyaxes="1 1 0 0 0 1")",
                               R"(type="box" size="0.1 0.2" fromto="0 0 0 0.3 0.1 0.2")",
                               R"(type="box" size="0.1" fromto="0 0 0 0.3 0.1 0.2")",
                               R"(type="ellipsoid" size="0.1 0.2 0.3" zaxis="1 2 3")",
                               R"(type="ellipsoid" size="0.1 0.05" fromto="0 0 0 0.3 0.1 0.2")",
                               R"(type="box" size="0.1 0.2 0.3"/><geom type="sphere" size="0.1" pos="0.5 0.5 0" group="3")",
                               R"(size="0.05"/><inertial pos="0.1 0.2 0.3" mass="2" diaginertia="0.01 0.02 0.025" euler="10 20 30")"};
  std::string bodies;
  for (std::size_t i = 0; i < std::size(geoms); ++i)
    bodies += "<body name=\"b" + std::to_string(i) + "\" pos=\"0.1 0.2 0.3\" euler=\"5 6 7\"><freejoint/><geom " + geoms[i] + "/></body>";
  const std::string file =
      write("masses.xml", std::string("<mujoco><compiler ") + GetParam() + "/><worldbody>" + bodies + "</worldbody></mujoco>");
  importFile(file);
  Mujoco mujoco(file);
  for (std::size_t i = 0; i < std::size(geoms); ++i) {
    const std::string name = "b" + std::to_string(i);
    const int body = mj_name2id(&mujoco.model(), mjOBJ_BODY, name.c_str());
    const auto entry = find("body", name);
    EXPECT_NEAR(number(entry, "mass_g") / (g_per_kg * mujoco.model().body_mass[body]), 1, 1e-9) << geoms[i];
    const Vector center_mm = centerMm(mujoco.data(), body);
    expectNear(entry, entry.contains("center_of_mass_mm") ? "center_of_mass_mm" : "at_mm", {center_mm.x(), center_mm.y(), center_mm.z()});
    auto m = numbers(entry, "inertia_g_mm2");
    m.resize(6, 0);
    Eigen::Matrix3d inertia;
    inertia << m[0], m[3], m[4], m[3], m[1], m[5], m[4], m[5], m[2];
    const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
    Eigen::Vector3d there = g_mm2_per_kg_m2 * Eigen::Vector3d(mujoco.model().body_inertia + 3 * body);
    std::sort(there.data(), there.data() + 3);
    EXPECT_LT((moments - there).norm(), 1e-6 * there.norm()) << geoms[i] << "\n" << moments.transpose() << "\n" << there.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Compilers, MassComparison,
                         testing::Values("", "inertiagrouprange=\"0 2\"", "boundmass=\"30\" boundinertia=\"0.5\"", "settotalmass=\"7\"",
                                         "inertiafromgeom=\"true\"", "coordinate=\"global\"", "eulerseq=\"ZYx\"",
                                         "angle=\"radian\" balanceinertia=\"true\""));

TEST_F(MujocoComparison, LimitsApplyInTheSameCases) {
  const auto compare = [&](const std::string& compiler, const std::string& joint) {
    const std::string file = write("limits.xml", "<mujoco>" + compiler + "<worldbody><body><joint name=\"j\" " + joint +
                                                     "/><geom size=\"0.1\"/></body></worldbody></mujoco>");
    importFile(file);
    Mujoco mujoco(file);
    const auto limits = numbers(find("joint", "j"), "limits_deg");
    ASSERT_EQ(limits.size(), mujoco.model().jnt_limited[0] ? 2U : 0U) << compiler << joint;
    for (std::size_t i = 0; i < limits.size(); ++i) EXPECT_NEAR(limits[i], mujoco.model().jnt_range[i] * deg_per_rad, 1e-9);
  };
  const std::string automatic = "<compiler autolimits=\"true\"/>";
  for (const std::string& compiler : {std::string(), automatic, std::string("<compiler angle=\"radian\"/>")})
    for (const char* joint : {"limited=\"true\" range=\"-1 2\"", "limited=\"false\" range=\"-1 2\"", ""}) compare(compiler, joint);
  for (const char* joint : {"range=\"-1 2\"", "limited=\"auto\" range=\"-1 2\""}) compare(automatic, joint);
}

/// A rod whose centre of mass lies off all axes, on several joints.
std::string rod(const std::string& joints) {
  return "<mujoco><worldbody><body name=\"rod\">" + joints +
         "<geom type=\"capsule\" size=\"0.02\" fromto=\"0.1 0.05 -0.1 0.4 0.1 0.1\"/></body></worldbody></mujoco>";
}

/// Angles of the joints x and y while the rod falls: those of the universal joint y_x in the robot.
TEST_F(MujocoComparison, TwoHingesFallAsAUniversalJoint) {
  const std::string file = write("rod.xml", rod("<joint name=\"x\" axis=\"1 0 0\"/><joint name=\"y\" axis=\"0 1 0\"/>"));
  importFile(file);
  Mujoco mujoco(file);
  mujoco.model().opt.timestep = 1e-4;
  mujoco.model().opt.integrator = mjINT_RK4;
  const auto simulation = simulationOf(robot_, 100, hard);
  double worst_deg = 0, widest_deg = 0;
  fall(*simulation, [&](double until_s, const std::vector<double>& angle_deg) {
    if (until_s > 0.3) return;  // the angles of a universal joint are singular where y is 90 degrees
    while (mujoco.data().time < until_s - 0.5e-4) mj_step(&mujoco.model(), &mujoco.data());
    worst_deg = std::max({worst_deg, std::abs(angle_deg[0] - mujoco.angleDeg("y")), std::abs(angle_deg[1] - mujoco.angleDeg("x"))});
    widest_deg = std::max(widest_deg, std::min(std::abs(angle_deg[0]), std::abs(angle_deg[1])));
  });
  EXPECT_EQ(simulation->robot().angles()[0].name, "y_x_1");
  EXPECT_LT(worst_deg, 0.2);
  EXPECT_GT(widest_deg, 5);
}

TEST_F(MujocoComparison, LimitsOfAUniversalJointActOnTheRightSide) {
  const std::string file = write("rod.xml", rod("<joint name=\"x\" axis=\"1 0 0\" limited=\"true\" range=\"-30 20\" damping=\"0\"/>"
                                                "<joint name=\"y\" axis=\"0 1 0\" limited=\"true\" range=\"-25 15\"/>"));
  importFile(file);
  Mujoco mujoco(file);
  const auto simulation = simulationOf(robot_, 100, hard);
  double low[2] = {0, 0}, high[2] = {0, 0}, low_there[2] = {0, 0}, high_there[2] = {0, 0};
  fall(*simulation, [&](double until_s, const std::vector<double>& angle_deg) {
    while (mujoco.data().time < until_s) mj_step(&mujoco.model(), &mujoco.data());
    const double there[2] = {mujoco.angleDeg("y"), mujoco.angleDeg("x")};
    for (int i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], angle_deg[i]), high[i] = std::max(high[i], angle_deg[i]);
      low_there[i] = std::min(low_there[i], there[i]), high_there[i] = std::max(high_there[i], there[i]);
    }
  });
  // The rod bounces off the stops of y, -25 and 15 degrees, and of x, -30 and 20; those of the other program give way by some degrees.
  const double stops[2][2] = {{-25, 15}, {-30, 20}};
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(low[i], std::max(low_there[i], stops[i][0]), 1) << i;
    EXPECT_NEAR(high[i], std::min(high_there[i], stops[i][1]), 1) << i;
  }
}

TEST_F(MujocoComparison, SeriesOfJointsWithCarriersFallAlike) {
  // Damping keeps the two hinges from being one universal joint; the slider would keep them so, too.
  const std::string file =
      write("rod.xml", rod("<joint name=\"s\" type=\"slide\" axis=\"1 0 1\"/><joint name=\"x\" axis=\"1 0 0\" damping=\"0.05\"/>"
                           "<joint name=\"y\" axis=\"0 1 0\" pos=\"0.05 0 0\" damping=\"0.03\"/>"));
  EXPECT_LT(fallDifferenceDeg(readTextFile(file, 1 << 20), 100, hard), 0.2);
  EXPECT_GT(widest_deg_, 20);
}

}  // namespace
}  // namespace musclesim
