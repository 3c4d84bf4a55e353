#include "sweep/collect.h"

#include <nlohmann/json.hpp>

#include "musclesim/base/error.h"
#include "src/program.h"
#include "sweep/result.h"
#include "sweep/sweep_fixture.h"

namespace musclesim {
namespace {

using Collecting = SweepTest;

RowResult resultOf(const std::string& status, const nlohmann::ordered_json& numbers) {
  RowResult result;
  result.status = status;
  result.numbers = numbers;
  return result;
}

TEST_F(Collecting, ListsWhatIsMissingDivergedFailedAndCrashed) {
  const std::string sweep = sweepOf(5);
  writeResult(sweep, 0, resultOf("done", {{"rmse", 0.1}, {"nested", {{"n", 3}}}, {"list", {1, 2}}, {"wall_s", 9.0}}));
  writeResult(sweep, 1, resultOf("diverged", {{"rmse", nullptr}}));
  writeResult(sweep, 2, resultOf("failed", nullptr));
  writeResult(sweep, 4, resultOf("crashed", nullptr));
  const Collected collected = collect(sweep);
  EXPECT_FALSE(collected.complete());
  EXPECT_EQ(collected.missing, std::vector<std::size_t>{3});
  EXPECT_EQ(collected.diverged, std::vector<std::size_t>{1});
  EXPECT_EQ(collected.failed, std::vector<std::size_t>{2});
  EXPECT_EQ(collected.crashed, std::vector<std::size_t>{4});
  EXPECT_EQ(contentOf(collected.csv_file),
            "row,status,x,rmse,nested.n\n0,done,0,0.1,3\n1,diverged,1,,\n2,failed,2,,\n3,missing,3,,\n4,crashed,4,,\n");
  EXPECT_EQ(nlohmann::json::parse(contentOf(collected.json_file)).at("complete"), false);
}

TEST_F(Collecting, DivergedRowsAreResults) {
  const std::string sweep = sweepOf(1);
  writeResult(sweep, 0, resultOf("diverged", nullptr));
  EXPECT_TRUE(collect(sweep).complete());
}

TEST_F(Collecting, ChoosesColumnsAlsoInLists) {
  Sweep sweep;
  sweep.command = {"{x}"};
  sweep.columns = {"effects.0.id", "fit.*"};
  sweep.rows = {{{{"x", 1.0}}, {}}};
  writeSweep(sweep, path("sweep"));
  writeResult(path("sweep"), 0, resultOf("done", {{"effects", {{{"id", "leak, or not"}, {"p", 1}}}}, {"fit", {{"a", 1}, {"b", true}}}}));
  EXPECT_EQ(contentOf(collect(path("sweep")).csv_file), "row,status,x,effects.0.id,fit.a,fit.b\n0,done,1,\"leak, or not\",1,true\n");
}

TEST_F(Collecting, NamesColumnsThatNoRowHas) {
  Sweep sweep;
  sweep.command = {"{x}"};
  sweep.columns = {"rmse", "typo", "no.*", "late"};
  for (const double x : {1.0, 2.0}) sweep.rows.push_back({{{"x", x}}, {}});
  writeSweep(sweep, path("sweep"));
  EXPECT_TRUE(collect(path("sweep")).unmet_columns.empty()) << "nothing is done yet";
  writeResult(path("sweep"), 0, resultOf("done", {{"rmse", 3}}));
  writeResult(path("sweep"), 1, resultOf("done", {{"rmse", 4}, {"late", 5}}));
  const Collected collected = collect(path("sweep"));
  EXPECT_EQ(collected.unmet_columns, (std::vector<std::string>{"typo", "no.*"}));
  const ProgramResult program = runProgram({"collect", "sweep"}, folder_);
  EXPECT_EQ(program.status, 2);
  EXPECT_TRUE(contains(program.err, "\"typo\": no row has a number of this name")) << program.err;
}

TEST_F(Collecting, KeepsTimesOfTheMachineOnlyIfTheirNamesAreAskedFor) {
  const auto columnsWith = [&](const std::vector<std::string>& columns) {
    Sweep sweep;
    sweep.command = {"{x}"};
    sweep.columns = columns;
    sweep.rows = {{{{"x", 1.0}}, {}}};
    const std::string folder = path("sweep" + std::to_string(columns.size()));
    writeSweep(sweep, folder);
    writeResult(folder, 0, resultOf("done", {{"wall_s", 9}, {"rmse", 3}, {"log", {{"file", "a"}}}}));
    const std::string table = contentOf(collect(folder).csv_file);
    return table.substr(0, table.find('\n'));
  };
  EXPECT_EQ(columnsWith({}), "row,status,x,rmse");
  EXPECT_EQ(columnsWith({"*"}), "row,status,x,rmse");
  EXPECT_EQ(columnsWith({"*", "wall_s"}), "row,status,x,wall_s,rmse");
  EXPECT_EQ(columnsWith({"rmse", "wall_s", "log.file"}), "row,status,x,wall_s,rmse,log.file");
}

TEST_F(Collecting, KeepsTheFirstResultOfARow) {
  const std::string sweep = sweepOf(1);
  EXPECT_TRUE(writeResult(sweep, 0, resultOf("done", {{"a", 1}})));
  EXPECT_FALSE(writeResult(sweep, 0, resultOf("done", {{"a", 2}})));
  EXPECT_EQ(readResult(sweep, 0).numbers.at("a"), 1);
}

TEST_F(Collecting, RefusesAResultThatIsNone) {
  const std::string sweep = sweepOf(1);
  writeFile(sweep + "/results/000000.json", "{\"row\": 0}");
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { collect(sweep); }), "000000.json"));
}

}  // namespace
}  // namespace musclesim
