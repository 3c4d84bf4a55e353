#include "musclesim/effect/catalogue.h"

#include <gtest/gtest.h>

#include <set>

#include "musclesim/base/error.h"
#include "musclesim/effect/relevance.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

TEST(Catalogue, HasEachIdOnceAndStagesInOrder) {
  std::set<std::string> ids;
  Stage stage = Stage::command;
  for (const EffectInfo& info : effectCatalogue()) {
    EXPECT_TRUE(ids.insert(info.id).second) << info.id;
    EXPECT_GE(info.stage, stage) << info.id;
    stage = info.stage;
  }
}

TEST(Catalogue, NamesTheNearestId) {
  const std::string message = messageOf<BadParameter>([] { effectInfo("valve_lagg"); });
  EXPECT_TRUE(contains(message, "valve_lagg"));
  EXPECT_TRUE(contains(message, "did you mean \"valve_lag\"?"));
}

TEST(Catalogue, MissingParametersAreNeutral) {
  const EffectInfo info = effectInfo("valve_lag");
  EXPECT_EQ(effectValues(info, {"valve_lag", "all", {{"vent_time_constant_s", 0.1}}}), (std::vector<double>{0, 0.1, 0}));
  EXPECT_TRUE(isNeutral(info, {0, 0, 0}));
  EXPECT_FALSE(isNeutral(info, {0, 0.1, 0}));
}

TEST(Catalogue, RefusesUnknownParametersAndNamesThem) {
  const EffectInfo info = effectInfo("valve_lag");
  const std::string message = messageOf<BadParameter>([&] { effectValues(info, {"valve_lag", "all", {{"tau", 0.1}}}); });
  EXPECT_TRUE(contains(message, "\"tau\""));
  EXPECT_TRUE(contains(message, "fill_time_constant_s"));
}

TEST(Catalogue, WordsAreRefusedWhereANumberIsMeant) {
  const EffectInfo info = effectInfo("valve_lag");
  EXPECT_THROW(effectValues(info, {"valve_lag", "all", {{"fill_time_constant_s", std::string("fast")}}}), BadParameter);
}

TEST(Catalogue, ValuesGoThereAndBack) {
  for (const EffectInfo& info : effectCatalogue()) {
    std::vector<double> values;
    for (const EffectParameter& p : info.parameters) values.push_back(p.choices.empty() ? p.usual_low : 0);
    EXPECT_EQ(effectValues(info, activeEffect(info, "all", values)), values) << info.id;
  }
}

TEST(Catalogue, ListsTheComponentsOfARobot) {
  Simulation elbow;
  Robot& robot = elbow.build("elbow");
  EXPECT_EQ(componentsFor(effectInfo("valve_lag"), robot), (std::vector<std::string>{"all", "muscle_0", "muscle_1"}));
  EXPECT_EQ(componentsFor(effectInfo("joint_viscous_friction"), robot), (std::vector<std::string>{"joint_elbow"}));
  const auto signals = componentsFor(effectInfo("sensor_bias"), robot);
  EXPECT_EQ(signals.front(), "all");
  EXPECT_EQ(signals.back(), "signal_hand_z");
  EXPECT_EQ(signals.size(), 1u + 2 + 2 + 2 + 1 + 3);
  EXPECT_TRUE(componentsFor(effectInfo("slide_friction"), robot).empty());
  Simulation rig;
  const Robot& frame = rig.build("rig");
  EXPECT_TRUE(componentsFor(effectInfo("joint_viscous_friction"), frame).empty());
  EXPECT_EQ(componentsFor(effectInfo("slide_friction"), frame), (std::vector<std::string>{"slide_guide"}));
}

std::vector<std::string> relevantNames(const std::string& id, const std::string& component) {
  const EffectInfo info = effectInfo(id);
  std::vector<std::string> names;
  for (const std::size_t i : relevantParameters(info, component)) names.push_back(info.parameters[i].name);
  return names;
}

TEST(Catalogue, KnowsWhichParametersCountOnAComponent) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(relevantNames("contact", "joint_elbow"), (Names{"stiffness_Nm_per_deg", "plane_deg", "side"}));
  EXPECT_EQ(relevantNames("contact", "hand"), (Names{"stiffness_N_per_mm", "plane_mm", "axis", "side"}));
  EXPECT_EQ(relevantNames("sensor_backlash", "signal_angle_elbow"), Names{"width_deg"});
  EXPECT_EQ(relevantNames("sensor_backlash", "signal_length_0"), Names{"width_mm"});
  EXPECT_EQ(relevantNames("sensor_backlash", "all").size(), 2u);
  EXPECT_EQ(relevantNames("attachment_offset", "muscle_0"), (Names{"offset_mm", "rise_mm", "attachment"}));
  EXPECT_EQ(relevantNames("joint_stiffness", "joint_elbow").size(), 2u);
}

TEST(Catalogue, RefusesEntriesThatCannotBeUsed) {
  EXPECT_THROW(registerEffect({}), BadParameter);
  EffectInfo info = effectInfo("valve_lag");
  info.parameters[0].neutral = -1;
  EXPECT_THROW(registerEffect(info), BadParameter);
}

}  // namespace
}  // namespace musclesim
