/// The command `robot`.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

class RobotCommand : public testing::Test {
 protected:
  RobotCommand() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~RobotCommand() override { fs::remove_all(folder_); }

  ProgramResult run(const std::vector<std::string>& arguments) { return runProgram(arguments, folder_); }
  std::string text(const std::string& name) const {
    std::ostringstream all;
    all << std::ifstream(folder_ / name).rdbuf();
    return all.str();
  }
  void change(const std::string& name, const std::string& from, const std::string& to) {
    std::string all = text(name);
    const auto place = all.find(from);
    ASSERT_NE(place, std::string::npos) << from;
    std::ofstream(folder_ / name) << all.replace(place, from.size(), to);
  }

  fs::path folder_ = fs::temp_directory_path() / ("musclesim_robot_test_" + std::to_string(getpid()));
};

TEST_F(RobotCommand, NewWritesAFileThatRuns) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  const auto checked = run({"robot", "check", "lever.toml"});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_TRUE(contains(checked.out, "1 bodies, 1 joints with a reported angle, 2 muscles")) << checked.out;
  EXPECT_TRUE(contains(checked.out, "nothing odd found")) << checked.out;
  EXPECT_TRUE(contains(checked.out, "tolerances for a diagnosis: ")) << checked.out;
  const auto ran = run({"run", "--simple", "--robot", "lever.toml", "--duration", "0.5", "--record", "data/lever.csv"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(contains(text("data/lever.json"), "\"robot\": \"../lever.toml\""));
  const auto replayed = run({"replay", "data/lever.csv"});
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_FALSE(contains(replayed.err, "its text has changed")) << replayed.err;
  change("lever.toml", "a lever between two muscles", "another lever");
  EXPECT_TRUE(contains(run({"replay", "data/lever.csv"}).err, "its text has changed"));
}

TEST_F(RobotCommand, CheckTellsTolerancesOfNoUse) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  change("lever.toml", "# tolerance = 0.02", "tolerance = 0.02");
  const std::string of_bar = run({"robot", "check", "lever.toml"}).out;
  EXPECT_TRUE(contains(of_bar, "nothing odd found")) << of_bar;
  change("lever.toml", "[[body]]",
         "[parameter.spare_kg]\nvalue = 1\nrange = [0.5, 2]\nmeaning = \"of a bar in the drawer\"\ntolerance = 0.1\n\n[[body]]");
  const std::string of_spare = run({"robot", "check", "lever.toml"}).out;
  EXPECT_TRUE(contains(of_spare, "odd: lever.spare_kg changes nothing in a short motion: its tolerance may be of no use")) << of_spare;
}

TEST_F(RobotCommand, NewDoesNotWriteOverAFile) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  const auto again = run({"robot", "new", "lever"});
  EXPECT_EQ(again.status, 2);
  EXPECT_TRUE(contains(again.err, "lever.toml")) << again.err;
  EXPECT_EQ(run({"robot", "new", "muscle"}).status, 2) << "a group of the program's parameters";
}

TEST_F(RobotCommand, NewTakesTheNameOfAFile) {
  ASSERT_EQ(run({"robot", "new", "lever.toml"}).status, 0);
  const auto checked = run({"robot", "check", "lever.toml"});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_TRUE(contains(checked.out, "lever")) << checked.out;
}

TEST_F(RobotCommand, CheckSaysWhatIsOdd) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  change("lever.toml", "length_mm = [150, 320]", "length_mm = [150, 260]");
  change("lever.toml", "[hand]", R"([[body]]
name = "block"
at_mm = [0, 15, 0]
shape = { type = "box", size_mm = [20, 20, 20] }
mass_g = 10
fixed = true

[hand])");
  const auto checked = run({"robot", "check", "lever.toml"});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_TRUE(contains(checked.out, "odd: right would be")) << checked.out;
  EXPECT_TRUE(contains(checked.out, "longer than its longest length, 260 mm")) << checked.out;
  EXPECT_TRUE(contains(checked.out, "odd: bar and block overlap by 5 mm")) << checked.out;
}

