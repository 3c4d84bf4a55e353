// Making, running and scoring small blind checks: no larger than their rules need.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "evaluation/blind/cause.h"
#include "evaluation/blind/excitation.h"
#include "evaluation/blind/follow_up.h"
#include "evaluation/blind/make.h"
#include "evaluation/blind/run.h"
#include "evaluation/blind/score.h"
#include "evaluation/blind/seal.h"
#include "evaluation/blind/sha256.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/robot/robot_file.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim::blind {
namespace {

namespace fs = std::filesystem;

/// A fresh folder with room for cases and, elsewhere, for keys; removed at the end.
class Blind : public ::testing::Test {
 public:
  ~Blind() override { fs::remove_all(root_); }

 protected:
  Blind() : root_(fs::temp_directory_path() / ("musclesim_blind_" + std::to_string(::getpid()) + "_" + testName())) {
    fs::remove_all(root_);
    fs::create_directories(root_ / "work");
  }

  static std::string testName() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }
  fs::path cases(const std::string& name = "cases") const { return root_ / "work" / name; }
  fs::path keys(const std::string& name = "a") const { return root_ / "far" / "away" / name; }

  static MakeOptions tiny(const std::vector<std::string>& kinds, std::uint64_t seed = 3) {
    MakeOptions options;
    options.count = 1;
    options.arm_count = 0;
    options.robots = {"rig"};
    options.exact_numbers = true;
    options.seed = seed;
    options.duration_s = 1;
    options.kinds = kinds;
    options.job_count = 2;
    return options;
  }
  static RunOptions few() {
    RunOptions options;
    options.candidates = {"payload"};
    options.job_count = 2;
    return options;
  }

  fs::path root_;
};

void append(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::app) << text;
}

