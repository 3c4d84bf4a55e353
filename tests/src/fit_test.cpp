#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "musclesim/robot/force_law.h"
#include "src/program.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

/// A folder with data.csv, points of Eq. 1 with the paper's constants, removed at the end.
class FitCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_fit_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    const BraunForceLaw law(120, 300);
    std::ofstream file(folder_ / "data.csv");
    file << "pressure_kPa,length_cm,force_N,remark_1\n";
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; j <= 10; ++j) file << fmt::format("{},{},{},0\n", 100 * i, 12 + 1.8 * j, law.tensionN(0.125 * i, 120 + 18.0 * j));
  }
  void TearDown() override { fs::remove_all(folder_); }
  ProgramResult run(const std::vector<std::string>& arguments) const { return runProgram(arguments, folder_); }

  static nlohmann::json lastLine(const ProgramResult& result) {
    std::istringstream lines(result.out);
    std::string line, last;
    while (std::getline(lines, line)) last = line;
    return nlohmann::json::parse(last);
  }

  fs::path folder_;
};

TEST_F(FitCommand, RecoversThePapersConstantsAndWritesWhatItSays) {
  const ProgramResult result = run({"fit", "data.csv", "--json", "--quiet", "--out", "fitted"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto json = lastLine(result);
  EXPECT_EQ(json.at("points"), 99);
  EXPECT_EQ(json.at("pressure_full_scale_kPa"), 800);
  for (const char* law : {"braun", "chou-hannaford-linear", "chou-hannaford", "sarosi", "map"}) {
    const auto& entry = json.at("laws").at(law);
    EXPECT_TRUE(entry.at("relative_squared_error").is_number()) << law;
    EXPECT_TRUE(entry.at("relative_squared_error_cross_validated").is_number()) << law;
    EXPECT_TRUE(fs::exists(folder_ / entry.at("config").get<std::string>())) << law;
    EXPECT_TRUE(fs::exists(folder_ / entry.at("figure").get<std::string>())) << law;
  }
  const auto& constants = json.at("laws").at("braun").at("constants");
  EXPECT_NEAR(constants.at("a").at("value").get<double>() / 7.687724845623249e-5, 1, 1e-4);
  EXPECT_NEAR(constants.at("b").at("value"), 9.203893778016578, 1e-4);
  EXPECT_NEAR(constants.at("c").at("value"), 9.799574209874333, 1e-5);
  EXPECT_NEAR(constants.at("l_min").at("value"), 120, 1e-3);
}

TEST_F(FitCommand, TheFittedMuscleDrivesEveryRobot) {
  ASSERT_EQ(run({"fit", "data.csv", "--law", "sarosi", "--out", "fitted", "--quiet"}).status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "fitted" / "braun.toml")) << "only the law asked for";
  for (const char* robot : {"rig", "elbow", "arm"}) {
    const ProgramResult result = run({"--simple", "--robot", robot, "--controller", robot == std::string("arm") ? "asm" : "hold",
                                      "--duration", "0.05", "--config", "fitted/sarosi.toml", "--out", robot, "--quiet"});
    ASSERT_EQ(result.status, 0) << robot << ": " << result.err;
    std::ifstream sidecar(folder_ / robot / "run.json");
    EXPECT_EQ(nlohmann::json::parse(sidecar).at("parameters").at("force_law.name"), "sarosi") << robot;
  }
}

TEST_F(FitCommand, BadDataGetAnExplanationAndNoFit) {
  std::ofstream(folder_ / "negative.csv") << "pressure,length_mm,force_N\n0.5,-240,25\n";
  std::ofstream(folder_ / "no_unit.csv") << "pressure,length,force\n0.5,240,25\n";
  const auto expectRefused = [&](const std::vector<std::string>& arguments, int status, const std::string& words) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find(words), std::string::npos) << words << " is missing in: " << result.err;
    EXPECT_FALSE(fs::exists(folder_ / "log")) << "no folder for a fit that is none";
  };
  expectRefused({"fit", "negative.csv"}, 3, "negative.csv:2:5: column length_mm: -240 mm must lie in 5 .. 10000 mm");
  expectRefused({"fit", "no_unit.csv"}, 3, "has no unit; allowed: length_mm");
  expectRefused({"fit", "data.csv", "--where", "pressure_kPa=400"}, 3, "all 11 points have the pressure");
  expectRefused({"fit", "data.csv", "--columns", "length=pressure_kPa:mm,pressure=length_cm:kPa"}, 3,
                "column pressure_kPa: 0 mm must lie in");
  expectRefused({"fit", "absent.csv"}, 5, "absent.csv");
  expectRefused({"fit", "data.csv", "--law", "saros"}, 2, "did you mean \"sarosi\"?");
  expectRefused({"fit", "data.csv", "--columns", "length"}, 2, "name=value");
  expectRefused({"fit", "data.csv", "--minimum-length", "400"}, 2, "be below the maximum, 300 mm");
  expectRefused({"fit", "data.csv", "--law", "sarosi", "--minimum-length", "100"}, 2, "only Eq. 1 has these lengths");
  expectRefused({"fit"}, 2, "data is required");
}

}  // namespace
}  // namespace musclesim
