/// `musclesim effects` and the option --effects.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "musclesim/effect/catalogue.h"
#include "musclesim/log/recording.h"
#include "src/program.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

TEST(EffectsCommand, ListsTheCatalogue) {
  const ProgramResult result = runProgram({"effects"});
  EXPECT_EQ(result.status, 0) << result.err;
  for (const EffectInfo& info : effectCatalogue()) EXPECT_TRUE(contains(result.out, info.id));
}

TEST(EffectsCommand, DescribesOne) {
  const ProgramResult result = runProgram({"effects", "valve_lag"});
  EXPECT_EQ(result.status, 0) << result.err;
  for (const char* part : {"tau_k dp_k/dt = p_(k-1) - p_k", "vent_time_constant_s", "pressure", "0 .. 5"})
    EXPECT_TRUE(contains(result.out, part));
  const auto json = nlohmann::json::parse(runProgram({"effects", "flow_limit", "--json"}).out);
  EXPECT_EQ(json["parameters"][0]["neutral"], "inf");
}

TEST(EffectsCommand, KnowsTheNearestName) {
  const ProgramResult result = runProgram({"effects", "valve_leg"});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "did you mean \"valve_lag\"?"));
}

class EffectsOption : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_effects_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& list) {
    std::ofstream(folder_ / "effects.json") << R"({"format": "musclesim-effects-1", "effects": )" << list << "}";
  }
  ProgramResult run(const std::string& record) {
    return runProgram({"--simple", "--quiet", "--robot", "elbow", "--controller", "random", "--decision-interval", "0.1", "--duration",
                       "0.3", "--effects", "effects.json", "--record", record},
                      folder_);
  }

  fs::path folder_;
};

TEST_F(EffectsOption, ActsIsRecordedAndReplayed) {
  write(R"([{"id": "valve_lag", "component": "muscle_1", "parameters": {"fill_time_constant_s": 0.2}}])");
  ASSERT_EQ(run("run.csv").status, 0);
  const Recording recording = readRecording((folder_ / "run.csv").string());
  EXPECT_EQ(recording.info.active_effects, (std::vector<ActiveEffect>{{"valve_lag", "muscle_1", {{"fill_time_constant_s", 0.2}}}}));
  EXPECT_EQ(recording.find("pressure_0")->values, recording.find("command_0")->values);
  EXPECT_NE(recording.find("pressure_1")->values, recording.find("command_1")->values);
  const ProgramResult replay = runProgram({"replay", "run.csv", "--json", "--quiet"}, folder_);
  ASSERT_EQ(replay.status, 0) << replay.err;
  const auto json = nlohmann::json::parse(replay.out.substr(replay.out.rfind('{', replay.out.find("\"command\""))));
  for (const auto& [name, error] : json["signals"].items()) EXPECT_EQ(error["largest"], 0) << name;
}

TEST_F(EffectsOption, RefusesAWrongFileWithStatus3AndAWrongComponentWith2) {
  write(R"([{"id": "valve_lag", "parameters": {"tau": 1}}])");
  ProgramResult result = run("run.csv");
  EXPECT_EQ(result.status, 3);
  EXPECT_TRUE(contains(result.err, "effects.json:1"));
  write(R"([{"id": "valve_lag", "component": "muscle_7"}])");
  result = run("run.csv");
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "muscle_1"));
}

}  // namespace
}  // namespace musclesim
