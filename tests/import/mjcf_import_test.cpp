#include <Eigen/Geometry>
#include <cmath>

#include "import_fixture.h"

namespace musclesim {
namespace {

using MjcfImport = ImportedRobotTest;

std::string replacedOnce(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

std::string world(const std::string& bodies, const std::string& before = "", const std::string& after = "") {
  return "<mujoco model=\"m\">" + before + "<worldbody>" + bodies + "</worldbody>" + after + "</mujoco>";
}

std::string box(const std::string& joints, const std::string& more = "") {
  return "<body name=\"b\" pos=\"0 0 1\"><geom type=\"box\" size=\"0.1 0.2 0.3\" mass=\"3\"/>" + joints + more + "</body>";
}

TEST_F(MjcfImport, TakesGeomsAsSolids) {
  import(
      world("<body name=\"arm\" pos=\"1 2 3\"><joint name=\"j\" axis=\"0 1 0\" damping=\"0.1\"/>"
            "<geom type=\"capsule\" size=\"0.05\" fromto=\"0 0 0 0.4 0 0\" density=\"500\"/></body>"));
  const auto arm = find("body", "arm");
  expectNear(arm, "at_mm", {1200, 3000, -2000});
  const auto& shape = *arm["shape"].as_table();
  EXPECT_EQ(text(shape, "type"), "capsule");
  EXPECT_NEAR(number(shape, "length_mm"), 400, 1e-9);
  EXPECT_NEAR(number(arm, "mass_g"), 500e3 * M_PI * (0.0025 * 0.4 + 4.0 / 3 * 0.000125), 1e-6);
  EXPECT_FALSE(arm.contains("center_of_mass_mm"));
  const auto moments = numbers(arm, "inertia_g_mm2");
  EXPECT_NEAR(moments[0], moments[1], 1e-6 * moments[0]);
  EXPECT_LT(moments[2], 0.2 * moments[0]);
  const auto joint = find("joint", "j");
  expectNear(joint, "at_mm", {1000, 3000, -2000});
  expectNear(joint, "axis", {0, 0, -1});
  EXPECT_NEAR(number(joint, "damping_Nms_per_rad"), 0.1, 1e-12);
}

TEST_F(MjcfImport, AppliesDefaultsByClass) {
  import(
      world("<body name=\"b\" childclass=\"thick\"><joint name=\"j\"/><geom name=\"g\" mass=\"1\"/>"
            "<body name=\"c\" pos=\"1 0 0\"><joint name=\"k\" class=\"main\"/><geom class=\"thin\" mass=\"1\"/></body></body>",
            "<default><joint axis=\"1 0 0\" limited=\"true\" range=\"-10 10\"/><geom type=\"sphere\" size=\"0.1\"/>"
            "<default class=\"thick\"><joint range=\"-20 20\"/><geom size=\"0.2\"/><default class=\"thin\"><geom size=\"0.3\"/></default>"
            "</default></default>"));
  expectNear(find("joint", "j"), "limits_deg", {-20, 20});
  expectNear(find("joint", "k"), "limits_deg", {-10, 10});
  expectNear(find("joint", "j"), "axis", {1, 0, 0});
  EXPECT_EQ(number(*find("body", "b")["shape"].as_table(), "radius_mm"), 200);
  EXPECT_EQ(number(*find("body", "c")["shape"].as_table(), "radius_mm"), 300);
}

TEST_F(MjcfImport, ReadsOrientationsInTheirWays) {
  // All of them turn the box's long edge, along z, to y: a turn of -90 degrees about x.
  for (const char* orientation :
       {"quat=\"1 -1 0 0\"", "axisangle=\"1 0 0 -90\"", "euler=\"-90 0 0\"", "zaxis=\"0 1 0\"", "xyaxes=\"1 0 0 0 0 -1\""}) {
    import(world("<body name=\"b\"><joint name=\"j\"/><geom type=\"box\" size=\"0.1 0.2 0.3\" " + std::string(orientation) + "/></body>"));
    const auto body = find("body", "b");
    // In the target the turn is a half turn about x: -90 degrees of the file and -90 degrees of the frames.
    const auto& turn = *body["rotate_deg"][0].as_array();
    EXPECT_NEAR(std::abs(turn[0].value_or(0.0)), 180, 1e-6) << orientation;
    EXPECT_EQ(turn[1].value_or(std::string()), "x") << orientation;
  }
  import(world("<body name=\"b\"><joint name=\"j\"/><geom type=\"box\" size=\"0.1 0.2 0.3\" euler=\"0.3 0.2 0.1\"/></body>",
               "<compiler angle=\"radian\" eulerseq=\"XYZ\"/>"));
  const Eigen::Matrix3d expected =
      (Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const auto body = find("body", "b");
  const auto& turn = *body["rotate_deg"][0].as_array();
  const auto& axis = *turn[1].as_array();
  const Eigen::AngleAxisd found(turn[0].value_or(0.0) * M_PI / 180,
                                Eigen::Vector3d(axis[0].value_or(0.0), axis[1].value_or(0.0), axis[2].value_or(0.0)));
  EXPECT_NEAR((found.toRotationMatrix() - expected).norm(), 0, 1e-9);
}

TEST_F(MjcfImport, GlobalCoordinatesAreThoseOfTheWorld) {
  import(world(
      "<body name=\"b\" pos=\"0 0 1\"><joint name=\"j\" pos=\"0 0 1\"/><geom type=\"sphere\" size=\"0.1\" pos=\"0 0 1\"/>"
      "<body name=\"c\" pos=\"0 0 2\"><joint name=\"k\" pos=\"0 0 2\"/><geom type=\"sphere\" size=\"0.1\" pos=\"0 0 2.5\"/></body></body>",
      "<compiler coordinate=\"global\"/>"));
  expectNear(find("joint", "k"), "at_mm", {0, 2000, 0});
  expectNear(find("body", "c"), "at_mm", {0, 2500, 0});
}

TEST_F(MjcfImport, FollowsTheCompilersRulesForInertia) {
  const std::string inertial = "<joint name=\"j\"/><inertial pos=\"0 0 0.5\" mass=\"7\" fullinertia=\"3 4 5 0.1 0.2 0.3\"/>";
  import(world(box(inertial)));
  EXPECT_EQ(number(find("body", "b"), "mass_g"), 7000);
  expectNear(find("body", "b"), "inertia_g_mm2", {3e9, 4e9, 5e9, 1e8, 2e8, 3e8}, 1);
  expectNear(find("body", "b"), "center_of_mass_mm", {0, 1500, 0});
  import(world(box(inertial), "<compiler inertiafromgeom=\"true\"/>"));
  EXPECT_EQ(number(find("body", "b"), "mass_g"), 3000);
  EXPECT_TRUE(hasNote("inertia from its geoms"));
  EXPECT_TRUE(contains(refusal(world(box("<joint/>"), "<compiler inertiafromgeom=\"false\"/>")), "must have <inertial>"));
  import(world(box("<joint/>"), "<compiler boundmass=\"5\" settotalmass=\"10\"/>"));
  EXPECT_EQ(number(find("body", "b"), "mass_g"), 10000);
}

TEST_F(MjcfImport, LimitsCountFromTheReferencePosition) {
  import(world(box("<joint name=\"j\" limited=\"true\" range=\"20 60\" ref=\"30\" stiffness=\"2\" springref=\"50\"/>")));
  expectNear(find("joint", "j"), "limits_deg", {-10, 30});
  EXPECT_NEAR(number(find("joint", "j"), "rest_deg"), 20, 1e-9);
  import(world(box("<joint name=\"j\" range=\"20 60\"/>")));
  EXPECT_FALSE(find("joint", "j").contains("limits_deg"));
  EXPECT_TRUE(hasNote("joint j: its range is no limit"));
  import(world(box("<joint name=\"j\" range=\"-20 60\"/>"), "<compiler autolimits=\"true\"/>"));
  expectNear(find("joint", "j"), "limits_deg", {-20, 60});
}

TEST_F(MjcfImport, SeveralJointsOfABody) {
  import(world(box("<joint name=\"x\" axis=\"1 0 0\" range=\"-30 40\" limited=\"true\"/><joint name=\"y\" axis=\"0 1 0\"/>")));
  const auto universal = find("joint", "y_x");
  EXPECT_EQ(text(universal, "type"), "universal");
  expectNear(universal, "axis", {0, 0, -1});  // y, fixed to the body
  expectNear(universal, "axis2", {1, 0, 0});  // x, fixed to the world
  expectNear(universal, "limits2_deg", {-30, 40});
  expectNear(universal, "limits_deg", {-175, 175});
  import(world(box("<joint name=\"x\" axis=\"1 0 0\"/><joint name=\"y\" axis=\"0 1 0\"/><joint name=\"z\" axis=\"0 0 1\"/>")));
  EXPECT_EQ(text(find("joint", "x_y_z"), "type"), "ball");
  EXPECT_TRUE(hasNote("one ball joint, x_y_z, without limits"));
  import(world(box("<joint name=\"x\" axis=\"1 0 0\" damping=\"1\"/><joint name=\"y\" axis=\"0 1 0\"/>")));
  EXPECT_EQ(text(find("joint", "x"), "body"), "b_carrier_0");
  EXPECT_EQ(text(find("joint", "y"), "to"), "b_carrier_0");
  EXPECT_NEAR(number(find("body", "b"), "mass_g") + number(find("body", "b_carrier_0"), "mass_g"), 3000, 1e-9);
  import(world(box("<freejoint/>")));
  EXPECT_TRUE(find("body", "b")["free"].value_or(false));
}

TEST_F(MjcfImport, ArmatureAtTheWorldIsInertia) {
  import(world(box("<joint name=\"j\" axis=\"0 0 1\" armature=\"2\"/>",
                   "<body name=\"c\"><joint name=\"k\" armature=\"3\"/><geom size=\"0.1\"/></body>")));
  const double solid = 3.0 / 12 * (0.2 * 0.2 + 0.4 * 0.4);
  EXPECT_NEAR(numbers(find("body", "b"), "inertia_g_mm2")[2], (solid + 2) * 1e9, 1);
  EXPECT_FALSE(hasNote("joint j: its armature"));
  EXPECT_TRUE(hasNote("joint k: its armature 3"));
}

/// An arm about y with a pulley at its hinge and a tendon from the world to the arm.
std::string pulled(const std::string& path, const std::string& actuators) {
  return world(
      "<site name=\"start\" pos=\"-0.3 0 0.2\"/><site name=\"above\" pos=\"0 0 0.2\"/>"
      "<body name=\"arm\"><joint name=\"j\" axis=\"0 1 0\" limited=\"true\" range=\"-60 60\"/>"
      "<geom name=\"rod\" type=\"capsule\" size=\"0.02\" fromto=\"0 0 0 0.4 0 0\"/>"
      "<geom name=\"drum\" type=\"cylinder\" size=\"0.05 0.02\" zaxis=\"0 1 0\" mass=\"0\"/><geom name=\"ball\" size=\"0.04\" mass=\"0\"/>"
      "<site name=\"end\" pos=\"0.3 0 0.03\"/><site name=\"inside\" pos=\"0 0 0.01\"/><site name=\"up\" pos=\"0 0 0.1\"/></body>",
      "",
      "<tendon><spatial name=\"t\" rgba=\"1 0 0 1\" width=\"0.01\">" + path + "</spatial></tendon><actuator>" + actuators + "</actuator>");
}

constexpr const char* around = "<site site=\"start\"/><geom geom=\"drum\" sidesite=\"up\"/><site site=\"end\"/>";
constexpr const char* motor = "<motor name=\"m\" tendon=\"t\"/>";

TEST_F(MjcfImport, DrivenTendonsBecomeMuscles) {
  import(pulled(around, motor));
  const auto muscle = find("muscle", "t");
  expectNear(*muscle["from"].as_table(), "at_mm", {-300, 200, 0});
  expectNear(*muscle["to"].as_table(), "at_mm", {300, 30, 0});
  EXPECT_EQ(text(*muscle["to"].as_table(), "body"), "arm");
  const auto& station = *muscle["path"][0].as_table();
  EXPECT_EQ(text(station, "pulley"), "drum");
  expectNear(station, "side_mm", {0, 100, 0});
  const auto drum = find("pulley", "drum");
  expectNear(drum, "axis", {0, 0, -1});
  EXPECT_EQ(number(drum, "radius_mm"), 50);
  EXPECT_EQ(text(drum, "body"), "arm");
  expectNear(muscle, "color", {1, 0, 0});
  EXPECT_TRUE(hasNote("force laws"));
}

TEST_F(MjcfImport, RangesOfMusclesCoverTheJointsLimits) {
  import(pulled(around, motor));
  // At +60 and -60 degrees the end is at 60 degrees below and above the horizontal (right-handed about y: x goes to -z).
  const auto range = numbers(find("muscle", "t"), "length_mm");
  const double a = std::hypot(300, 200), b = std::hypot(300, 30), r = 50;
  const double from = std::atan2(200, -300), end = std::atan2(30, 300);
  const auto length = [&](double turn) {
    const double to = end - turn, arc = from - to - std::acos(r / a) - std::acos(r / b);
    return arc > 0 ? std::sqrt(a * a - r * r) + std::sqrt(b * b - r * r) + r * arc
                   : std::hypot(a * std::cos(from) - b * std::cos(to), a * std::sin(from) - b * std::sin(to));
  };
  EXPECT_NEAR(range[0], 0.98 * length(-M_PI / 3), 1e-6);
  EXPECT_NEAR(range[1], 1.02 * length(M_PI / 3), 1e-6);
  import(pulled(around, "<muscle name=\"m\" tendon=\"t\" lengthrange=\"0.4 0.9\"/>"));
  expectNear(find("muscle", "t"), "length_mm", {400, 900});
  import(pulled(around, "<muscle name=\"m\" tendon=\"t\" lengthrange=\"0.1 0.2\"/>"));
  EXPECT_TRUE(hasNote("muscle t: its range 100 .. 200 mm became"));
}

TEST_F(MjcfImport, LeavesOutPulleysThatCannotBeWrapped) {
  import(pulled("<site site=\"start\"/><geom geom=\"drum\" sidesite=\"inside\"/><site site=\"end\"/>", motor));
  EXPECT_EQ(count("pulley"), 0U);
  EXPECT_TRUE(hasNote("pulley drum is left out of its path: its side point lies inside"));
  import(pulled("<site site=\"start\"/><geom geom=\"ball\"/><site site=\"inside\"/><site site=\"end\"/>", motor));
  EXPECT_TRUE(hasNote("pulley ball is left out of its path: a point of the muscle next to it lies inside"));
  import(pulled("<site site=\"start\"/><geom geom=\"ball\"/><site site=\"end\"/>", motor));
  EXPECT_FALSE(find("pulley", "ball").contains("axis"));
}

TEST_F(MjcfImport, SaysWhatItLeavesOut) {
  import(pulled("<site site=\"start\"/><site site=\"end\"/>", "<position name=\"servo\" joint=\"j\"/>"));
  EXPECT_EQ(count("muscle"), 0U);
  EXPECT_TRUE(hasNote("actuator servo: <position> on joint j is not taken over"));
  EXPECT_TRUE(hasNote("tendon t: it has no effect"));
  import(world("<geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/><camera name=\"eye\"/>" +
                   box("<joint/>", "<geom type=\"mesh\" mesh=\"cup\" mass=\"0.008\"/>"),
               "<option gravity=\"0 0 -1.6\" timestep=\"0.001\"/>",
               "<equality><weld body1=\"b\"/></equality><sensor><gyro name=\"s\"/></sensor>"));
  EXPECT_TRUE(hasNote("geom floor: a plane"));
  EXPECT_TRUE(hasNote("<camera> eye"));
  EXPECT_TRUE(hasNote("the mesh cup is not taken over; it counts as a cube"));
  EXPECT_NEAR(number(find("body", "b"), "mass_g"), 3008, 1e-9);
  EXPECT_TRUE(hasNote("gravity (0, 0, -1.6)"));
  EXPECT_TRUE(hasNote("<option>: timestep"));
  EXPECT_TRUE(hasNote("<weld> b"));
  EXPECT_TRUE(hasNote("<gyro> s"));
}

TEST_F(MjcfImport, PassiveStraightTendonsBecomeSprings) {
  const std::string text = pulled("<site site=\"start\"/><site site=\"end\"/>", "");
  const std::string::size_type at = text.find("width");
  import(text.substr(0, at) + "stiffness=\"500\" damping=\"2\" springlength=\"0.4\" " + text.substr(at));
  const auto spring = find("spring", "t");
  EXPECT_EQ(number(spring, "stiffness_N_per_mm"), 0.5);
  EXPECT_EQ(number(spring, "rest_mm"), 400);
  EXPECT_EQ(number(spring, "damping_Ns_per_m"), 2);
}

TEST_F(MjcfImport, ReadsIncludedFiles) {
  write("part.xml", "<mujocoinclude><body name=\"p\"><joint name=\"j\"/><geom size=\"0.1\"/></body></mujocoinclude>");
  import(world("<include file=\"part.xml\"/>"));
  find("body", "p");
  write("part.xml", "<mujocoinclude>\n<body name=\"p\"><joint type=\"cog\"/></body></mujocoinclude>");
  EXPECT_TRUE(contains(refusal(world("<include file=\"part.xml\"/>")), "part.xml:2: <joint>: type = \"cog\""));
  write("part.xml", "<mujocoinclude><include file=\"part.xml\"/></mujocoinclude>");
  EXPECT_TRUE(contains(refusal(world("<include file=\"part.xml\"/>")), "is included twice"));
}

TEST_F(MjcfImport, RefusesWhatItCannotRead) {
  EXPECT_TRUE(contains(refusal(world("<body name=\"b\"><joint/></body>")), "body b: it can move and has no mass"));
  EXPECT_TRUE(contains(refusal(world(box("<joint class=\"none\"/>"))), "class = \"none\": there is no such class"));
  EXPECT_TRUE(contains(refusal(world(box("<joint axis=\"0 0 0\"/>"))), "axis: must have a direction"));
  EXPECT_TRUE(contains(refusal(world(box("<joint limited=\"maybe\"/>"))), "must be true, false or auto"));
  EXPECT_TRUE(contains(refusal(world(box("<joint/>", "<geom type=\"box\" size=\"1 1\"/>"))), "size: must be 3 positive numbers"));
  EXPECT_TRUE(contains(refusal(world(box("<joint/>", "<geom type=\"torus\" size=\"1 1\"/>"))), "type = \"torus\""));
  EXPECT_TRUE(contains(refusal(world(box("<joint/>", "<frame/>"))), "<frame>: cannot be taken over"));
  EXPECT_TRUE(contains(refusal(world(box("<joint/>", "<body name=\"c\"><freejoint/></body>"))), "must belong to a body of the world"));
  EXPECT_TRUE(contains(refusal(pulled("<site site=\"start\"/><site site=\"nowhere\"/>", motor)), "there is no such site"));
  EXPECT_TRUE(
      contains(refusal(pulled("<site site=\"start\"/><geom geom=\"rod\"/><site site=\"end\"/>", motor)), "must be a sphere or a cylinder"));
  EXPECT_TRUE(contains(refusal(pulled("<geom geom=\"drum\"/><site site=\"end\"/>", motor)), "must begin and end with a site"));
  import(pulled("<site site=\"start\"/><pulley divisor=\"2\"/><site site=\"start\"/><site site=\"end\"/>", motor));
  EXPECT_TRUE(hasNote("tendon t: it branches"));
}

/// A bead on a slider that an actuator drives, a cable from it over a drum to an arm, and a line that shows where the muscle is.
TEST_F(MjcfImport, DrivenSlidersWithCablesBecomeMuscles) {
  const std::string bodies =
      "<site name=\"post\" pos=\"-0.8 0 0.05\"/><body name=\"bead\" pos=\"-0.3 0 0.05\"><joint name=\"stroke\" type=\"slide\" axis=\"1 0 "
      "0\"/>"
      "<geom size=\"0.01\"/><site name=\"bead\"/></body>"
      "<body name=\"arm\"><joint name=\"j\" axis=\"0 1 0\" limited=\"true\" range=\"-60 60\"/>"
      "<geom type=\"capsule\" size=\"0.02\" fromto=\"0 0 0 0.4 0 0\"/><geom name=\"drum\" type=\"cylinder\" size=\"0.05 0.02\" zaxis=\"0 1 "
      "0\"/>"
      "<site name=\"end\" pos=\"0.1 0 0.03\"/></body>";
  const std::string tendons =
      "<tendon><spatial name=\"cable\" stiffness=\"1e5\"><site site=\"bead\"/><geom geom=\"drum\"/><site site=\"end\"/></spatial>"
      "<spatial name=\"line\"><site site=\"bead\"/><site site=\"post\"/></spatial></tendon>"
      "<actuator><general name=\"pam\" joint=\"stroke\"/></actuator>";
  import(world(bodies, "", tendons));
  EXPECT_EQ(count("body"), 1U);
  EXPECT_EQ(count("joint"), 1U);
  EXPECT_EQ(count("spring"), 0U);
  const auto muscle = find("muscle", "pam");
  expectNear(*muscle["from"].as_table(), "at_mm", {-800, 50, 0});
  expectNear(*muscle["path"][0].as_table(), "at_mm", {-300, 50, 0});
  EXPECT_EQ(text(*muscle["path"][1].as_table(), "pulley"), "drum");
  // The muscle has the length of its own line as built; the cable has the rest.
  const double path_mm = 500 + std::hypot(300, 50) + std::hypot(100, 30);
  EXPECT_NEAR(number(muscle, "tendon_mm"), path_mm - 500, 30);
  const auto range = numbers(muscle, "length_mm");
  EXPECT_LT(range[0], 500 * 0.98 - 20);
  EXPECT_GT(range[1], 500 * 1.02 + 20);
  EXPECT_TRUE(hasNote("muscle pam: stands for body bead on its slider stroke"));
  // Without the line the muscle begins at the bead and has no cable.
  import(world(bodies, "", replacedOnce(tendons, "<spatial name=\"line\"><site site=\"bead\"/><site site=\"post\"/></spatial>", "")));
  EXPECT_FALSE(find("muscle", "pam").contains("tendon_mm"));
  expectNear(*find("muscle", "pam")["from"].as_table(), "at_mm", {-300, 50, 0});
}

TEST_F(MjcfImport, ReadsTheArmsOfAnotherProgram) {
  const auto folder = sharedFolder() / "data" / "robots";
  if (!std::filesystem::exists(folder / "arm26.xml")) GTEST_SKIP() << folder << " is not there";
  importFile((folder / "arm26.xml").string());
  EXPECT_EQ(count("muscle"), 6U);
  EXPECT_EQ(count("pulley"), 4U);
  EXPECT_EQ(count("joint"), 2U);
  importFile((folder / "pamy.xml").string());
  find("joint", "dof4");
  EXPECT_EQ(count("muscle"), 8U);
}

}  // namespace
}  // namespace musclesim