TEST_F(RobotCommand, CheckNamesAMuscleThatPullsTooHard) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  change("lever.toml", "name = \"left\"", R"(force_law = { name = "chou-hannaford", braid_N = 418000, bore_N = 164000 }
name = "left")");
  const std::string out = run({"robot", "check", "lever.toml"}).out;
  EXPECT_TRUE(contains(out, "odd: left pulls with ")) << out;
  EXPECT_FALSE(contains(out, "odd: right pulls with ")) << out;
}

TEST_F(RobotCommand, CheckLooksAtSlides) {
  ASSERT_EQ(run({"robot", "export", "rig", "-o", "rig.toml"}).status, 0);
  const auto as_shipped = run({"robot", "check", "rig.toml"});
  EXPECT_FALSE(contains(as_shipped.out, "guide")) << as_shipped.out;
  change("rig.toml", "type = \"slider\"", "type = \"slider\"\nlimits_mm = [-300, 50]");
  const auto limited = run({"robot", "check", "rig.toml"});
  EXPECT_TRUE(contains(limited.out, "mm long at guide = -300 mm, longer than its longest length")) << limited.out;
  change("rig.toml", "axis = \"y\"", "axis = \"z\"");
  const auto across = run({"robot", "check", "rig.toml"});
  EXPECT_TRUE(contains(across.out, "no muscle moves guide: none pulls along it")) << across.out;
}

TEST_F(RobotCommand, CheckNamesAnInertiaOfMassFarAway) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  change("lever.toml", "mass_g = \"bar_kg * 1000\"", "mass_g = 0.4\ninertia_g_mm2 = [1e5, 1.5e6, 1.5e6]");
  const std::string out = run({"robot", "check", "lever.toml"}).out;
  EXPECT_TRUE(contains(out,
                       "bar has the moment of inertia of a mass 1.94e+03 mm away from its centre (its radius of gyration), but its shape "
                       "ends at 101 mm"))
      << out;
}

TEST_F(RobotCommand, CheckNamesConstantsThatHoldUnsaid) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  const auto checkedWith = [&](const std::string& old, const std::string& law) {
    change("lever.toml", old, law + "name = \"left\"");
    return run({"robot", "check", "lever.toml"}).out;
  };
  const std::string some = R"(force_law = { name = "chou-hannaford", braid_N = 418, bore_N = 164, threshold_N = 5 }
)";
  const std::string out = checkedWith("name = \"left\"", some);
  EXPECT_TRUE(contains(out, "odd: the force law of left does not say all its constants; those of another muscle hold: stretch_N = 49.39"))
      << out;
  EXPECT_TRUE(contains(out, "friction within the muscles: 1 N (muscle.slider_friction_N")) << out;
  const std::string all =
      R"(force_law = { name = "chou-hannaford", braid_N = 418, bore_N = 164, threshold_N = 5, stretch_N = 0, stretch_exponent = 1 }
)";
  EXPECT_TRUE(contains(checkedWith(some + "name = \"left\"", all), "nothing odd found"));
}

TEST_F(RobotCommand, CheckEndsWithStatus3AndTheLineOfWhatIsWrong) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  change("lever.toml", "type = \"hinge\"", "type = \"hnige\"");
  const auto checked = run({"robot", "check", "lever.toml"});
  EXPECT_EQ(checked.status, 3);
  EXPECT_TRUE(contains(checked.err, "lever.toml:")) << checked.err;
  EXPECT_TRUE(contains(checked.err, "did you mean \"hinge\"")) << checked.err;
}

TEST_F(RobotCommand, CheckRefusesATolerancesNameThatTheModelDoesNotHave) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  change("lever.toml", "[hand]", "[parameter_tolerance]\n\"muscle.slider_friktion_N\" = 0.5\n\n[hand]");
  const auto checked = run({"robot", "check", "lever.toml"});
  EXPECT_EQ(checked.status, 3);
  EXPECT_TRUE(contains(checked.err, "did you mean \"muscle.slider_friction_N\"")) << checked.err;
  change("lever.toml", "slider_friktion_N", "slider_friction_N");
  EXPECT_EQ(run({"robot", "check", "lever.toml"}).status, 0);
}

