#include "log/sidecar.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "log_fixture.h"

namespace musclesim {
namespace {

RecordingInfo parse(const std::string& text) {
  std::vector<std::string> notes;
  return parseSidecar(text, "run.json", {}, notes);
}

/// A sidecar with one further member in line 3, column 3.
std::string with(const std::string& member_and_value) {
  return "{\"format\": \"musclesim-recording-1\",\n \"robot\": \"rig\",\n  " + member_and_value + "}";
}

TEST(Sidecar, ReadsEveryMember) {
  const auto info = parse(R"({"format": "musclesim-recording-1", "robot": "rig", "physics": "si", "initial_state": "settled",
    "parameter_tolerance": {"load_kg": 0.05, "elbow.forearm_kg": 2, "muscle": {"slider_friction_N": 0.5}},
    "robot_parameters": {"load_kg": 2.0, "force_law": {"name": "sarosi", "a": {"b": 1}}}, "description": "free", "trial": "slow",
    "pressure_full_scale_kPa": 600, "command_full_scale_V": 10, "noise_std": {"length_0_cm": 0.005, "pressure_0_bar": 0.06},
    "repeat_of": "other", "active_effects": [{"id": "valve_lag", "parameters": {"fill_time_constant_s": 0.08, "limit": "inf"}},
    {"id": "payload", "component": "hand"}], "seed": 18446744073709551615, "step_s": 0.0005, "skip_start_s": 1.5, "program": "p", "complete": true})");
  EXPECT_EQ(info.robot, "rig");
  EXPECT_EQ(info.physics, "si");
  EXPECT_EQ(info.initial_state, "settled");
  EXPECT_EQ(std::get<double>(info.robot_parameters.at("load_kg")), 2);
  EXPECT_EQ(std::get<std::string>(info.robot_parameters.at("force_law.name")), "sarosi");
  EXPECT_EQ(std::get<double>(info.robot_parameters.at("force_law.a.b")), 1);
  const std::map<std::string, double> tolerances = {{"load_kg", 0.05}, {"elbow.forearm_kg", 2}, {"muscle.slider_friction_N", 0.5}};
  EXPECT_EQ(info.parameter_tolerance, tolerances);
  EXPECT_EQ(info.description, "free");
  EXPECT_EQ(info.trial, "slow");
  EXPECT_EQ(info.repeat_of, "other");
  EXPECT_EQ(info.program, "p");
  EXPECT_EQ(info.pressure_full_scale_kPa, 600);
  EXPECT_EQ(info.command_full_scale_V, 10);
  EXPECT_DOUBLE_EQ(info.noise_std.at("length_0_mm"), 0.05);
  EXPECT_DOUBLE_EQ(info.noise_std.at("pressure_0"), 0.01);
  ASSERT_EQ(info.active_effects.size(), 2u);
  EXPECT_EQ(info.active_effects[0].id, "valve_lag");
  EXPECT_EQ(info.active_effects[0].component, "all");
  EXPECT_EQ(info.active_effects[0].parameters.at("fill_time_constant_s"), Parameter::Value(0.08));
  EXPECT_EQ(info.active_effects[0].parameters.at("limit"), Parameter::Value(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(info.active_effects[1].component, "hand");
  EXPECT_EQ(info.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(info.step_s, 0.0005);
  EXPECT_EQ(info.skip_start_s, 1.5);
  EXPECT_EQ(info.complete, true);
  EXPECT_EQ(info.extra_json, "{}");
}

TEST(Sidecar, RequiredMembers) {
  EXPECT_EQ(messageOf<BadFile>([] { parse("{\"robot\": \"rig\"}"); }),
            "run.json: member \"format\" is missing: must be \"musclesim-recording-1\"");
  EXPECT_EQ(messageOf<BadFile>([] { parse("{\"format\": \"musclesim-recording-2\", \"robot\": \"rig\"}"); }),
            "run.json:1:2: format = \"musclesim-recording-2\": must be \"musclesim-recording-1\"");
  EXPECT_TRUE(hasWords(messageOf<BadFile>([] { parse("{\"format\": \"musclesim-recording-1\"}"); }),
                       {"run.json: ", "\"robot\" is missing", "\"elbow\""}));
  EXPECT_TRUE(hasWords(messageOf<BadFile>([] { parse("{\"format\": \"musclesim-recording-1\", \"robot\": \"\"}"); }),
                       {"run.json:1:37: ", "empty"}));
}

TEST(Sidecar, WrongTypesAndValuesAreRefusedAtTheirPlace) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {R"("physics": "SI")", {"physics = \"SI\"", "\"si\" or \"original\""}},
      {R"("physics": 1)", {"physics = 1"}},
      {R"("initial_state": "hung")", {"\"settled\" or \"built\""}},
      {R"("description": 3)", {"description = 3: must be a string"}},
      {R"("repeat_of": null)", {"repeat_of = null", "leave the member out"}},
      {R"("pressure_full_scale_kPa": 0)", {"above 0 kPa"}},
      {R"("pressure_full_scale_kPa": "600")", {"above 0 kPa"}},
      {R"("command_full_scale_V": -1)", {"above 0 V"}},
      {R"("step_s": 0)", {"above 0 s"}},
      {R"("skip_start_s": -1)", {"skip_start_s = -1", "0 s or more"}},
      {R"("seed": -1)", {"whole number"}},
      {R"("seed": 1.5)", {"whole number"}},
      {R"("complete": "yes")", {"true or false"}},
      {R"("noise_std": 0.1)", {"noise_std = 0.1", "object"}},
      {R"("noise_std": {"length_0_mm": -0.1})", {"noise_std.length_0_mm = -0.1", "0 or more"}},
      {R"("noise_std": {"length_0_mm": "small"})", {"noise_std.length_0_mm", "number"}},
      {R"("noise_std": {"length_0_inch": 0.1})", {"noise_std", "unknown unit", "length_<i>_mm|cm|m"}},
      {R"("noise_std": {"length_0_mm": 0.1, "length_0_m": 0.1})", {"once per quantity"}},
      {R"("noise_std": {"pressure_0_kPa": 0.1})", {"pressure_full_scale_kPa"}},
      {R"("robot_parameters": [1])", {"robot_parameters = [...]", "object"}},
      {R"("robot_parameters": {"load_kg": true})", {"robot_parameters.load_kg = true", "number, a string"}},
      {R"("robot_parameters": {"law": {"a": [1]}})", {"robot_parameters.law.a"}},
      {R"("robot_parameters": {"law.a": 1, "law": {"a": 2}})", {"robot_parameters.law.a", "once"}},
      {R"("robot_parameters": {"": 1})", {"have a name"}},
      {R"("parameter_tolerance": 0.1)", {"parameter_tolerance = 0.1", "object"}},
      {R"("parameter_tolerance": {"load_kg": 0})", {"parameter_tolerance.load_kg = 0", "above 0 and at most 2"}},
      {R"("parameter_tolerance": {"load_kg": -0.1})", {"parameter_tolerance.load_kg = -0.1", "above 0 and at most 2"}},
      {R"("parameter_tolerance": {"elbow": {"forearm_kg": 2.1}})", {"parameter_tolerance.elbow.forearm_kg = 2.1", "at most 2"}},
      {R"("parameter_tolerance": {"load_kg": "5 %"})", {"parameter_tolerance.load_kg = \"5 %\"", "number"}},
      {R"("parameter_tolerance": {"law.a": 0.1, "law": {"a": 0.2}})", {"parameter_tolerance.law.a", "once"}},
      {R"("parameter_tolerance": {"": 0.1})", {"have a name"}},
      {R"("active_effects": {"id": "valve_lag"})", {"active_effects = {...}", "list"}},
      {R"("active_effects": ["valve_lag"])", {"active_effects[0]", "object"}},
      {R"("active_effects": [{"component": "all"}])", {"active_effects[0]", "\"id\""}},
      {R"("active_effects": [{"id": "a"}, {"id": 3}])", {"active_effects[1].id"}},
      {R"("active_effects": [{"id": "a", "strength": 3}])", {"active_effects[0].strength", "id, component, parameters"}},
      {R"("active_effects": [{"id": "a", "parameters": {"x": true}}])", {"active_effects[0].parameters.x", "\"inf\""}},
      {R"("active_effects": [{"id": "a", "parameters": [1]}])", {"active_effects[0].parameters", "object"}},
  };
  for (auto [member, words] : cases) {
    words.push_back("run.json:3:3: ");
    EXPECT_TRUE(hasWords(messageOf<BadFile>([text = with(member)] { parse(text); }), words));
  }
}

TEST(Sidecar, FurtherMembersAreKeptWithANote) {
  std::vector<std::string> notes;
  const auto info = parseSidecar(with(R"("machine": {"valve": [1, 2.5]}, "operator": "A")"), "run.json", {}, notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(hasWords(notes[0], {"\"machine\"", "\"operator\""}));
  const auto again = nlohmann::json::parse(sidecarText(info));
  EXPECT_EQ(again["machine"]["valve"][1], 2.5);
  EXPECT_EQ(again["operator"], "A");
}

TEST(Sidecar, WhatRunsOfThisProgramWriteNeedsNoNote) {
  std::vector<std::string> notes;
  parseSidecar(with(R"("stepper": "chain", "pulls": [], "repeats": {"file": "run.csv"})"), "run.json", {}, notes);
  EXPECT_TRUE(notes.empty()) << notes.front();
}

TEST(Sidecar, NoiseOfIgnoredColumnsIsSkipped) {
  std::vector<std::string> notes;
  EXPECT_TRUE(parseSidecar(with(R"("noise_std": {"temperature": 1})"), "run.json", {"temperature"}, notes).noise_std.empty());
}

TEST(Sidecar, TextReadsBackToTheSame) {
  RecordingInfo info;
  info.robot = "elbow";
  info.physics = "original";
  info.initial_state = "built";
  info.robot_parameters = {{"forearm_kg", 0.1 + 0.2}, {"force_law", std::string("braun")}, {"force_law.a", -1e-300}};
  info.description = "\"quotes\", \u00FCml\u00E4ute\nand a line break";
  info.parameter_tolerance = {{"forearm_kg", 0.02}, {"muscle.slider_friction_N", 0.5}};
  info.noise_std = {{"angle_elbow_deg", 1.0 / 3}};
  info.active_effects = {{"stop", "elbow", {{"stiffness", std::numeric_limits<double>::infinity()}, {"gap_mm", 0.5}, {"axis", "y"}}}};
  info.seed = std::numeric_limits<std::uint64_t>::max();
  info.step_s = 0.01;
  info.skip_start_s = 0;
  info.complete = true;
  info.extra_json = R"({"verdict": {"a": [1, 2]}})";
  const std::string text = sidecarText(info);
  EXPECT_EQ(sidecarText(parse(text)), text);
  const auto again = parse(text);
  EXPECT_EQ(again.robot_parameters, info.robot_parameters);
  EXPECT_EQ(again.parameter_tolerance, info.parameter_tolerance);
  EXPECT_EQ(again.noise_std, info.noise_std);
  EXPECT_EQ(again.description, info.description);
  EXPECT_EQ(again.seed, info.seed);
  EXPECT_EQ(again.skip_start_s, 0);
  EXPECT_EQ(again.active_effects[0].parameters, info.active_effects[0].parameters);
}

TEST(Sidecar, TextRefusesWhatCouldNotBeRead) {
  RecordingInfo info;
  EXPECT_THROW(sidecarText(info), BadParameter) << "no robot";
  info.robot = "rig";
  EXPECT_NO_THROW(sidecarText(info));
  info.step_s = std::nan("");
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([&] { sidecarText(info); }), {"step_s", "finite"}));
  info.step_s = 0.01;
  info.parameter_tolerance = {{"load_kg", 0}};
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([&] { sidecarText(info); }), {"parameter_tolerance.load_kg", "above 0"}));
  info.parameter_tolerance.clear();
  info.extra_json = "[1]";
  EXPECT_THROW(sidecarText(info), BadParameter);
  info.extra_json = "";
  info.noise_std = {{"length_0_mm", -1}};
  EXPECT_THROW(sidecarText(info), BadParameter);
}

TEST(Sidecar, SetsOneMember) {
  RecordingInfo info;
  info.robot = "rig";
  info = withMember(info, "substeps", "20");
  info = withMember(info, "substeps", "40");
  info = withMember(info, "step_s", "0.02");
  EXPECT_EQ(info.step_s, 0.02);
  EXPECT_EQ(nlohmann::json::parse(info.extra_json), nlohmann::json({{"substeps", 40}}));
  EXPECT_THROW(withMember(info, "verdict", "not json"), BadParameter);
  EXPECT_THROW(withMember(info, "seed", "\"one\""), BadParameter);
}

}  // namespace
}  // namespace musclesim
