// musclesim bench
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../../src/bench_report.h"
#include "../../src/peers_report.h"
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

command_line::PeerResult peer(const std::string& engine, double over_ours, const std::string& failure = "") {
  command_line::PeerResult result;
  result.engine = engine;
  result.failure = failure;
  result.muscle_count = 10;
  result.over_ours = over_ours;
  return result;
}

TEST(PeersReport, SaysWhereAnotherEngineIsFaster) {
  const std::string text =
      command_line::peersSection({peer("musclesim", 1), peer("Fast", 0.5), peer("Slow", 3), peer("None", 0, "not built")}, 3, 20);
  EXPECT_TRUE(contains(text, "Another engine is faster: Fast, n = 10, chains (0.50 of our time)."));
  EXPECT_TRUE(contains(text, "musclesim is faster: Slow, n = 10, chains (3.0 times ours)."));
  EXPECT_TRUE(contains(text, "| 10 | None | not built |"));
}

TEST(PeersReport, ReplacesItsSectionOfThePage) {
  const std::string first = command_line::peersSection({peer("First", 1)}, 3, 20),
                    second = command_line::peersSection({peer("Second", 1)}, 3, 20);
  const std::string page = command_line::withPeersSection("# Performance\n", first);
  EXPECT_EQ(command_line::peersSectionOf(page), first);
  EXPECT_EQ(command_line::withPeersSection(page, second), "# Performance\n\n" + second);
  EXPECT_EQ(command_line::peersSectionOf("# Performance\n"), "");
}

TEST(BenchCommand, KeepsTheSectionOfThePeers) {
  const fs::path folder = fs::temp_directory_path() / ("musclesim_peers_test_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string section = command_line::peersSection({peer("Kept", 1)}, 3, 20);
  std::ofstream(folder / "performance.md") << "old\n" << section;
  const ProgramResult result = runProgram(
      {"bench", "--muscles", "1", "--duration", "0.05", "--time-limit", "0.1", "--repeats", "1", "--out", ".", "--quiet"}, folder);
  EXPECT_EQ(result.status, 0) << result.err;
  std::ifstream file(folder / "performance.md");
  const std::string page(std::istreambuf_iterator<char>(file), {});
  EXPECT_TRUE(page.starts_with("# Performance"));
  EXPECT_EQ(command_line::peersSectionOf(page), section);
  fs::remove_all(folder);
}

/// Every engine has a row: with its version, or with the reason why it has none.
TEST(BenchCommand, ComparesWithOtherEnginesThatAreThere) {
  const fs::path folder = fs::temp_directory_path() / ("musclesim_engines_test_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const ProgramResult result = runProgram(
      {"bench", "--peers", "--muscles", "1", "--repeats", "1", "--time-limit", "0.02", "--out", ".", "--quiet", "--json"}, folder);
  EXPECT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out.substr(result.out.rfind("\n{") + 1));
  ASSERT_EQ(json["peers"].size(), 8u);  // four engines, ours among them, chains and lines
  for (const auto& entry : json["peers"]) EXPECT_TRUE(entry.contains("failure") || entry["over_ours"].get<double>() > 0) << entry;
  EXPECT_TRUE(fs::exists(folder / "figures" / "peers.svg"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace musclesim
