#include "sweep/plan.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "musclesim/base/error.h"
#include "sweep/sweep_fixture.h"

namespace musclesim {
namespace {

const std::string head = "format = \"musclesim-sweep-1\"\ncommand = [\"run\"]\n";
const std::string head_with_seed = "format = \"musclesim-sweep-1\"\ncommand = [\"run\", \"--seed={seed}\"]\n";

double number(const SweepRow& row, const std::string& name) {
  for (const auto& [key, value] : row.parameters)
    if (key == name) return std::get<double>(value);
  ADD_FAILURE() << "no " << name;
  return 0;
}

std::string refusal(const std::string& text) {
  return messageOf<BadFile>([&] { parsePlan(text, "plan.toml"); });
}

TEST(Plan, GridHasEveryCombination) {
  const Sweep sweep = parsePlan(head + "[grid]\na.x = [1, 2, 3]\na.word = [\"u\", \"v\"]\n", "plan.toml");
  ASSERT_EQ(sweep.rows.size(), 6u);
  std::set<std::string> rows;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto arguments = argumentsOf(sweep, i, "out");
    ASSERT_EQ(arguments.size(), 5u);
    rows.insert(arguments[2] + " " + arguments[4]);
  }
  EXPECT_EQ(rows, (std::set<std::string>{"a.word=u a.x=1", "a.word=u a.x=2", "a.word=u a.x=3", "a.word=v a.x=1", "a.word=v a.x=2",
                                         "a.word=v a.x=3"}));
}

TEST(Plan, ListIsTakenRowByRowAndSectionsMultiply) {
  const Sweep sweep =
      parsePlan(head_with_seed + "[list]\na.x = [1, 2]\na.y = [10, 20]\n[grid]\na.z = [5, 6, 7]\n[repeats]\ncount = 2\n", "p.toml");
  ASSERT_EQ(sweep.rows.size(), 12u);
  for (const SweepRow& row : sweep.rows) EXPECT_EQ(number(row, "a.y"), 10 * number(row, "a.x"));
}

TEST(Plan, RepeatsHaveSeedsThatDoNotDependOnTheOtherParameters) {
  const Sweep sweep = parsePlan("seed = 40\n" + head_with_seed + "[grid]\na.x = [1, 2]\n[repeats]\ncount = 3\n", "plan.toml");
  ASSERT_EQ(sweep.rows.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(number(sweep.rows[i], "repeat"), static_cast<double>(i % 3));
    EXPECT_EQ(number(sweep.rows[i], "seed"), 40 + static_cast<double>(i % 3));
  }
}

TEST(Plan, RepeatsThatWouldBeTheSameRunAreRefused) {
  const std::string repeats = "[repeats]\ncount = 2\n";
  EXPECT_TRUE(contains(refusal(head + repeats), "plan.toml:3:1: repeats: all would be the same run"));
  EXPECT_EQ(parsePlan("format = \"musclesim-sweep-1\"\ncommand = [\"run\", \"{repeat}\"]\n" + repeats, "p.toml").rows.size(), 2u);
}

TEST(Plan, SeedsThatTheCommandDoesNotUseAreRefusedIfPlannedAndElseNotListed) {
  const Sweep planned = parsePlan(head + "[grid]\nseed = [1, 2]\n", "p.toml");
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { argumentsOf(planned, 0, "out"); }), "parameter seed: the command does not use it"));
  const Sweep used = parsePlan(head_with_seed + "[grid]\nseed = [5, 6]\n", "p.toml");
  EXPECT_EQ(argumentsOf(used, 1, "out"), (std::vector<std::string>{"run", "--seed=6"}));
  EXPECT_TRUE(
      contains(messageOf<BadFile>([&] { parsePlan(head_with_seed + "[grid]\nseed = [10000000000000001, 3]\n", "p.toml"); }), "2^53"));
  const Sweep unused = parsePlan("seed = 9\n" + head, "p.toml");
  for (const auto& [name, value] : unused.rows.at(0).parameters) EXPECT_NE(name, "seed");
}

TEST(Plan, LatinHypercubeHasOneValueInEveryPart) {
  const std::string text = head + "[latin_hypercube]\ncount = 50\na.x = {low = 2, high = 7}\na.y = {low = 1, high = 100, log = true}\n";
  const Sweep sweep = parsePlan(text, "plan.toml");
  std::set<int> parts_x, parts_y;
  for (const SweepRow& row : sweep.rows) {
    parts_x.insert(static_cast<int>((number(row, "a.x") - 2) / 5 * 50));
    parts_y.insert(static_cast<int>(std::log10(number(row, "a.y")) / 2 * 50));
  }
  EXPECT_EQ(parts_x.size(), 50u);
  EXPECT_EQ(parts_y.size(), 50u);
  // The two lists have different orders.
  EXPECT_FALSE(std::is_sorted(sweep.rows.begin(), sweep.rows.end(),
                              [](const auto& a, const auto& b) { return number(a, "a.x") < number(b, "a.x"); }));
}

