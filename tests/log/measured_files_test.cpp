/// The files of other laboratories and the small failing inputs after public reports, each with a mapping alone. Skipped without the data.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "musclesim/base/error.h"
#include "musclesim/log/import.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;
using Values = std::vector<double>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string mapping(const std::string& name) {
  return std::string(MUSCLESIM_FIELD_MAPPINGS) + "/" + name + ".toml";
}

std::string example(const std::string& name) {
  return std::string(MUSCLESIM_IMPORT_EXAMPLES) + "/" + name + ".toml";
}

void expectValues(const Recording& recording, const std::string& name, const Values& expected) {
  const Signal* signal = recording.find(name);
  const Values& values = name == "time_s" ? recording.time_s : signal ? signal->values : Values{};
  ASSERT_EQ(values.size(), expected.size()) << name;
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (std::isnan(expected[i]))
      EXPECT_TRUE(std::isnan(values[i])) << name << " " << i << ": " << values[i];
    else
      EXPECT_NEAR(values[i], expected[i], 1e-9) << name << " " << i;
}

bool hasNote(const Recording& recording, const std::string& text) {
  return std::ranges::any_of(recording.notes, [&](const std::string& note) { return contains(note, text); });
}

class FieldFiles : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(field_)) GTEST_SKIP() << "no inputs at " << field_;
  }
  std::string file(const std::string& name) const { return (field_ / name).string(); }
  Recording import(const std::string& table, const std::string& with) const { return importTable(file(table), readImportMapping(with)); }
  std::string refusal(const std::string& table, const std::string& with) const {
    return messageOf<BadFile>([&] { import(table, file(with)); });
  }

 private:
  fs::path field_ = sharedFolder() / "data" / "field";
};

TEST_F(FieldFiles, Case05TwoColumnsOfOneName) {
  EXPECT_TRUE(contains(refusal("05/two_signals.csv", "05/map.toml"), "several columns are named \"time\": 1 and 4"));
  expectValues(import("05/two_signals.csv", mapping("05_by_number")), "length_0_mm", {250, 248, 249});
}

TEST_F(FieldFiles, Case06ASecondClock) {
  const Recording brief = import("06/valve.csv", file("06/short.toml"));
  expectValues(brief, "length_0_mm", {250, 240, nan, nan, nan});
  EXPECT_TRUE(hasNote(brief, "3 of 5 rows lie outside of its own times"));
  const Recording gap = import("06/valve.csv", file("06/gap.toml"));
  expectValues(gap, "length_0_mm", {250, nan, nan, nan, 239});
  EXPECT_TRUE(hasNote(gap, "3 of 5 rows lie in gaps"));
  EXPECT_TRUE(contains(refusal("06/valve.csv", "06/milliseconds.toml"), "time_factor = 0.001"));
  expectValues(import("06/valve.csv", mapping("06_milliseconds")), "length_0_mm", {250, 240, 230, 240, 250});
  EXPECT_TRUE(contains(refusal("06/valve.csv", "06/other_zero.toml"), "they do not overlap"));
  expectValues(import("06/valve.csv", mapping("06_other_zero")), "length_0_mm", {250, 240, 230, 240, 250});
  EXPECT_TRUE(contains(refusal("06/valve.csv", "06/early.toml"), "early.toml:10:1: rows.from_s: -2"));
  expectValues(import("06/valve.csv", mapping("06_rest")), "command_0",
               {0, 1 / 6., 1 / 6., 2 / 6., 2 / 6., 3 / 6., 3 / 6., 2 / 6., 2 / 6., 1 / 6.});
}

TEST_F(FieldFiles, Case07MergedTopics) {
  const Recording merged = import("07/merged.csv", file("07/map.toml"));
  const double low = 1 / 6., high = 2 / 6.;
  ASSERT_GE(merged.time_s.size(), 7U);
  EXPECT_EQ(merged.find("length_0_mm")->values[1], 250);
  EXPECT_TRUE(std::isnan(merged.find("length_0_mm")->values[3]));
  for (std::size_t row = 0; row < 6; ++row) EXPECT_NEAR(merged.find("command_0")->values[row], row < 3 ? low : high, 1e-9) << row;
  const Recording even = import("07/merged.csv", file("07/even.toml"));
  EXPECT_NEAR(even.find("length_0_mm")->values[1], 250 - (0.05 - 0.012) / (0.055 - 0.012), 1e-6);
  EXPECT_NEAR(even.find("command_0")->values[1], low, 1e-9);
}

