// Numbers that were taken as exact and would do what a named effect does.
#include <gtest/gtest.h>

#include <fstream>

#include "../planted.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// A load frame like `rig`; its file knows the load as well as this line of the parameter says.
std::string exactRig(const std::string& tolerance_of_load) {
  const std::string file = ::testing::TempDir() + "exact_rig.toml";
  std::ofstream(file) << R"(format = "musclesim-robot-1"
name = "exact_rig"
[parameter.load_kg]
value = 2.0
range = [0.1, 10]
)" << tolerance_of_load
                      << R"(
meaning = "mass hanging from the muscle"
[parameter.top_mm]
value = 0.5
range = [-10, 10]
meaning = "height of the upper attachment"
[[body]]
name = "load"
at_mm = [0, -210, 0]
shape = { type = "sphere", radius_mm = 20 }
mass_g = "load_kg * 1000"
collides = false
[[joint]]
name = "guide"
type = "slider"
body = "load"
axis = "y"
[[muscle]]
from = { body = "world", at_mm = [0, "top_mm - 0.5", 0], lever = [1, 0, 0] }
to = { body = "load", at_mm = [0, -210, 0], may_be_off = false }
length_mm = [120, 300]
[hand]
body = "load"
report = false
[start]
state = "settled"
)";
  return file;
}

Diagnosis diagnosed(const ActiveEffect& planted, const std::string& tolerance_of_load) {
  std::vector<Recording> recordings = planted::plant({planted});
  for (Recording& recording : recordings) {
    recording.info.robot = exactRig(tolerance_of_load);
    recording.info.robot_parameters = {};
  }
  return diagnose(recordings, planted::few({"payload", "valve_lag", "force_gain"}));
}

TEST(NumberInstead, TellsThatAPayloadMayBeTheLoadItself) {
  const Diagnosis found = diagnosed({"payload", "hand", {{"mass_kg", 0.2}}}, "");
  ASSERT_EQ(found.chosen, std::vector<std::string>{"payload@hand"}) << diagnosisSummary(found);
  ASSERT_EQ(found.numbers_instead.size(), 1U) << diagnosisSummary(found);
  const NumberInstead& load = found.numbers_instead.front();
  EXPECT_EQ(load.name, "exact_rig.load_kg");
  EXPECT_EQ(load.unit, "kg");
  EXPECT_EQ(load.effects, std::vector<std::string>{"payload@hand"});
  EXPECT_EQ(load.given, 2.0);
  EXPECT_NEAR(load.instead, 2.2, 0.02);
  EXPECT_TRUE(contains(diagnosisSummary(found), "Numbers that were taken as exact may be the cause instead: exact_rig.load_kg = 2."));
  EXPECT_TRUE(contains(diagnosisJson(found), "\"numbers_instead\""));
}

/// A number with a tolerance is fitted beside the effects, and need not be told of.
TEST(NumberInstead, LeavesOutNumbersWithATolerance) {
  const Diagnosis found = diagnosed({"payload", "hand", {{"mass_kg", 0.5}}}, "tolerance = 0.02");
  ASSERT_EQ(found.chosen, std::vector<std::string>{"payload@hand"}) << diagnosisSummary(found);
  EXPECT_TRUE(found.numbers_instead.empty()) << diagnosisSummary(found);
}

/// The shipped rig's load has a tolerance; its muscle's lengths are exact and act, but not like a payload.
TEST(NumberInstead, NamesNoneBesideANumberThatCouldDoItButIsKnown) {
  const Diagnosis found = diagnose(planted::plant({{"payload", "hand", {{"mass_kg", 0.3}}}}), planted::few({"payload", "valve_lag"}));
  ASSERT_EQ(found.chosen, std::vector<std::string>{"payload@hand"}) << diagnosisSummary(found);
  EXPECT_TRUE(found.numbers_instead.empty()) << diagnosisSummary(found);
}

/// No mass makes a muscle lag.
TEST(NumberInstead, NamesNoneThatActsOtherwise) {
  const Diagnosis found = diagnosed({"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.1}, {"vent_time_constant_s", 0.1}}}, "");
  ASSERT_EQ(found.chosen, std::vector<std::string>{"valve_lag@muscle_0"}) << diagnosisSummary(found);
  EXPECT_TRUE(found.numbers_instead.empty()) << diagnosisSummary(found);
}

}  // namespace
}  // namespace musclesim