TEST(BlindSha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_F(Blind, AllLawsHaveTheirTurn) {
  Simulation simulation;
  const Robot& elbow = simulation.build("elbow");
  const std::vector<std::string> signals = {"angle_elbow_deg", "pressure_0", "pressure_1"};
  std::set<std::string> first;
  const std::size_t count = lawsInTurn(elbow, signals, false, {}, 5, 0).size();
  for (std::size_t turn = 0; turn < outOfCatalogueLaws().size(); ++turn) {
    const auto laws = lawsInTurn(elbow, signals, false, {}, 5, turn);
    EXPECT_EQ(laws.size(), count) << "all of them, wherever it begins";
    first.insert(laws.front().info.id);
  }
  EXPECT_EQ(first.size(), count);
  EXPECT_NE(lawsInTurn(elbow, signals, false, {}, 5, 0).front().info.id, lawsInTurn(elbow, signals, false, {}, 6, 0).front().info.id);
  const auto leaks = lawsInTurn(elbow, signals, false, {"leak"}, 5, 3);
  ASSERT_EQ(leaks.size(), 1u);
  EXPECT_EQ(leaks[0].stands_for, "leak");
  for (const OutOfCatalogueLaw& law : lawsInTurn(elbow, signals, true, {"leak"}, 5, 0)) EXPECT_TRUE(law.stands_for.empty()) << law.info.id;
}

TEST_F(Blind, MakesOnlyTheCausesAskedFor) {
  MakeOptions options = tiny({"single"});
  options.causes = {"payload"};
  const nlohmann::json key = readObject(make(cases(), keys(), options));
  EXPECT_EQ(key["cases"]["case001"]["effects"][0]["id"], "payload");
  options.causes = {"paylod"};
  EXPECT_THROW(make(cases("other"), keys("b"), options), BadParameter);
}

TEST_F(Blind, DrawsNoCauseWhereTheCatalogueHasNone) {
  Simulation simulation;
  const Robot& rig = simulation.build("rig");
  for (const OutOfCatalogueLaw& law : outOfCatalogueLaws()) {
    const auto components = componentsOf(law, rig, {"length_0_mm", "pressure_0", "force_0_N"});
    if (law.stands_for == "sensor_bias") {
      EXPECT_EQ(components.size(), 3u);
    }
    if (law.stands_for != "sensor_backlash") continue;
    EXPECT_EQ(components, std::vector<std::string>{"signal_length_0"});  // none in a gauge
  }
}

TEST_F(Blind, MakesTheSameCasesFromTheSameSeed) {
  const fs::path one = make(cases("one"), keys("one"), tiny({"single"})), two = make(cases("two"), keys("two"), tiny({"single"}));
  EXPECT_EQ(sha256OfFile(one), sha256OfFile(two));
  EXPECT_EQ(readSeal(cases("one"))["recordings_sha256"], readSeal(cases("two"))["recordings_sha256"]);
  EXPECT_NE(one.filename(), two.filename());
  const fs::path other = make(cases("other"), keys("other"), tiny({"null"}, 4));
  EXPECT_NE(readSeal(cases("one"))["recordings_sha256"], readSeal(cases("other"))["recordings_sha256"]);
}

TEST_F(Blind, CasesOfARobotFromAFileCanBeMoved) {
  const fs::path file = cases("own") / "own_rig.toml";
  fs::create_directories(file.parent_path());
  append(file, std::string(std::ranges::find(shippedRobots(), "rig", &ShippedRobot::name)->text));
  MakeOptions options = tiny({"null"});
  options.robots = {file.string()};
  make(cases(), keys(), options);
  fs::remove_all(file.parent_path());
  fs::rename(cases(), cases("moved"));
  const Recording recording = readRecording((cases("moved") / "case001" / "r1.csv").string());
  EXPECT_EQ(recording.info.robot, (cases("moved") / "robots" / "own_rig.toml").string());
  EXPECT_NO_THROW(Simulation().build(recording.info.robot));
}

/// A forearm whose inertia about the hinge is smaller than that of its mass at its centre is no body. With this tolerance many draws
/// make none.
TEST_F(Blind, DrawsNumbersAgainThatMakeNoBody) {
  const fs::path file = cases("own") / "vague_elbow.toml";
  fs::create_directories(file.parent_path());
  std::string text(std::ranges::find(shippedRobots(), "elbow", &ShippedRobot::name)->text);
  const std::string of_inertia = "tolerance = 0.15";
  ASSERT_NE(text.find(of_inertia), std::string::npos);
  text.replace(text.find(of_inertia), of_inertia.size(), "tolerance = 1");
  append(file, text);
  MakeOptions options = tiny({"null"});
  options.robots = {file.string()};
  options.exact_numbers = false;
  options.count = 8;
  EXPECT_NO_THROW(make(cases(), keys(), options));
}

TEST_F(Blind, SealsAKeyThatTheRecordingsDoNotTell) {
  const fs::path key_file = make(cases(), keys(), tiny({"single"}));
  const nlohmann::json seal = readSeal(cases()), key = readObject(key_file);
  EXPECT_EQ(seal["key_file"], key_file.filename().string());
  EXPECT_EQ(seal["key_sha256"], sha256OfFile(key_file));
  for (const auto& [name, entry] : key["cases"].items()) {
    const std::string size = entry["size"];
    const double gap = entry["effects"][0]["gap_over_noise"];
    EXPECT_TRUE(bandOf(size, entry["effects"][0]["id"]).holds(gap)) << name << ": " << size << " " << gap;
    EXPECT_TRUE(entry["effects"][0]["law"].get<std::string>().starts_with("foreign."));
    const Recording recording = readRecording((cases() / name / "r1.csv").string());
    EXPECT_TRUE(recording.info.active_effects.empty());
    EXPECT_FALSE(recording.info.seed.has_value());
    EXPECT_EQ(recording.info.extra_json, "{}");
  }
}

TEST_F(Blind, RefusesAKeyFolderThatRunWouldFind) {
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { make(cases(), cases() / "keys", tiny({"null"})); }), "--keys"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { make(cases(), cases(), tiny({"null"})); }), "--keys"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { make(cases(), cases().parent_path() / "keys", tiny({"null"})); }), "--keys"));
  EXPECT_FALSE(fs::exists(cases()));
}

TEST_F(Blind, DoesNotRunWhileTheKeyCanBeRead) {
  const fs::path key = make(cases(), keys(), tiny({"null"}));
  for (const fs::path& place : {cases() / "case001", cases(), cases().parent_path(), cases().parent_path() / "beside"}) {
    fs::create_directories(place);
    fs::copy_file(key, place / key.filename());
    EXPECT_TRUE(contains(messageOf<BadParameter>([&] { run(cases(), few()); }), "the key can be read")) << place;
    fs::remove(place / key.filename());
  }
  EXPECT_FALSE(fs::exists(cases() / "answers"));
}