TEST_F(FieldFiles, Case08AsInstrumentsWrite) {
  EXPECT_TRUE(contains(refusal("08/tensile_tester.csv", "08/tensile.toml"), "needs skip_after_header = 1"));
  const Recording tensile = import("08/tensile_tester.csv", mapping("08_tensile"));
  EXPECT_NEAR(tensile.find("force_0_N")->values[1], 0.021, 1e-12);
  EXPECT_NEAR(tensile.find("length_0_mm")->values[2], 660.0008, 1e-9);
  EXPECT_TRUE(contains(refusal("08/oscilloscope.csv", "08/scope.toml"), "needs skip_after_header = 1"));
  const Recording scope = import("08/oscilloscope.csv", mapping("08_scope"));
  EXPECT_NEAR(scope.time_s[2], 0.02, 1e-12);
  EXPECT_NEAR(scope.find("command_0")->values[1], 0.28, 1e-12);
  EXPECT_NEAR(scope.find("pressure_0")->values[1], 0.6, 1e-12);
  EXPECT_TRUE(contains(refusal("08/decimal_comma.csv", "08/comma.toml"), "needs separator = \";\""));
  const Recording comma = import("08/decimal_comma.csv", mapping("08_comma"));
  expectValues(comma, "time_s", {0, 0.1, 0.2});
  expectValues(comma, "length_0_mm", {250, 249.5, 249.1});
  EXPECT_TRUE(contains(refusal("08/latin1.csv", "08/latin1.toml"), "the mapping's [table] may name the encoding"));
  expectValues(import("08/latin1.csv", mapping("08_latin1")), "angle_elbow_deg", {2.5, 2.6});
}

TEST_F(FieldFiles, Case09WithoutHeader) {
  EXPECT_TRUE(contains(refusal("09/no_header.csv", "09/map.toml"), "the first row holds numbers: a table without a header?"));
  const Recording bare = import("09/no_header.csv", mapping("09_no_header"));
  expectValues(bare, "time_s", {0, 0.001, 0.002, 0.003});
  expectValues(bare, "force_0_N", {4, 7, 5, 8});
  expectValues(import("09/percent_comment.csv", mapping("09_percent")), "length_0_mm", {250, 248});
  expectValues(import("09/spaces.txt", mapping("09_spaces")), "length_0_mm", {250, 248, 247});
}

TEST_F(FieldFiles, Case10DatesAndCounters) {
  EXPECT_TRUE(contains(refusal("10/micros_overflow.csv", "10/map.toml"), "there is no column \"time\""));
  expectValues(import("10/imu_logger.csv", mapping("10_imu")), "time_s", {0, 0.013, 0.025});
  expectValues(import("10/date_and_time.csv", mapping("10_date_and_time")), "time_s", {0, 0.01, 0.02});
  expectValues(import("10/micros_overflow.csv", mapping("10_overflow")), "time_s", {0, 0.01, 0.029996, 0.039996});
}

TEST_F(FieldFiles, Case11ALineThatIsCut) {
  const Recording cut = import("11/cut.csv", file("11/map.toml"));
  expectValues(cut, "length_0_mm", {250, 248.5});
  EXPECT_TRUE(hasNote(cut, "the last line has no line end and may be cut"));
}

class RealFiles : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(real_)) GTEST_SKIP() << "no measurements at " << real_;
  }
  std::string file(const std::string& name) const { return (real_ / name).string(); }
  Recording import(const std::string& table, const std::string& with) const {
    return importTable(file(table), readImportMapping(example(with)));
  }

 private:
  fs::path real_ = sharedFolder() / "data" / "real";
};

TEST_F(RealFiles, BellowsAsTheLoggerWroteThem) {
  for (const auto& [logged, imported] :
       {std::pair<const char*, const char*>{"16067V", "rec_7"}, {"16069V", "rec_9"}, {"160611V", "rec_11"}}) {
    const Recording r = import(std::string("bellows/") + logged + ".txt", "bellows");
    const Recording expected = readRecording(file(std::string("bellows/") + imported + ".csv"));
    ASSERT_EQ(r.time_s.size(), expected.time_s.size()) << logged;
    for (const char* name : {"angle_elbow_deg", "pressure_0", "pressure_1", "command_0", "command_1"})
      for (std::size_t row = 0; row < r.time_s.size(); ++row)
        ASSERT_NEAR(r.find(name)->values[row], expected.find(name)->values[row], 1e-9) << logged << " " << name << " " << row;
  }
}

TEST_F(RealFiles, TensileTestsAsTheTesterWroteThem) {
  const Recording big = import("quadsegrity/Big3.csv", "tensile_test"), thin = import("quadsegrity/Small4.csv", "tensile_test_thin");
  EXPECT_EQ(big.find("command_0")->values.front(), 0.5);
  EXPECT_NEAR(big.find("length_0_mm")->values.front(), 660, 1e-9);
  EXPECT_NEAR(big.time_s.back(), 78.7, 1e-9);
  EXPECT_NEAR(thin.find("command_0")->values.front(), 4. / 6, 1e-9);
  EXPECT_NEAR(thin.find("length_0_mm")->values.front(), 640, 1e-9);
  EXPECT_NEAR(thin.find("force_0_N")->values.front(), 0.11397, 1e-9);
  EXPECT_NEAR(thin.time_s.back(), 42, 1e-9);
  EXPECT_NEAR(thin.find("length_0_mm")->values.back(), 640 + 42 * 0.49936, 0.02) << "pulled by half a mm per second";
}

