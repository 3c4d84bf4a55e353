// A diagnosis that goes on from the simulations of one that was killed or interrupted gives the answer of one that never was.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <ctime>
#include <filesystem>

#include "../planted.h"
#include "musclesim/base/file.h"
#include "musclesim/base/random.h"
#include "musclesim/base/record_file.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

/// diagnosis.json and report without the time that the diagnosis took.
std::string answerOf(Diagnosis diagnosis) {
  diagnosis.wall_s = 0;
  return diagnosisJson(diagnosis) + diagnosisReport(diagnosis);
}

double processorS() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

class ResumedDiagnosis : public testing::Test {
 protected:
  void TearDown() override { fs::remove(name_); }
  Diagnosis diagnosed(RecordFile* kept, std::function<bool()> interrupted = {}) const {
    DiagnosisOptions options = planted::few({"payload", "valve_lag"});
    options.tune = {"rig.load_kg"};
    options.max_effects = 2;
    options.model.parameters.set("muscle.model", std::string("line"), "test");  // fast
    options.kept = kept;
    options.interrupted = std::move(interrupted);
    return diagnose(recordings_, options);
  }
  const std::vector<Recording> recordings_ = planted::withExactModel(
      planted::plant({{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.05}, {"vent_time_constant_s", 0.05}}}}));
  const std::string name_ = (fs::temp_directory_path() / ("musclesim_resume_test_" + std::to_string(getpid()))).string();
};

TEST_F(ResumedDiagnosis, GivesTheSameBytesWhereverItWasKilled) {
  constexpr std::size_t limit_bytes = std::size_t{1} << 30;
  const double start_s = processorS();
  const Diagnosis without = diagnosed(nullptr);
  const double without_s = processorS() - start_s;
  const std::string answer = answerOf(without);
  std::size_t simulations = 0;
  {
    RecordFile kept(name_);
    kept.begin("origin");
    const double begin_s = processorS();
    const Diagnosis with = diagnosed(&kept);
    const double with_s = processorS() - begin_s;
    EXPECT_EQ(answerOf(with), answer);
    fmt::print("{} simulations, {:.1f} MB kept; {:.2f} s of processor time with the file, {:.2f} s without\n", with.simulation_count,
               1e-6 * static_cast<double>(kept.sizeBytes()), with_s, without_s);
  }
  const std::string whole = readTextFile(name_, limit_bytes);
  {
    RecordFile kept(name_);
    simulations = kept.resume();
    EXPECT_GT(simulations, 100u);
    const double begin_s = processorS();
    EXPECT_EQ(answerOf(diagnosed(&kept)), answer);
    const double again_s = processorS() - begin_s;
    fmt::print("{:.2f} s if all {} are kept\n", again_s, simulations);
    EXPECT_LT(again_s, without_s / 2);
  }
  RandomStream random(1, "killed");
  for (int i = 0; i < 2; ++i) {
    replaceFile(name_, whole.substr(0, static_cast<std::size_t>(random.uniform() * static_cast<double>(whole.size()))));
    RecordFile kept(name_);
    ASSERT_FALSE(kept.origin().empty());
    EXPECT_LT(kept.resume(), simulations);
    EXPECT_EQ(answerOf(diagnosed(&kept)), answer);
    EXPECT_EQ(kept.sizeBytes(), whole.size()) << "what was lost is kept again";
  }
}

TEST_F(ResumedDiagnosis, GoesOnFromAnInterruptWithoutWhatWasCut) {
  RecordFile kept(name_);
  kept.begin("origin");
  std::atomic<long> asked = 0;
  const Diagnosis partial = diagnosed(&kept, [&] { return ++asked > 20'000; });
  EXPECT_TRUE(partial.partial);
  const std::size_t before = kept.sizeBytes();
  const Diagnosis whole = diagnosed(&kept);
  EXPECT_GT(kept.sizeBytes(), before);
  EXPECT_FALSE(whole.partial);
  EXPECT_EQ(answerOf(whole), answerOf(diagnosed(nullptr)));
}

}  // namespace
}  // namespace musclesim
