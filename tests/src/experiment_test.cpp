#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "src/program.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

TEST(ExperimentCommand, ShortMuscleFollowsItsLawAndItsPointsCanBeFitted) {
  const fs::path folder = fs::temp_directory_path() / ("musclesim_experiment_test_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const ProgramResult result = runProgram({"experiment", "--specimen", "short", "--out", "out", "--json", "--quiet"}, folder);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(fs::exists(folder / "out" / "short.svg"));
  const auto json = nlohmann::json::parse(result.out.substr(result.out.rfind("\n{") + 1));
  for (const char* experiment : {"loads_hung", "lengths_imposed"}) {
    const auto& errors = json.at("specimens").at("short").at(experiment);
    EXPECT_LE(errors.at("relative_squared_error"), 1e-3) << experiment;
    EXPECT_GT(errors.at("points"), 150) << experiment;
  }
  EXPECT_GT(json.at("specimens").at("short").at("loads_hung").at("relative_squared_error_at_stops"), 1e-3) << "the kink";
  const ProgramResult fitted = runProgram({"fit", "out/short.csv", "--where", "experiment=lengths", "--law", "braun", "--minimum-length",
                                           "60", "--maximum-length", "200", "--json", "--quiet", "--out", "fitted"},
                                          folder);
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const auto law = nlohmann::json::parse(fitted.out.substr(fitted.out.rfind("\n{") + 1)).at("laws").at("braun");
  EXPECT_NEAR(law.at("constants").at("c").at("value"), 9.7996, 0.15) << "and back to Eq. 1, up to friction";
  fs::remove_all(folder);
}

TEST(ExperimentCommand, UnknownSpecimensAreRefused) {
  for (const char* specimen : {"tiny", "200/100", "60/", "5/100"}) {
    const ProgramResult result = runProgram({"experiment", "--specimen", specimen});
    EXPECT_EQ(result.status, 2) << specimen;
    EXPECT_NE(result.err.find("short, medium, long, or MIN/MAX"), std::string::npos) << result.err;
  }
}

TEST(ExperimentCommand, OptionsOfMeasuredPointsNeedThem) {
  const ProgramResult result = runProgram({"experiment", "--specimen", "60/200", "--columns", "force=load"});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("--columns requires --data"), std::string::npos) << result.err;
}

TEST(ExperimentCommand, LineMusclesHaveNoPlaceInTheFrame) {
  const ProgramResult result = runProgram({"experiment", "--specimen", "60/200", "--set", "muscle.model=line"});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("must be chain"), std::string::npos) << result.err;
}

TEST(ExperimentCommand, MeasuredPointsAreReadAsByFitAndNotWrittenOver) {
  const fs::path folder = fs::temp_directory_path() / ("musclesim_experiment_data_test_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream points(folder / "custom.csv");
  points << "pressure_kPa,length_mm,force_N\n";
  for (const int pressure : {0, 200, 400})
    for (const int length : {140, 160, 180}) points << pressure << ',' << length << ',' << (pressure / 10.0 + length - 135) << '\n';
  points.close();
  EXPECT_EQ(runProgram({"experiment", "--specimen", "60/200", "--data", "custom.csv", "--out", "."}, folder).status, 2);
  EXPECT_EQ(
      runProgram({"experiment", "--specimen", "60/200", "--data", "custom.csv", "--columns", "pressure", "--out", "o"}, folder).status, 2);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace musclesim