TEST_F(Blind, GoesOnMakingWhereItWasStopped) {
  MakeOptions three = tiny({"null"});
  three.count = 3;
  three.job_count = 1;
  int asked = 0;
  MakeOptions stopped = three;
  stopped.interrupted = [&] { return ++asked > 2; };
  EXPECT_TRUE(make(cases(), keys(), stopped).empty());
  EXPECT_FALSE(fs::exists(cases() / "seal.json"));
  const auto first = fs::last_write_time(cases() / "case001" / "r1.csv");
  fs::create_directories(cases() / "case003");  // a case whose key was not kept is made anew
  append(cases() / "case003" / "r1.csv", "half a recording");
  int made = 0;
  three.progress = [&](int done, int) { made = done; };
  const fs::path key = make(cases(), keys(), three), at_once = make(cases("once"), keys("c"), three);
  EXPECT_EQ(made, 3);
  EXPECT_EQ(fs::last_write_time(cases() / "case001" / "r1.csv"), first);
  EXPECT_EQ(readTextFile(key.string(), 1 << 20), readTextFile(at_once.string(), 1 << 20));
  EXPECT_EQ(readSeal(cases()).at("recordings_sha256"), readSeal(cases("once")).at("recordings_sha256"));
  EXPECT_FALSE(fs::exists(keys() / "unsealed"));
}

TEST_F(Blind, DoesNotGoOnWithTheCasesOfAnotherCall) {
  MakeOptions two = tiny({"null"});
  two.count = 2;
  two.job_count = 1;
  int asked = 0;
  two.interrupted = [&] { return ++asked > 1; };
  EXPECT_TRUE(make(cases(), keys(), two).empty());
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { make(cases(), keys(), tiny({"null"})); }), "another program or call"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { make(cases(), keys("b"), tiny({"null"})); }), "new or empty"));
  EXPECT_FALSE(fs::exists(keys("b") / "unsealed"));
}

TEST_F(Blind, StopsInTheMiddleOfACase) {
  MakeOptions one = tiny({"single"});
  int asked = 0;
  one.interrupted = [&] { return ++asked > 1; };  // not yet when the case begins, but when its cause is drawn
  EXPECT_TRUE(make(cases(), keys(), one).empty());
  EXPECT_FALSE(fs::exists(cases() / "case001"));
}

TEST_F(Blind, RunsResumesAndScores) {
  MakeOptions two = tiny({"null"});
  two.count = 2;
  const fs::path key = make(cases(), keys(), two);
  RunOptions stopped = few();
  int asked = 0;
  stopped.job_count = 1;
  stopped.interrupted = [&] { return ++asked > 1; };
  EXPECT_FALSE(run(cases(), stopped).complete());
  EXPECT_FALSE(fs::exists(cases() / "answers.json"));
  EXPECT_TRUE(run(cases(), few()).complete());
  const std::string first = sha256OfFiles(cases(), answerFiles(cases()));
  fs::remove_all(cases() / "answers");
  RunOptions alone = few();
  alone.job_count = 1;
  EXPECT_TRUE(run(cases(), alone).complete());
  EXPECT_EQ(sha256OfFiles(cases(), answerFiles(cases())), first);
  const Score found = score(cases(), key);
  EXPECT_EQ(found.totals["all"]["verdict"]["hits"], 2);
  EXPECT_EQ(found.totals["all"]["false_alarm"]["hits"], 0);

  RunOptions others = few();
  others.candidates = {"creep"};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { run(cases(), others); }), "candidates"));

  others.candidates = {"nonsense"};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { run(cases(), others); }), "nonsense"));

  RunOptions without = few();
  without.leave_out = {"tempering"};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { run(cases(), without); }), "left_out"));
  without.leave_out = {"templates"};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { run(cases(), without); }), "nuisances, stand_ins, tempering"));

  append(cases() / "answers" / "case001.json", " ");
  EXPECT_TRUE(run(cases(), few()).complete()) << "nothing is left to do";
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { score(cases(), key); }), "answers were changed"));
}

/// The page names the commits by which the cases were diagnosed, not that of the last call.
TEST_F(Blind, NotesTheCommitsOfTheAnswers) {
  make(cases(), keys(), tiny({"null"}));
  RunOptions first = few(), later = few();
  first.commit = "1234abc";
  later.commit = "1234abc-dirty";
  run(cases(), first);
  run(cases(), later);
  EXPECT_EQ(readObject(cases() / "answers.json")["commit"], "1234abc");
}

