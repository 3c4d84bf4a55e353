#include "musclesim/log/import.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

class ImportTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_import_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  Recording import(const std::string& table, const std::string& mapping) {
    return importTable(write("data.csv", table), readImportMapping(write("map.toml", mapping)));
  }
  fs::path folder_;
};

constexpr const char* head = "robot = \"rig\"\npressure_full_scale_kPa = 600\n";

TEST_F(ImportTest, TakesColumnsInTheirUnitsScaledShiftedAndLimited) {
  const Recording r = import("t,u,side,stroke\n0,0.3,left,0\n0.5,0.7,left,4\n",
                             std::string(head) +
                                 "trial = \"t\"\n[columns]\ntime_s = \"t\"\ncommand_0_MPa = { from = \"u\", maximum = 0.6 }\n"
                                 "pressure_0_bar = { value = 3 }\nlength_0_mm = { from = \"stroke\", factor = -1, offset = 250 }\n"
                                 "[noise_std]\nlength_0_mm = 0.1\n[robot_parameters]\nload_kg = 3\n");
  EXPECT_EQ(r.time_s, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(r.find("command_0")->values, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(r.find("pressure_0")->values, (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(r.find("length_0_mm")->values, (std::vector<double>{250, 246}));
  EXPECT_EQ(r.info.robot, "rig");
  EXPECT_EQ(r.info.trial, "t");
  EXPECT_EQ(r.info.noise_std.at("length_0_mm"), 0.1);
  EXPECT_EQ(std::get<double>(r.info.robot_parameters.at("load_kg")), 3);
}

TEST_F(ImportTest, CellsWhereASensorClipsAreNoReadings) {
  const std::string columns = std::string(head) + "[columns]\ntime_s = \"t\"\ncommand_0_kPa = \"u\"\n";
  const Recording r = import("t,u,p\n0,0,-1\n1,100,0\n2,200,30\n3,300,90\n4,400,100\n",
                             columns + "pressure_0_kPa = { from = \"p\", offset = 30, clipped_below = 0, clipped_above = 100 }\n");
  const std::vector<double>& p = r.find("pressure_0")->values;
  ASSERT_EQ(p.size(), 5U);
  for (const int row : {0, 1, 4}) EXPECT_TRUE(std::isnan(p[row])) << row;
  EXPECT_EQ(p[2], 0.1);
  EXPECT_EQ(p[3], 0.2);
  const auto tellsOf = [](const std::string& note) { return note.starts_with("pressure_0_kPa: 3 of 5 cells are where"); };
  EXPECT_EQ(std::ranges::count_if(r.notes, tellsOf), 1) << testing::PrintToString(r.notes);
  EXPECT_THROW(import("t,u,p\n0,0,0\n1,1,1\n", columns + "pressure_0_kPa = { from = \"p\", clipped_below = 2, clipped_above = 1 }\n"),
               BadFile);
  EXPECT_THROW(
      import("t,u,p\n0,0,0\n1,1,1\n", std::string(head) + "[columns]\ntime_s = \"t\"\ncommand_0 = { from = \"u\", clipped_below = 0 }\n"),
      BadFile);
}

TEST_F(ImportTest, SettledStepsBecomeTwoRowsEach) {
  const Recording r =
      import("u,l\n0,200\n1,190\n0,199\n", std::string(head) + "[columns]\ncommand_0 = \"u\"\nlength_0_mm = \"l\"\n[rows]\nsettle_s = 2\n");
  const std::vector<double>&u = r.find("command_0")->values, &l = r.find("length_0_mm")->values;
  ASSERT_EQ(r.time_s.size(), 6U);
  EXPECT_EQ(u, (std::vector<double>{0, 0, 1, 1, 0, 0}));
  for (int step = 0; step < 3; ++step) {
    EXPECT_EQ(r.time_s[2 * step], 2 * step);
    EXPECT_NEAR(r.time_s[2 * step + 1], 2 * step + 1.9, 1e-12);
    EXPECT_TRUE(std::isnan(l[2 * step]));
  }
  EXPECT_EQ(l[3], 190);
}

TEST_F(ImportTest, EvenRowsHoldCommandsAndDrawStraightLinesBetweenReadings) {
  const Recording r = import("t,u,l\n0.1,0,200\n1.1,1,190\n2.1,1,180\n",
                             std::string(head) +
                                 "[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\nlength_0_mm = \"l\"\n[rows]\nstep_s = 0.5\n"
                                 "from_s = 0.1\nuntil_s = 1.6\nbefore_s = 3\nbefore = { command_0 = 0.25 }\n");
  ASSERT_EQ(r.time_s.size(), 5U);
  EXPECT_EQ(r.time_s.front(), 0);
  EXPECT_NEAR(r.time_s.back(), 4.5, 1e-9);
  EXPECT_EQ(r.find("command_0")->values, (std::vector<double>{0.25, 0, 0, 1, 1}));
  EXPECT_TRUE(std::isnan(r.find("length_0_mm")->values[0]));
  EXPECT_NEAR(r.find("length_0_mm")->values[2], 195, 1e-9);
}

TEST_F(ImportTest, ColumnsMayComeFromATableWithAClockOfItsOwn) {
  write("commands.csv", "when,u\n0,0\n2,1\n");
  const Recording r =
      import("t,l\n0,200\n1,190\n2,180\n", std::string(head) +
                                               "[columns]\ntime_s = \"t\"\nlength_0_mm = \"l\"\n[columns.command_0]\nfrom = \"u\"\n"
                                               "table = \"commands.csv\"\ntime = \"when\"\nlinear = true\n");
  EXPECT_EQ(r.find("command_0")->values, (std::vector<double>{0, 0.5, 1}));
}

TEST_F(ImportTest, AClockWithoutDatesBesideOneWithDatesCountsFromTheFirstRow) {
  write("encoder.csv", "t,a\n10.0,1\n10.3,1.6\n11.0,3\n11.3,3.6\n12.0,5\n");
  const Recording r = import("when,u\n2026-11-02 14:03:05.5,0\n2026-11-02 14:03:06.5,1\n",
                             "robot = \"elbow\"\n[columns]\ntime_s = { from = \"when\", format = \"%Y-%m-%d %H:%M:%S\" }\n"
                             "command_0 = \"u\"\ncommand_1 = { value = 0 }\nangle_elbow_deg = { from = \"a\", table = \"encoder.csv\" }\n"
                             "[tables.\"encoder.csv\"]\ntime_s = { from = \"t\", offset = -10.5 }\n");
  EXPECT_EQ(r.time_s, (std::vector<double>{0, 1}));
  EXPECT_EQ(r.find("angle_elbow_deg")->values, (std::vector<double>{2, 4}));
}

TEST_F(ImportTest, AnEncoderThatBeginsAgainAfterATurnCountsOn) {
  const std::string columns = "robot = \"elbow\"\n[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\ncommand_1 = { value = 0 }\n";
  const std::string table = "t,u,a\n0,0,350\n1,0,358\n2,0,\n3,0,6\n4,0,2\n5,0,355\n";
  const Recording r = import(table, columns + "angle_elbow_deg = { from = \"a\", unwrap = 360, offset = -350 }\n");
  const std::vector<double>& angle = r.find("angle_elbow_deg")->values;
  ASSERT_EQ(angle.size(), 6U);
  EXPECT_TRUE(std::isnan(angle[2]));
  for (const auto& [row, expected] : std::vector<std::pair<std::size_t, double>>{{0, 0}, {1, 8}, {3, 16}, {4, 12}, {5, 5}})
    EXPECT_EQ(angle[row], expected) << row;
  const auto tellsOf = [](const std::string& note) {
    return note == "angle_elbow_deg: begins again after 360, 2 times; the readings count on";
  };
  EXPECT_EQ(std::ranges::count_if(r.notes, tellsOf), 1) << testing::PrintToString(r.notes);
  EXPECT_THROW(import(table, columns + "angle_elbow_deg = { from = \"a\", unwrap = 0 }\n"), BadFile);
  EXPECT_THROW(import(table, "robot = \"rig\"\n[columns]\ntime_s = \"t\"\ncommand_0 = { from = \"u\", unwrap = 360 }\n"), BadFile);
}

TEST_F(ImportTest, NamesTheTableWhoseClockRunsBackwards) {
  write("commands.csv", "when,u\n2,0\n0,1\n");
  const std::string mapping = std::string(head) +
                              "[columns]\ntime_s = \"t\"\nlength_0_mm = \"l\"\n[columns.command_0]\nfrom = \"u\"\n"
                              "table = \"commands.csv\"\ntime = \"when\"\n";
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { import("t,l\n0,200\n1,190\n", mapping); }), "commands.csv:3:1: time runs backwards"));
}

TEST_F(ImportTest, RowsWithTheTimeOfTheRowBeforeAreLeftOutAndSaid) {
  const Recording r =
      import("t,u\n0,0\n0.001,0.1\n0.001,0.2\n0.002,0.3\n", std::string(head) + "[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\n");
  EXPECT_EQ(r.find("command_0")->values, (std::vector<double>{0, 0.1, 0.3}));
  ASSERT_FALSE(r.notes.empty());
  EXPECT_TRUE(contains(r.notes.front(), "1 rows have the same time as the row before and are left out"));
  const Recording other = import("t,u\n0,0\n0.001,0.1\n0.001,0.2\n0.002,0.3\n0.003,0.4\n",
                                 std::string(head) + "[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\n[rows]\nevery = 2\n");
  EXPECT_EQ(other.find("command_0")->values, (std::vector<double>{0, 0.3})) << "every second of those that are left";
}

TEST_F(ImportTest, RefusesWhatIsNoMapping) {
  const std::string table = "t,u\n0,0\n1,1\n";
  auto refused = [&](const std::string& mapping) { return messageOf<BadFile>([&] { import(table, head + mapping); }); };
  EXPECT_TRUE(contains(refused(""), "no section [columns]"));
  EXPECT_TRUE(contains(refused("[columns]\ncommand_0 = \"u\"\n"), "time_s is missing"));
  EXPECT_TRUE(contains(refused("[columns]\ntime_s = \"time\"\ncommand_0 = \"u\"\n"), "there is no column \"time\"; the columns are t, u"));
  EXPECT_TRUE(contains(refused("[columns]\ntime_s = \"t\"\ncommand_0 = { form = \"u\" }\n"), "did you mean \"from\""));
  EXPECT_TRUE(contains(refused("[columns]\ntime_s = \"t\"\ncommand_0 = {}\n"), "needs either from or value"));
  EXPECT_TRUE(contains(refused("[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\n[rows]\nstep_s = -1\n"), "larger than 0"));
  EXPECT_TRUE(contains(refused("[columns]\ntime_s = \"t\"\ncommand_0_torr = \"u\"\n"), "command_0_torr"));
  EXPECT_TRUE(contains(refused("rows = 5\n[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\n"), "rows: must be a table"));
  EXPECT_TRUE(
      contains(refused("[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\n[rows]\nbefore = { command_0 = 0 }\n"), "needs rows.before_s"));
  EXPECT_TRUE(
      contains(messageOf<BadFile>([&] { import("t,u\n1,0\n0,1\n", std::string(head) + "[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\n"); }),
               "backwards"));
}

TEST_F(ImportTest, MappingsOfTheCaseStudiesFitTheRealRecordings) {
  const fs::path real = sharedFolder() / "data" / "real";
  if (!fs::exists(real)) GTEST_SKIP() << "no reference data at " << real;
  const std::pair<const char*, const char*> pairs[] = {{"porcaro-drum-arm/raw_step_response.csv", "wrist_step"},
                                                       {"porcaro-drum-arm/fig1b_step_real.csv", "wrist_step_repeat"},
                                                       {"porcaro-drum-arm/raw_step_response.csv", "wrist_release"},
                                                       {"porcaro-drum-arm/raw_sweep_0_2s.csv", "wrist_sweep_start"},
                                                       {"porcaro-drum-arm/fig1c_sweep_real.csv", "wrist_sweep"},
                                                       {"porcaro-drum-arm/fig1a_hysteresis_real.csv", "wrist_loop"},
                                                       {"zagreb-dmsp10-250/quasistatic_cycle1_0p1V.csv", "bench_loop"},
                                                       {"zagreb-dmsp10-250/quasistatic_cycle1_0p1V.csv", "bench_loop_corrected"},
                                                       {"psu-bpa-fill-leak/fill_4.csv", "fill"},
                                                       {"psu-bpa10-isometric/raw_L20cm_l174.5mm_test10.csv", "isometric"},
                                                       {"zagreb-dmsp10-250/step_up_0_to_4p074V_100Hz.csv", "bench_step"}};
  for (const auto& [table, mapping] : pairs) {
    const Recording r =
        importTable((real / table).string(), readImportMapping(std::string(MUSCLESIM_IMPORT_EXAMPLES) + "/" + mapping + ".toml"));
    EXPECT_GT(r.time_s.size(), 50U) << mapping;
    EXPECT_GE(r.muscleCount(), 1) << mapping;
  }
}

}  // namespace
}  // namespace musclesim
