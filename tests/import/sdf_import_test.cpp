#include "import_fixture.h"

namespace musclesim {
namespace {

using SdfImport = ImportedRobotTest;

std::string model(const std::string& content) {
  return "<?xml version=\"1.0\"?><sdf version=\"1.9\"><model name=\"arm\">" + content + "</model></sdf>";
}

std::string link(const std::string& name, const std::string& pose, const std::string& more = "") {
  return "<link name=\"" + name + "\">" + pose +
         "<inertial><pose>0.1 0 0 0 0 0</pose><mass>2</mass><inertia><ixx>0.02</ixx><iyy>0.03</iyy><izz>0.01</izz><ixy>0</ixy><ixz>0</ixz>"
         "<iyz>0</iyz></inertia></inertial>" +
         more + "</link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& axis) {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent>" + parent + "</parent><child>" + child + "</child>" + axis +
         "</joint>";
}

const char* const about_y = "<axis><xyz>0 1 0</xyz><limit><lower>-1</lower><upper>1</upper></limit></axis>";

TEST_F(SdfImport, ResolvesNestedFrames) {
  import(
      model("<frame name=\"shelf\"><pose>0 0 1 0 0 0</pose></frame>"
            "<frame name=\"turned\" attached_to=\"shelf\"><pose relative_to=\"shelf\">1 0 0 0 0 1.5707963267948966</pose></frame>" +
            link("a", "<pose relative_to=\"turned\">0.5 0 0 0 0 0</pose>") +
            joint("j", "revolute", "world", "a",
                  "<axis><xyz expressed_in=\"__model__\">0 1 0</xyz><limit><lower>-1</lower><upper>1</upper></limit>"
                  "<dynamics><friction>0.2</friction><damping>0.3</damping><spring_stiffness>4</spring_stiffness>"
                  "<spring_reference>0.5</spring_reference></dynamics></axis>")));
  const auto j = find("joint", "j");
  expectNear(j, "at_mm", {1000, 1000, -500});
  expectNear(j, "axis", {0, 0, -1});
  EXPECT_NEAR(number(j, "friction_Nm"), 0.2, 1e-9);
  EXPECT_NEAR(number(j, "damping_Nms_per_rad"), 0.3, 1e-9);
  EXPECT_NEAR(number(j, "stiffness_Nm_per_rad"), 4, 1e-9);
  EXPECT_NEAR(number(j, "rest_deg"), 90 / M_PI, 1e-6);
  const auto a = find("body", "a");
  expectNear(a, "at_mm", {1000, 1000, -600});  // the centre of mass; nothing is drawn
  auto moments = numbers(a, "inertia_g_mm2");
  std::sort(moments.begin(), moments.end());
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(moments[i], (i + 1) * 1e7, 1);
}

TEST_F(SdfImport, ReadsShapesAndNestedModels) {
  import(model("<static>false</static>" +
               link("a", "",
                    "<visual name=\"v\"><geometry><sphere><radius>0.05</radius></sphere></geometry></visual>"
                    "<sensor name=\"imu\" type=\"imu\"/>") +
               "<model name=\"tool\"><pose>0 0 0.5 0 0 0</pose>" + link("b", "") + "</model>" + joint("j", "ball", "a", "tool::b", "") +
               joint("k", "prismatic", "world", "a", "<axis><xyz>0 0 1</xyz></axis>")));
  EXPECT_EQ(text(*find("body", "a")["shape"].as_table(), "type"), "sphere");
  EXPECT_EQ(text(find("joint", "j"), "type"), "ball");
  EXPECT_EQ(text(find("joint", "j"), "body"), "tool__b");
  expectNear(find("joint", "j"), "at_mm", {0, 500, 0});
  EXPECT_FALSE(find("joint", "k").contains("limits_mm"));
  EXPECT_TRUE(hasNote("body a: <sensor> imu is not taken over"));
}

TEST_F(SdfImport, TwoAxesMakeAUniversalJoint) {
  import(model(link("a", "") + joint("u", "universal", "world", "a", std::string(about_y) + "<axis2><xyz>1 0 0</xyz></axis2>")));
  const auto u = find("joint", "u_2_u_1");
  EXPECT_EQ(text(u, "type"), "universal");
  expectNear(u, "axis", {1, 0, 0});
  expectNear(u, "axis2", {0, 0, -1});
  expectNear(u, "limits2_deg", {-180 / M_PI, 180 / M_PI});
}

TEST_F(SdfImport, AJointWhoseChildIsFixedHoldsItsParent) {
  import(model(link("a", "<pose>0 0 -1 0 0 0</pose>") + link("b", "") + joint("f", "fixed", "world", "b", "") +
               joint("j", "revolute", "a", "b", "<axis><xyz>0 1 0</xyz><limit><lower>-1</lower><upper>2</upper></limit></axis>")));
  const auto j = find("joint", "j");
  EXPECT_EQ(text(j, "body"), "a");
  EXPECT_EQ(text(j, "to"), "world");
  expectNear(j, "axis", {0, 0, 1});
  expectNear(j, "limits_deg", {-180 / M_PI, 360 / M_PI});
  EXPECT_FALSE(find("body", "a")["free"].value_or(false));
}

TEST_F(SdfImport, LoopsCannotBeMovedIntoTheirLimits) {
  const auto loop = [&](const std::string& limit) {
    return model(link("a", "") + link("b", "") + joint("i", "revolute", "world", "a", "<axis><xyz>0 1 0</xyz></axis>") +
                 joint("j", "revolute", "a", "b", "<axis><xyz>0 1 0</xyz></axis>") +
                 joint("k", "revolute", "world", "b", "<axis><xyz>0 1 0</xyz>" + limit + "</axis>"));
  };
  import(loop("<limit><lower>-0.5</lower><upper>1</upper></limit>"));
  EXPECT_EQ(count("joint"), 3U);
  EXPECT_TRUE(contains(refusal(loop("<limit><lower>0.5</lower><upper>1</upper></limit>")),
                       "joint k: its limits exclude 0, and it belongs to a closed loop"));
  EXPECT_TRUE(contains(refusal(model(link("a", "") + link("b", "") + joint("f", "fixed", "a", "b", "") +
                                     joint("j", "revolute", "a", "b", "<axis><xyz>0 1 0</xyz></axis>"))),
                       "joint j: fixed joints hold both of its bodies together"));
}

TEST_F(SdfImport, WorldsHaveFixedAndFreeModels) {
  import(
      "<sdf version=\"1.9\"><world name=\"w\"><gravity>0 0 -1.6</gravity><model name=\"post\"><static>true</static><pose>1 0 0 0 0 "
      "0</pose>" +
      link("p", "", "<collision name=\"c\"><geometry><box><size>1 1 1</size></box></geometry></collision>") +
      "</model><model name=\"ball\">" + link("s", "") + "</model></world></sdf>");
  EXPECT_TRUE(find("body", "post__p")["fixed"].value_or(false));
  EXPECT_TRUE(find("body", "ball__s")["free"].value_or(false));
  EXPECT_TRUE(hasNote("gravity (0, 0, -1.6)"));
}

TEST_F(SdfImport, RefusesWhatItCannotRead) {
  EXPECT_TRUE(contains(refusal("<sdf version=\"1.9\"><model name=\"m\"/></sdf>"), "at least one link"));
  EXPECT_TRUE(contains(refusal("<sdf version=\"1.9\"></sdf>"), "there is no model"));
  EXPECT_TRUE(contains(refusal(model(link("a", "") + joint("s", "screw", "world", "a", about_y))), "joint s: must be revolute"));
  EXPECT_TRUE(contains(refusal(model(link("a", "") + joint("s", "revolute", "world", "b", about_y))), "b"));
}

TEST_F(SdfImport, RefusesShapesWithoutSize) {
  const std::string visual = "<visual name=\"v\"><geometry><sphere><radius>-1</radius></sphere></geometry></visual>";
  EXPECT_TRUE(contains(refusal(model(link("a", "", visual))), "body a: the sizes of v must be positive"));
}

TEST_F(SdfImport, PrintsNothing) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  refusal(model(link("a", "") + joint("s", "revolute", "world", "b", about_y)));
  import(model(link("a", "", "<unheard_of>1</unheard_of>")));
  EXPECT_TRUE(hasNote("<unheard_of>"));
  EXPECT_TRUE(contains(refusal("<sdf version=\"1.9\"><model name=\"m\"></sdf>"), "robot.xml:1: not well-formed XML"));
  for (const char* text : {"<sdf version=\"none\"/>", "<sdf/>"}) EXPECT_TRUE(contains(refusal(text), "not valid SDF")) << text;
  EXPECT_EQ(testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace musclesim