TEST_F(RobotCommand, ShowPrintsTheTreeAndDrawsMomentArms) {
  const auto shown = run({"robot", "show", "elbow", "--out", "picture"});
  if (contains(shown.err, "cannot draw") || contains(shown.err, "OSMesa")) GTEST_SKIP() << shown.err;
  EXPECT_EQ(shown.status, 0) << shown.err;
  EXPECT_TRUE(contains(shown.out, "forearm (hinge elbow, -70 .. 70 deg)")) << shown.out;
  EXPECT_TRUE(contains(shown.out, "600 g")) << shown.out;
  EXPECT_TRUE(fs::exists(folder_ / "picture.png"));
  EXPECT_TRUE(contains(text("picture-moment-arms.svg"), "moment arm [mm]"));
}

TEST_F(RobotCommand, ShowListsSprings) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  change("lever.toml", "[hand]", R"([[spring]]
from = { body = "bar", at_mm = [100, 0, 0] }
to = { body = "world", at_mm = [100, -200, 0] }
stiffness_N_per_mm = 2
rest_mm = 150

[hand])");
  const auto shown = run({"robot", "show", "lever.toml"});
  if (contains(shown.err, "cannot draw") || contains(shown.err, "OSMesa")) GTEST_SKIP() << shown.err;
  EXPECT_TRUE(contains(shown.out, "spring: 200 mm as built, 150 mm at rest, 2 N/mm: 100 N as built")) << shown.out;
}

TEST_F(RobotCommand, ExportedRobotsCanBeUsed) {
  for (const std::string name : {"arm", "rig", "elbow", "wrist", "pulley_arm", "spring_bench"}) {
    const auto exported = run({"robot", "export", name, "-o", name + ".toml"});
    EXPECT_EQ(exported.status, 0) << exported.err;
    const auto checked = run({"robot", "check", name + ".toml"});
    EXPECT_EQ(checked.status, 0) << checked.err;
  }
  EXPECT_EQ(run({"robot", "export", "nobody"}).status, 2);
}