TEST(Plan, RandomValuesFollowTheSeedAndStayInRange) {
  const std::string section =
      "[random]\ncount = 200\na.x = {low = -1, high = 1}\na.n = {low = 1, high = 3, integer = true}\n"
      "a.c = {choices = [\"u\", \"v\"]}\n";
  const Sweep first = parsePlan("seed = 3\n" + head + section, "p.toml"), again = parsePlan("seed = 3\n" + head + section, "p.toml"),
              other = parsePlan("seed = 4\n" + head + section, "p.toml");
  std::set<double> whole;
  int differing = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_EQ(first.rows[i].parameters, again.rows[i].parameters);
    differing += number(first.rows[i], "a.x") != number(other.rows[i], "a.x");
    EXPECT_LE(std::abs(number(first.rows[i], "a.x")), 1);
    whole.insert(number(first.rows[i], "a.n"));
  }
  EXPECT_EQ(whole, (std::set<double>{1, 2, 3}));
  EXPECT_GT(differing, 190);
}

TEST(Plan, RefusesWhatItDoesNotUnderstandNamingThePlace) {
  EXPECT_TRUE(contains(refusal("command = [\"run\"]"), "format"));
  EXPECT_TRUE(contains(refusal("format = \"musclesim-sweep-1\"\n"), "command"));
  EXPECT_TRUE(contains(refusal(head + "colour = 3\n"), "plan.toml:3:10: colour"));
  EXPECT_TRUE(contains(refusal(head + "[grid]\na.x = 3\n"), "plan.toml:4:7: a.x: must be a list"));
  EXPECT_TRUE(contains(refusal(head + "[grid]\na.x = []\n"), "a.x: must be a list"));
  EXPECT_TRUE(contains(refusal(head + "[grid]\na.x = [nan]\n"), "must be finite"));
  EXPECT_TRUE(contains(refusal(head + "[grid]\na.x = [true]\n"), "must be a number or a string"));
  EXPECT_TRUE(contains(refusal(head + "[list]\na.x = [1]\na.y = [1, 2]\n"), "a.y: has 2 values, a.x has 1"));
  EXPECT_TRUE(contains(refusal(head + "[random]\na.x = {low = 1, high = 2}\n"), "random.count: is missing"));
  EXPECT_TRUE(contains(refusal(head + "[random]\ncount = 0\n"), "whole number in 1 .."));
  EXPECT_TRUE(contains(refusal(head + "[random]\ncount = 2\na.x = {low = 3, high = 2}\n"), "low <= high"));
  EXPECT_TRUE(contains(refusal(head + "[random]\ncount = 2\na.x = {low = 0, high = 2, log = true}\n"), "log needs low > 0"));
  EXPECT_TRUE(contains(refusal(head + "[random]\ncount = 2\na.x = {low = 0, high = 2, colour = 1}\n"), "a.x.colour"));
  EXPECT_TRUE(contains(refusal(head + "[grid]\na.x = [1]\n[list]\na.x = [1]\n"), "given twice"));
  for (const std::string name : {"out", "row", "repeat", "status", "message"})
    EXPECT_TRUE(contains(refusal(head + "[grid]\n" + name + " = [1]\n"), name + ": is given twice or is a reserved name"));
  EXPECT_TRUE(contains(refusal(head + "[random]\ncount = 100000\n[repeats]\ncount = 2\n"), "at most"));
  EXPECT_TRUE(contains(refusal(head + "files = [\"recording\"]\n"), "without a folder"));
  EXPECT_TRUE(contains(refusal(head + "[grid\n"), "plan.toml:3"));
}

using PlanWithFiles = SweepTest;

TEST_F(PlanWithFiles, CopiesThemWithTheirSidecarsAndNotesTheirHashes) {
  fs::create_directories(folder_ / "data");
  for (const char* name : {"a.csv", "a.json", "b.csv"}) writeFile(folder_ / "data" / name, name);
  writeFile(folder_ / "plan.toml",
            "format = \"musclesim-sweep-1\"\ncommand = [\"replay\", \"{recording}\"]\nfiles = [\"recording\"]\n"
            "[grid]\nrecording = [\"data/a.csv\", \"data/b.csv\"]\nrig.load_kg = [1, 2]\n");
  fs::create_directories(folder_ / "sweep");
  writeSweep(readPlan(path("plan.toml"), path("sweep")), path("sweep"));
  const Sweep sweep = readSweep(path("sweep"));
  ASSERT_EQ(sweep.rows.size(), 4u);
  EXPECT_EQ(sweep.inputs.size(), 3u) << "each file once, though two rows read it";
  for (const auto& [input, hash] : sweep.inputs) EXPECT_TRUE(fs::exists(folder_ / "sweep" / input)) << input;
  const auto arguments = argumentsOf(sweep, 0, "out");
  EXPECT_EQ(contentOf(folder_ / "sweep" / arguments[1]), "a.csv");
}

TEST_F(PlanWithFiles, RefusesFilesThatAreNotThere) {
  writeFile(folder_ / "plan.toml", head + "files = [\"r\"]\n[grid]\nr = [\"absent.csv\"]\n");
  EXPECT_TRUE(contains(messageOf<IoError>([&] { readPlan(path("plan.toml"), path("sweep")); }), "absent.csv"));
}

}  // namespace
}  // namespace musclesim
