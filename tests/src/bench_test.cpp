// musclesim bench
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../../src/bench_report.h"
#include "src/program.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

TEST(BenchReport, FindsTheExponentOfAPowerLaw) {
  command_line::BenchCurve curve{"x", {}};
  for (const int n : {1, 2, 10, 15, 30}) {
    command_line::BenchRun run;
    run.muscle_count = n;
    run.ratio = n < 10 ? 5 : 0.01 * std::pow(n, 1.7);
    curve.runs.push_back(run);
  }
  EXPECT_NEAR(command_line::fittedExponent(curve, 10), 1.7, 1e-12);
  EXPECT_TRUE(std::isnan(command_line::fittedExponent(curve, 30)));
}

TEST(BenchCommand, WritesTableAndFigureOfEveryCandidate) {
  const fs::path folder = fs::temp_directory_path() / ("musclesim_bench_test_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const ProgramResult result = runProgram(
      {"bench", "--muscles", "1,2", "--duration", "0.05", "--time-limit", "0.1", "--repeats", "1", "--out", ".", "--quiet", "--json"},
      folder);
  EXPECT_EQ(result.status, 0) << result.err;
  std::ifstream file(folder / "performance.md");
  const std::string table(std::istreambuf_iterator<char>(file), {});
  const auto json = nlohmann::json::parse(result.out.substr(result.out.rfind("\n{") + 1));
  EXPECT_EQ(json["ratio"].size(), 12u);
  EXPECT_DOUBLE_EQ(json["real_time_factor"]["si, dWorldStep"]["2"].get<double>() * json["ratio"]["si, dWorldStep"]["2"].get<double>(), 1);
  for (const auto& [name, ratios] : json["ratio"].items()) {
    EXPECT_TRUE(contains(table, "| " + name + " |"));
    EXPECT_GT(ratios["2"].get<double>(), 0) << name;
  }
  EXPECT_TRUE(fs::exists(folder / "figures" / "performance.svg"));
  EXPECT_EQ(runProgram({"bench", "--repeats", "0", "--out", "."}, folder).status, 2);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace musclesim