/// A tenth too heavy, damped so that the misfit has one valley: the number is found within its interval, and nothing is left to explain.
TEST_F(RobotCommand, DiagnoseTunesANumberOfAFile) {
  ASSERT_EQ(run({"robot", "new", "lever"}).status, 0);
  change("lever.toml", "at_mm = [0, 0, 0]      ", "at_mm = [60, 0, 0]      ");
  change("lever.toml", "# damping_Nms_per_rad = 0.01", "damping_Nms_per_rad = 0.3");
  for (const std::string seed : {"1", "2"}) {
    const auto ran = run({"run",
                          "--simple",
                          "--quiet",
                          "--robot",
                          "lever.toml",
                          "--muscle",
                          "line",
                          "--controller",
                          "random",
                          "--decision-interval",
                          "0.5",
                          "--duration",
                          "3",
                          "--seed",
                          seed,
                          "--substeps",
                          "5",
                          "--set",
                          "lever.bar_kg=0.44",
                          "--record",
                          "r" + seed + ".csv"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    std::ofstream(folder_ / ("r" + seed + ".json")) << R"({"format": "musclesim-recording-1", "robot": "lever.toml"})";
  }
  const auto found =
      run({"diagnose", "r1.csv", "r2.csv", "--muscle", "line", "--substeps", "5", "--tune", "lever.bar_kg", "--out", "answer", "--quiet"});
  ASSERT_EQ(found.status, 0) << found.err;
  const auto answer = nlohmann::json::parse(text("answer/diagnosis.json"));
  EXPECT_EQ(answer.at("verdict"), "no_gap") << found.out;
  const auto& tuned = answer.at("tuned").at(0);
  EXPECT_EQ(tuned.at("name"), "lever.bar_kg");
  EXPECT_NEAR(tuned.at("value").get<double>(), 0.44, 1e-4);
  EXPECT_LE(tuned.at("ci95").at(0).get<double>(), 0.44);
  EXPECT_GE(tuned.at("ci95").at(1).get<double>(), 0.44);
}

/// Three known loads, one lagging valve: "varies" allows to diagnose them together.
TEST_F(RobotCommand, RecordingsUnderDifferentKnownLoadsAreDiagnosedTogether) {
  std::ofstream(folder_ / "lag.json") << R"({"format": "musclesim-effects-1", "effects": [{"id": "valve_lag", "component": "all",
    "parameters": {"fill_time_constant_s": 0.05, "vent_time_constant_s": 0.1}}]})";
  const auto writeSidecar = [&](const std::string& load, const std::string& more) {
    std::ofstream(folder_ / ("r" + load + ".json"))
        << R"({"format": "musclesim-recording-1", "robot": "rig", "robot_parameters": {"load_kg": )" << load << "}" << more << "}";
  };
  for (const std::string load : {"1", "2", "3"}) {
    const auto ran = run({"run",
                          "--simple",
                          "--quiet",
                          "--robot",
                          "rig",
                          "--muscle",
                          "line",
                          "--controller",
                          "random",
                          "--decision-interval",
                          "0.5",
                          "--duration",
                          "3",
                          "--seed",
                          load,
                          "--effects",
                          "lag.json",
                          "--set",
                          "rig.load_kg=" + load,
                          "--record",
                          "r" + load + ".csv"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    writeSidecar(load, "");
  }
  const std::vector<std::string> diagnose = {"diagnose", "r1.csv", "r2.csv", "r3.csv", "--muscle", "line", "--out", "answer", "--quiet"};
  const auto refused = run(diagnose);
  EXPECT_EQ(refused.status, 3);
  EXPECT_TRUE(contains(refused.err, "varies")) << refused.err;
  for (const std::string load : {"1", "2", "3"}) writeSidecar(load, R"(, "varies": ["load_kg"])");
  const auto found = run(diagnose);
  ASSERT_EQ(found.status, 0) << found.err;
  EXPECT_TRUE(contains(found.out, "valve_lag@muscle_0")) << found.out;
  std::vector<std::string> tuned = diagnose;
  tuned.insert(tuned.end(), {"--tune", "rig.load_kg"});
  EXPECT_EQ(run(tuned).status, 2) << "a number that varies cannot be tuned";
}

TEST_F(RobotCommand, ImportsAnArmThatFalls) {
  std::ofstream(folder_ / "arm.urdf") << R"(<robot name="arm"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0 -0.1"/><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.001" ixy="0" ixz="0" iyz="0"/>
</inertial></link><joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>)";
  const auto imported = run({"robot", "import", "arm.urdf"});
  if (contains(imported.err, "built without")) GTEST_SKIP() << imported.err;
  ASSERT_EQ(imported.status, 0) << imported.err;
  const auto checked = run({"robot", "check", "arm.toml"});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_TRUE(contains(checked.out, "odd: there is no muscle")) << checked.out;
  EXPECT_EQ(run({"robot", "import", "nothing.urdf"}).status, 5);
}

TEST_F(RobotCommand, PluginsBringRobots) {
  const auto ran = run({"run", "--plugin", MUSCLESIM_PLUGIN, "--simple", "--robot", "pendulum", "--duration", "0.5", "--record", "p.csv"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(contains(text("p.csv"), "angle_pendulum_deg"));
  std::ofstream(folder_ / "nothing.so") << "no library";
  const auto broken = run({"run", "--plugin", "nothing.so", "--simple"});
  EXPECT_EQ(broken.status, 3) << broken.err;
  EXPECT_TRUE(contains(broken.err, "nothing.so")) << broken.err;
}

}  // namespace
}  // namespace musclesim
