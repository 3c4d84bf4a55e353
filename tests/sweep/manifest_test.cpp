#include "musclesim/base/error.h"
#include "sweep/sweep_fixture.h"

namespace musclesim {
namespace {

class Manifest : public SweepTest {
 protected:
  /// The error for a manifest in which one piece of text is replaced.
  std::string refusalWith(const std::string& piece, const std::string& replacement) {
    if (text_.empty()) text_ = contentOf(sweepOf(2) + "/manifest.json");
    std::string text = text_;
    const auto at = text.find(piece);
    if (at == std::string::npos) return "no " + piece + " in the manifest";
    return messageOf<BadFile>([&] { parseSweep(text.replace(at, piece.size(), replacement), "m.json"); });
  }
  std::string text_;
};

TEST_F(Manifest, ReadsBackAsWritten) {
  Sweep sweep;
  sweep.command = {"run", "--a", "{b.c}", "{out}/{row}"};
  sweep.columns = {"x.*"};
  sweep.result_file = "r.json";
  sweep.row_time_limit_s = 2.5;
  sweep.seed = 17;
  sweep.rows = {{{{"b.c", 0.1}, {"d.e", "word with \"quotes\""}}, {}}, {{{"b.c", 1e-300}}, {"replay", "{b.c}"}}};
  writeSweep(sweep, path("sweep"));
  const Sweep read = readSweep(path("sweep"));
  EXPECT_EQ(read.columns, sweep.columns);
  EXPECT_EQ(read.result_file, "r.json");
  EXPECT_EQ(read.row_time_limit_s, 2.5);
  EXPECT_EQ(read.seed, 17u);
  EXPECT_FALSE(read.robots_hash.empty());
  EXPECT_EQ(argumentsOf(read, 0, "o"), (std::vector<std::string>{"run", "--a", "0.1", "o/000000", "--set", "d.e=word with \"quotes\""}));
  EXPECT_EQ(argumentsOf(read, 1, "o"), (std::vector<std::string>{"replay", "1e-300"}));
}

TEST_F(Manifest, IsNeverReplaced) {
  const std::string sweep = sweepOf(2), before = contentOf(sweep + "/manifest.json");
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { sweepOf(3); }), "holds a sweep already"));
  EXPECT_EQ(contentOf(sweep + "/manifest.json"), before);
}

TEST_F(Manifest, RefusesWhatItDoesNotUnderstand) {
  EXPECT_TRUE(contains(refusalWith("musclesim-sweep-1", "musclesim-sweep-2"), "m.json:2:3: format"));
  EXPECT_TRUE(contains(refusalWith("\"seed\": 1", "\"seed\": -1"), "seed"));
  EXPECT_TRUE(contains(refusalWith("\"seed\": 1", "\"speed\": 1"), "\"speed\" is not known"));
  EXPECT_TRUE(contains(refusalWith("\"x\":1", "\"x\":[1]"), "rows[1]: \"x\""));
  EXPECT_TRUE(contains(refusalWith("\"x\":1", "\"y\":1"), "{x}"));
  EXPECT_TRUE(contains(refusalWith("\"{x}\"", "\"{x\""), "without }"));
  EXPECT_TRUE(contains(refusalWith("\"{x}\",", ""), "the command does not use it"));
  EXPECT_TRUE(contains(refusalWith("\"rows\": [", "\"rows\": [["), "JSON"));
  EXPECT_TRUE(contains(refusalWith("\"inputs\": {}", "\"inputs\": {\"inputs/../../etc\": \"\"}"), "below inputs/"));
}

TEST_F(Manifest, RefusesValuesThatAreNoNumbers) {
  Sweep sweep;
  sweep.command = {"run"};
  sweep.rows = {{{{"a.b", std::numeric_limits<double>::infinity()}}, {}}};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { writeSweep(sweep, path("sweep")); }), "must be finite"));
  EXPECT_FALSE(fs::exists(path("sweep/manifest.json")));
}

}  // namespace
}  // namespace musclesim