TEST_F(RealFiles, LeaksAndFillings) {
  for (const char* number : {"1", "4"}) {
    const Recording fill = import(fmt::format("psu-bpa-fill-leak/fill_{}.csv", number), "fill");
    EXPECT_GT(fill.find("pressure_0")->values.back(), 0.9) << number;
  }
  const Recording leak = import("psu-bpa-fill-leak/leak_1.csv", "leak");
  EXPECT_EQ(leak.time_s.size(), 250U);
  EXPECT_NEAR(leak.time_s[10], 10, 1e-9) << "the clock begins again";
  EXPECT_NEAR(leak.time_s.back(), 129.643, 1e-9);
  EXPECT_NEAR(leak.find("pressure_0")->values.front(), 152.84 / 650, 0.01 / 650) << "the laboratory's own conversion";
  EXPECT_NEAR(leak.find("pressure_0")->values.back(), 99.26 / 650, 0.01 / 650);
  EXPECT_NEAR(import("psu-bpa-fill-leak/leak_4.csv", "leak").find("pressure_0")->values.back(), 339.60 / 650, 0.01 / 650);
}

TEST_F(RealFiles, ForcesAtFixedLengths) {
  const Recording rest = import("psu-bpa10-isometric/raw_L20cm_l182.0mm_test8.csv", "isometric_rest");
  EXPECT_NEAR(rest.find("command_0")->values.front(), 8.18 / 620, 1e-9);
  EXPECT_NEAR(rest.find("force_0_N")->values.front(), 13.123, 1e-9);
  EXPECT_GT(import("psu-bpa10-isometric/raw_L20cm_l174.5mm_test10.csv", "isometric").time_s.size(), 1000U);
}

TEST_F(RealFiles, StepsCreepAndLoopsOfAFestoMuscle) {
  const Recording creep = import("zagreb-dmsp10-250/creep_down_median_profile.csv", "creep");
  EXPECT_EQ(creep.time_s.size(), 17U);
  EXPECT_NEAR(creep.find("length_0_mm")->values.front(), 240, 1e-9);
  EXPECT_NEAR(creep.find("length_0_mm")->values.back(), 250 - 2.193, 1e-9);
  const Recording step = import("zagreb-dmsp10-250/step_up_0_to_4p074V_100Hz.csv", "bench_step");
  EXPECT_EQ(step.find("command_0")->values.front(), 0) << "the rest before the step";
  EXPECT_NEAR(step.find("command_0")->values[1], 0.4074, 1e-9);
  EXPECT_NEAR(step.find("pressure_0")->values[1], -30 / 600., 1e-9) << "the vented sensor reads -0.30 bar";
  const Recording loop = import("zagreb-dmsp10-250/quasistatic_cycle1_0p1V.csv", "bench_loop");
  EXPECT_EQ(loop.time_s.size(), 2 * 203U);
  EXPECT_NEAR(loop.find("length_0_mm")->values[1], 250.049, 1e-9);
}

TEST_F(RealFiles, WristOfADrummingRobot) {
  const Recording step = import("porcaro-drum-arm/raw_step_response.csv", "wrist_step");
  EXPECT_EQ(step.find("angle_wrist_deg")->values[1], -0.54);
  const Recording commands = import("porcaro-drum-arm/fig1c_sweep_command.csv", "sweep_command");
  EXPECT_NEAR(commands.find("command_0")->values.front(), 0.5 / 0.6, 1e-9);
  EXPECT_NEAR(commands.find("command_1")->values.front(), 0.1 / 0.6, 1e-9);
  // A table of errors by motion is no measurement over time.
  const std::string errors = messageOf<BadFile>([&] { import("porcaro-drum-arm/authors_sim_vs_real_wrist_rmse.csv", "wrist_step"); });
  EXPECT_TRUE(contains(errors, "wrist_step.toml:10:1: columns.time_s: "));
  EXPECT_TRUE(contains(errors, "there is no column \"time_s\"; the columns are motion, table_deg"));
}

TEST_F(RealFiles, RecordingsAreReadAsTheyAre) {
  for (const char* load : {"100", "200", "300", "400", "400_long", "500"}) {
    const Recording r = readRecording(file(fmt::format("cavatappi/rec_{}.csv", load)));
    EXPECT_EQ(r.info.robot, "rig") << load;
    EXPECT_GT(r.time_s.size(), 1000U) << load;
  }
}

}  // namespace
}  // namespace musclesim
