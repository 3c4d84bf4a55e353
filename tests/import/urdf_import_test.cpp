#include <fmt/format.h>

#include "import_fixture.h"

namespace musclesim {
namespace {

using UrdfImport = ImportedRobotTest;

/// Two links; the second stands on the first, turned a quarter about z.
std::string twoLinks(const std::string& joint, const std::string& more = "") {
  return R"(<?xml version="1.0"?><!-- a <robot> of two links -->
<robot name="two links">
  <link name="base"/>
  <link name="upper">
    <inertial><origin xyz="0 0 0.1"/><mass value="2"/><inertia ixx="0.02" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="0 0 0.1"/><geometry><cylinder radius="0.02" length="0.2"/></geometry></visual>
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.04 0.05 0.2"/></geometry></collision>
  </link>
  <link name="lower">
    <inertial><origin xyz="0.1 0 0"/><mass value="0.5"/><inertia ixx="0.001" iyy="0.002" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><sphere radius="0.03"/></geometry><material name="red"><color rgba="1 0 0 1"/></material></visual>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0.1 0.2 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="5" velocity="6"/><dynamics damping="0.05" friction="0.1"/>
  </joint>
  <joint name="elbow" )" +
         joint + R"(<parent link="upper"/><child link="lower"/><origin xyz="0 0 0.2" rpy="0 0 1.5707963267948966"/></joint>)" + more +
         "</robot>";
}

const char* const hinge = R"(type="continuous"><axis xyz="0 1 0"/>)";

TEST_F(UrdfImport, TurnsFramesAndUnits) {
  import(twoLinks(hinge));
  const auto shoulder = find("joint", "shoulder"), elbow = find("joint", "elbow"), upper = find("body", "upper"),
             lower = find("body", "lower");
  expectNear(shoulder, "at_mm", {100, 300, -200});
  expectNear(shoulder, "axis", {0, 0, -1});
  expectNear(shoulder, "limits_deg", {-180 / M_PI, 360 / M_PI});
  EXPECT_EQ(text(shoulder, "to"), "world");
  EXPECT_NEAR(number(shoulder, "friction_Nm"), 0.1, 1e-12);
  EXPECT_NEAR(number(shoulder, "damping_Nms_per_rad"), 0.05, 1e-12);
  expectNear(elbow, "at_mm", {100, 500, -200});
  expectNear(elbow, "axis", {-1, 0, 0});
  expectNear(upper, "at_mm", {100, 400, -200});
  expectNear(upper, "inertia_g_mm2", {2e7, 3e7, 1e7});
  EXPECT_EQ(number(upper, "mass_g"), 2000);
  expectNear(lower, "at_mm", {100, 500, -200});
  expectNear(lower, "center_of_mass_mm", {100, 500, -300});
  expectNear(lower, "color", {1, 0, 0});
}

TEST_F(UrdfImport, DrawsWhatTouchesAndSaysWhatIsLeftOut) {
  import(twoLinks(hinge, "<transmission name=\"drive\"/><gazebo reference=\"upper\"/>"));
  EXPECT_EQ(text(*find("body", "upper")["shape"].as_table(), "type"), "box");
  EXPECT_TRUE(find("body", "upper")["collides"].value_or(false));
  EXPECT_FALSE(find("body", "lower")["collides"].value_or(true));
  EXPECT_TRUE(hasNote("shoulder: limits of effort 5 and velocity 6"));
  EXPECT_TRUE(hasNote("<transmission> \"drive\""));
  EXPECT_TRUE(hasNote("<gazebo> \"upper\""));
  EXPECT_TRUE(contains(robot_.toml, "# - <transmission>"));
}

TEST_F(UrdfImport, FixedLinksBecomeOneBody) {
  import(twoLinks("type=\"fixed\">"));
  EXPECT_EQ(count("body"), 1U);
  EXPECT_EQ(count("joint"), 1U);
  const auto upper = find("body", "upper");
  EXPECT_NEAR(number(upper, "mass_g"), 2500, 1e-9);
  // 2 kg at z = 0.1 and 0.5 kg at (0, 0.1, 0.2), the second turned a quarter.
  expectNear(upper, "center_of_mass_mm", {100, 420, -220});
  const double steiner = 2 * 0.5 / 2.5;
  expectNear(upper, "inertia_g_mm2",
             {(0.022 + steiner * 0.02) * 1e9, (0.031 + steiner * 0.01) * 1e9, (0.012 + steiner * 0.01) * 1e9, 0, 0, -steiner * 0.01 * 1e9},
             1e-3);
  EXPECT_EQ(upper["part"].as_array()->size(), 1U);
  EXPECT_TRUE(hasNote("lower: a part of body upper"));
}

TEST_F(UrdfImport, BuildsWithinLimitsThatExcludeZero) {
  import(twoLinks(R"(type="revolute"><axis xyz="0 1 0"/><limit lower="1.5707963267948966" upper="2"/>)"));
  const auto elbow = find("joint", "elbow");
  expectNear(elbow, "limits_deg", {0, (2 - M_PI / 2) * 180 / M_PI});
  // A quarter about the joint's axis, (-1, 0, 0) in the source: from (0, 0.1, 0) to (0, 0, -0.1).
  expectNear(find("body", "lower"), "center_of_mass_mm", {100, 400, -200});
  EXPECT_TRUE(hasNote("elbow: 0 lies outside of its limits 90 deg .. 114.6 deg; it is built at 90 deg"));
}

TEST_F(UrdfImport, DropsLimitsThatStopsCannotHave) {
  import(twoLinks(R"(type="revolute"><axis xyz="0 1 0"/><limit lower="-3.14" upper="3.14"/>)"));
  EXPECT_FALSE(find("joint", "elbow").contains("limits_deg"));
  EXPECT_TRUE(hasNote("elbow: no limits"));
}

TEST_F(UrdfImport, WritesSlidersFloatingAndPlanarJoints) {
  import(twoLinks(R"(type="prismatic"><axis xyz="0 0 1"/><limit lower="-0.1" upper="0.2"/><dynamics friction="3" damping="4"/>)"));
  const auto slider = find("joint", "elbow");
  EXPECT_EQ(text(slider, "type"), "slider");
  expectNear(slider, "limits_mm", {-100, 200});
  EXPECT_EQ(number(slider, "friction_N"), 3);
  EXPECT_EQ(number(slider, "damping_Ns_per_m"), 4);
  import(twoLinks("type=\"floating\">"));
  EXPECT_TRUE(find("body", "lower")["free"].value_or(false));
  EXPECT_EQ(count("joint"), 1U);
  import(twoLinks("type=\"planar\"><axis xyz=\"0 0 1\"/>"));
  EXPECT_EQ(count("joint"), 4U);
  EXPECT_NEAR(number(find("body", "lower"), "mass_g") + number(find("body", "lower_carrier_0"), "mass_g") +
                  number(find("body", "lower_carrier_1"), "mass_g"),
              500, 1e-9);
}

TEST_F(UrdfImport, MeshesAreDrawnAsTheBoxWithTheirInertia) {
  import(R"(<robot name="m"><link name="world"/><link name="a"><inertial><mass value="6"/>
    <inertia ixx="0.13" iyy="0.1" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="a.stl"/></geometry></visual></link>
    <joint name="j" type="continuous"><parent link="world"/><child link="a"/></joint></robot>)");
  auto size = numbers(*find("body", "a")["shape"].as_table(), "size_mm");
  std::sort(size.begin(), size.end());
  const std::vector<double> expected{std::sqrt(0.02) * 1e3, std::sqrt(0.08) * 1e3, std::sqrt(0.18) * 1e3};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(size[i], expected[i], 1e-6);
  EXPECT_TRUE(hasNote("a: a mesh is not taken over"));
}

TEST_F(UrdfImport, RepairsInertiaThatNoBodyHas) {
  import(R"(<robot name="m"><link name="a"/><link name="b"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.05"/></inertial></link><link name="c"><inertial><mass value="1"/></inertial></link>
    <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
    <joint name="k" type="continuous"><parent link="a"/><child link="c"/></joint></robot>)");
  expectNear(find("body", "b"), "inertia_g_mm2", {4e7, 4e7, 8e7});
  EXPECT_TRUE(hasNote("body b: its moments of inertia are raised by 0.03"));
  EXPECT_TRUE(hasNote("body c: a moment of inertia is not positive"));
}

TEST_F(UrdfImport, HoldsARootWithMass) {
  import(R"(<robot name="m"><link name="a"><inertial><mass value="1"/></inertial>
    <visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>)");
  EXPECT_TRUE(find("body", "a")["fixed"].value_or(false));
  EXPECT_TRUE(hasNote("link a: the root is fixed"));
}

TEST_F(UrdfImport, RefusesWhatItCannotRead) {
  EXPECT_TRUE(contains(refusal("<robot><link name=\"a\"></robot>"), "not well-formed XML"));
  EXPECT_TRUE(contains(refusal("<robot/>"), "has no link"));
  EXPECT_TRUE(contains(refusal("<model/>"), "the outermost element is \"model\""));
  EXPECT_TRUE(contains(refusal("<robot><link/></robot>"), "must have a name"));
  EXPECT_TRUE(contains(refusal("<robot><link name=\"a\"/><link name=\"a\"/></robot>"), "another link \"a\""));
  EXPECT_TRUE(contains(refusal(twoLinks("type=\"screw\">")), "type = \"screw\""));
  EXPECT_TRUE(contains(refusal(twoLinks("type=\"revolute\">")), "must have a <limit>"));
  EXPECT_TRUE(contains(refusal(twoLinks("type=\"continuous\"><axis xyz=\"0 1\"/>")), "xyz = \"0 1\": must be 3 numbers"));
  EXPECT_TRUE(contains(refusal(twoLinks("type=\"continuous\"><axis xyz=\"0 1 nan\"/>")), "must be finite numbers"));
  EXPECT_TRUE(contains(refusal(twoLinks("type=\"continuous\"><axis xyz=\"0 1 0\"/><dynamics friction=\"-1\"/>")), "must not be negative"));
  const std::string from_lower = R"(<joint name="back" type="fixed"><parent link="lower"/><child link=")";
  EXPECT_TRUE(contains(refusal(twoLinks(hinge, from_lower + "upper\"/></joint>")), "\"upper\" is the child of two joints"));
  EXPECT_TRUE(contains(refusal(twoLinks(hinge, from_lower + "base\"/></joint>")), "is its own ancestor"));
  EXPECT_TRUE(contains(refusal(twoLinks(hinge, from_lower + "nobody\"/></joint>")), "child = \"nobody\": must be a link"));
  EXPECT_TRUE(contains(refusal(twoLinks(hinge, R"(<link name="tip"/><joint name="t" type="continuous"><parent link="lower"/>
    <child link="tip"/></joint>)")),
                       "body tip: it can move and has no mass"));
}

TEST_F(UrdfImport, ReadsTheArmOfAnotherProgram) {
  const auto file = sharedFolder() / "data" / "robots" / "planar_arm.urdf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  importFile(file.string());
  EXPECT_EQ(count("body"), 2U);
  EXPECT_EQ(count("joint"), 2U);
  const auto forearm = find("body", "forearm");
  EXPECT_NEAR(number(forearm, "mass_g"), 700, 1e-9);
  expectNear(find("joint", "elbow"), "at_mm", {0, 500, 0});
}

}  // namespace
}  // namespace musclesim