TEST_F(Blind, RefusesAKeyAndRecordingsThatWereChanged) {
  const fs::path key = make(cases(), keys(), tiny({"null"}));
  run(cases(), few());
  append(key, " ");
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { score(cases(), key); }), "the key was changed"));
  fs::resize_file(key, fs::file_size(key) - 1);
  EXPECT_NO_THROW(score(cases(), key));
  append(cases() / "case001" / "r4.csv", "9,0.4\n");
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { score(cases(), key); }), "recordings were changed"));
}

TEST_F(Blind, FollowsUpOnAnswersOnce) {
  MakeOptions single = tiny({"single"}, 7);
  single.duration_s = 2;
  single.causes = {"transport_delay"};  // nothing that the tolerances of the model's numbers could explain
  const fs::path key_file = make(cases(), keys(), single);
  const std::string truth = readObject(key_file)["cases"]["case001"]["effects"][0]["id"];
  RunOptions options = few();
  options.candidates = {truth, truth == "payload" ? "sensor_bias" : "payload"};
  run(cases(), options);
  EXPECT_TRUE(score(cases(), key_file).totals["follow_up"].empty());
  FollowUpOptions follow;
  follow.job_count = 1;
  follow.candidates = options.candidates;
  followUp(cases(), key_file, follow);
  const fs::path file = cases() / "follow_up" / "case001.json";
  const nlohmann::json found = readObject(file);
  const nlohmann::json totals = score(cases(), key_file).totals["follow_up"];
  EXPECT_EQ(totals["followed_count"], 1);
  EXPECT_EQ(totals["left_out_unexplained"]["count"], 1);
  for (const nlohmann::json& effect : found["left_out"]["effects"]) EXPECT_NE(effect["id"], truth);
  ASSERT_EQ(readObject(cases() / "answers" / "case001.json")["verdict"], "effects_found");
  // What an effect gains under other commands is the study's question; here it must be a gain, and be compared as it says.
  const double reduction = found["fresh"]["shrink_percent"];
  EXPECT_GT(reduction, 50);
  if (found["fresh"].contains("interval_percent")) {
    const std::vector<double> interval = found["fresh"]["interval_percent"];
    EXPECT_EQ(totals["fresh_within"]["hits"], interval[0] <= reduction && reduction <= interval[1] ? 1 : 0);
  } else {
    EXPECT_FALSE(totals.contains("fresh_within"));
  }
  append(file, " ");
  const std::string mark = sha256OfFile(file);
  followUp(cases(), key_file, follow);
  EXPECT_EQ(sha256OfFile(file), mark) << "a case was done again";
  FollowUpOptions others = follow;
  others.candidates = {"payload"};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { followUp(cases(), key_file, others); }), "candidates"));
  append(cases() / "answers" / "case001.json", " ");
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { followUp(cases(), key_file, follow); }), "answers were changed"));
}

TEST(BlindExcitation, StaysBetweenMinusOneAndOneAndRestsAtFirst) {
  for (const char* kind : {"triangle", "steps", "reversals", "multisine", "holds"})
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      RandomStream random(seed, "test");
      const std::vector<double> shape = shapeOf(kind, seed % 2 ? 0.6 : 1.6, 6, random);
      ASSERT_EQ(shape.size(), 600U);
      double largest = 0;
      for (std::size_t row = 0; row < shape.size(); ++row) {
        if (row <= 30) {
          EXPECT_EQ(shape[row], 0) << kind;
        }
        largest = std::max(largest, std::abs(shape[row]));
      }
      EXPECT_LE(largest, 1) << kind;
      EXPECT_GT(largest, 0.2) << kind;
    }
}

TEST(BlindSizes, ScaleAwayFromNeutral) {
  EffectInfo law;
  law.parameters = {{"gain", "", 1, 0, 10, 0.8, 1.2, ""},
                    {"rate_per_s", "1/s", INFINITY, 0.01, INFINITY, 0.3, 2, ""},
                    {"bits", "bit", INFINITY, 1, INFINITY, 4, 7, ""},
                    {"period_s", "s", 3, 0, 10, 1, 5, "", true}};
  EXPECT_EQ(scaled(law, {1.1, 1, 6, 2}, 2), (std::vector<double>{1.2000000000000002, 0.5, 5, 2}));
  EXPECT_FALSE(scaled(law, {1.1, 1, 6, 2}, 20));
}

}  // namespace
}  // namespace musclesim::blind
