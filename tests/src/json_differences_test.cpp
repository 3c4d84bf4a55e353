#include "../../src/json_differences.h"

#include <gtest/gtest.h>

namespace musclesim::command_line {
namespace {

using nlohmann::json;

TEST(JsonDifferences, EqualValuesHaveNone) {
  EXPECT_TRUE(differencesOf(json{{"a", {1, 2}}, {"b", "x"}}, json{{"b", "x"}, {"a", {1, 2}}}).empty())
      << "the order of members says nothing";
}

TEST(JsonDifferences, NamesMembersWithTheirPath) {
  const json before = {{"robot_parameters", {{"rig", {{"load_kg", 2.0}}}}}, {"seed", 1}};
  const json now = {{"robot_parameters", {{"rig", {{"load_kg", 2.5}}}}}, {"seed", 1}};
  const auto found = differencesOf(before, now);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "robot_parameters.rig.load_kg");
  EXPECT_EQ(found[0].before, "2.0");
  EXPECT_EQ(found[0].now, "2.5");
}

TEST(JsonDifferences, AMemberOfOneSideAloneIsNullOnTheOther) {
  const auto found = differencesOf(json{{"old", 1}}, json{{"new", "x"}});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "new");
  EXPECT_EQ(found[0].before, "null");
  EXPECT_EQ(found[0].now, "\"x\"");
  EXPECT_EQ(found[1].name, "old");
  EXPECT_EQ(found[1].now, "null");
}

TEST(JsonDifferences, WhatIsNoObjectDiffersAsAWhole) {
  const auto found = differencesOf(json{{"times_s", {1, 2}}}, json{{"times_s", {1, 3}}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].before, "[1,2]");
}

}  // namespace
}  // namespace musclesim::command_line
