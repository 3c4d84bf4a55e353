#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "musclesim/base/file.h"
#include "musclesim/log/recording.h"
#include "src/program.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

class ImportCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_import_command_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ / "table.csv") << "t,u,l\n0,0.2,240\n0.5,0.2,240\n1,0.6,230\n";
    std::ofstream(folder_ / "map.toml") << "robot = \"rig\"\n[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\nlength_0_mm = \"l\"\n";
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(ImportCommand, MakesARecordingThatReplays) {
  const ProgramResult made = runProgram({"import", "table.csv", "map.toml", "out.csv"}, folder_);
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(made.out, "out.csv: 3 rows over 1 s, robot rig: command_0, length_0_mm"));
  EXPECT_EQ(readRecording((folder_ / "out.csv").string()).find("command_0")->values, (std::vector<double>{0.2, 0.2, 0.6}));
  EXPECT_EQ(runProgram({"replay", "out.csv", "--quiet"}, folder_).status, 0);
}

/// A mapping may name a robot file: it is missed only where there is none.
TEST_F(ImportCommand, LooksForTheRobotFileOfTheMapping) {
  std::ofstream(folder_ / "map.toml") << "robot = \"mine.toml\"\n[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\nlength_0_mm = \"l\"\n";
  EXPECT_TRUE(contains(runProgram({"import", "table.csv", "map.toml", "early.csv"}, folder_).err, "there is no robot file mine.toml"));
  ASSERT_EQ(runProgram({"robot", "export", "rig", "-o", "mine.toml"}, folder_).status, 0);
  const ProgramResult made = runProgram({"import", "table.csv", "map.toml", "out.csv"}, folder_);
  EXPECT_EQ(made.status, 0);
  EXPECT_EQ(made.err, "");
  EXPECT_EQ(runProgram({"replay", "out.csv", "--quiet"}, folder_).status, 0);
}

TEST_F(ImportCommand, MakesTheFolderAndWantsATable) {
  EXPECT_EQ(runProgram({"import", "table.csv", "map.toml", "sub/folder/out.csv"}, folder_).status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "sub/folder/out.json"));
  const ProgramResult wrong = runProgram({"import", "table.csv", "map.toml", "out.txt"}, folder_);
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(contains(wrong.err, "recording = out.txt: must end in .csv")) << wrong.err;
  EXPECT_FALSE(fs::exists(folder_ / "out.txt"));
}

TEST_F(ImportCommand, ReplacesARecordingOnlyWhenItIsTold) {
  ASSERT_EQ(runProgram({"import", "table.csv", "map.toml", "out.csv"}, folder_).status, 0);
  std::ofstream(folder_ / "table.csv") << "t,u,l\n0,0.3,240\n0.5,0.3,240\n";
  const ProgramResult again = runProgram({"import", "table.csv", "map.toml", "out.csv"}, folder_);
  EXPECT_EQ(again.status, 2);
  EXPECT_TRUE(contains(again.err, "out.csv exists: choose another name, or --overwrite it")) << again.err;
  EXPECT_EQ(readRecording((folder_ / "out.csv").string()).time_s.size(), 3U);
  EXPECT_EQ(runProgram({"import", "table.csv", "map.toml", "out.csv", "--overwrite"}, folder_).status, 0);
  EXPECT_EQ(readRecording((folder_ / "out.csv").string()).time_s.size(), 2U);
  std::ofstream(folder_ / "half.json") << "{}";
  EXPECT_EQ(runProgram({"import", "table.csv", "map.toml", "half.csv"}, folder_).status, 2) << "a sidecar alone is not replaced either";
}

TEST_F(ImportCommand, DoesNotWriteOverATableOfTheMapping) {
  std::ofstream(folder_ / "other.csv") << "when,x\n0,0.2\n1,0.6\n";
  std::ofstream(folder_ / "map.toml") << "robot = \"rig\"\n[columns]\ntime_s = \"t\"\nlength_0_mm = \"l\"\n[columns.command_0]\nfrom = "
                                         "\"x\"\ntable = \"other.csv\"\ntime = \"when\"\n";
  const ProgramResult made = runProgram({"import", "table.csv", "map.toml", "other.csv"}, folder_);
  EXPECT_EQ(made.status, 2);
  EXPECT_TRUE(contains(made.err, "other.csv is an input and would be overwritten")) << made.err;
}

TEST_F(ImportCommand, NamesSignalsAndParametersThatTheRobotDoesNotHave) {
  const std::string mapping = "robot = \"elbow\"\n[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\ncommand_1 = \"u\"\n";
  std::ofstream(folder_ / "map.toml") << mapping << "angle_ellbow_deg = \"l\"\n";
  const ProgramResult made = runProgram({"import", "table.csv", "map.toml", "out.csv"}, folder_);
  EXPECT_EQ(made.status, 0);
  EXPECT_TRUE(contains(made.err, "elbow has no angle_ellbow_deg; it is not compared; did you mean angle_elbow_deg?")) << made.err;
  std::ofstream(folder_ / "map.toml") << mapping << "length_0_mm = \"l\"\n[robot_parameters]\nlod_kg = 2\n";
  const ProgramResult other = runProgram({"import", "table.csv", "map.toml", "other.csv"}, folder_);
  EXPECT_EQ(other.status, 0);
  EXPECT_TRUE(contains(other.err, "the recording cannot be replayed yet: ") && contains(other.err, "lod_kg")) << other.err;
}

TEST_F(ImportCommand, SaysThatARobotIsUnknown) {
  std::ofstream(folder_ / "map.toml") << "robot = \"rigg\"\n[columns]\ntime_s = \"t\"\ncommand_0 = \"u\"\nlength_0_mm = \"l\"\n";
  const ProgramResult made = runProgram({"import", "table.csv", "map.toml", "out.csv"}, folder_);
  EXPECT_EQ(made.status, 0);
  EXPECT_TRUE(contains(made.err, "this program has no robot rigg")) << made.err;
}

TEST_F(ImportCommand, LooksAtATableAndBeginsAMapping) {
  std::ofstream(folder_ / "logger.txt") << "t [ms];p [bar]\n0;0,5\n10;0,6\n20;0,7\n";
  const ProgramResult look = runProgram({"import", "--look", "logger.txt", "-o", "begun.toml"}, folder_);
  ASSERT_EQ(look.status, 0) << look.err;
  EXPECT_TRUE(contains(look.out, "cells      separated by \";\", decimal comma")) << look.out;
  EXPECT_TRUE(contains(look.out, "column   1 t [ms]   0 .. 20 ms; clock: every 0.01 s over 0.02 s")) << look.out;
  EXPECT_TRUE(contains(look.out, "column   2 p [bar]  0.5 .. 0.7 bar")) << look.out;
  std::ofstream(folder_ / "begun.toml", std::ios::app) << "[columns.command_0_bar]\nfrom = \"p [bar]\"\n";
  ASSERT_EQ(runProgram({"import", "logger.txt", "begun.toml", "out.csv"}, folder_).status, 0);
  EXPECT_EQ(readRecording((folder_ / "out.csv").string()).time_s, (std::vector<double>{0, 0.01, 0.02}));
  EXPECT_EQ(runProgram({"import", "--look", "logger.txt", "-o", "begun.toml"}, folder_).status, 2) << "a mapping is never overwritten";
  EXPECT_EQ(runProgram({"import", "logger.txt", "begun.toml"}, folder_).status, 2);
}

TEST_F(ImportCommand, RecognisesCommandsByTheirNames) {
  std::ofstream(folder_ / "logger.txt")
      << "t_s;Soll_bar;Ist_bar;pSet2_kPa;offset_kPa;SP (psi)\n0;0;0;2;3;4\n0,01;3;1;2;3;4\n0,02;3;2;2;3;4\n";
  ASSERT_EQ(runProgram({"import", "--look", "logger.txt", "-o", "begun.toml"}, folder_).status, 0);
  const std::string mapping = readTextFile((folder_ / "begun.toml").string(), 1 << 20);
  for (const char* line : {"# command_0_bar = \"Soll_bar\" ", "# pressure_0_bar = \"Ist_bar\" ", "# command_1_kPa = \"pSet2_kPa\" ",
                           "# pressure_1_kPa = \"offset_kPa\" ", "# command_2_psi = \"SP (psi)\" "})
    EXPECT_TRUE(contains(mapping, line)) << line << mapping;
  EXPECT_FALSE(contains(mapping, "needed: one command")) << mapping;
}

TEST_F(ImportCommand, EndsWithStatus3ForABadTableAndWritesNothing) {
  std::ofstream(folder_ / "table.csv") << "t,v\n0,0.2\n";
  const ProgramResult made = runProgram({"import", "table.csv", "map.toml", "out.csv"}, folder_);
  EXPECT_EQ(made.status, 3);
  EXPECT_TRUE(contains(made.err, "there is no column \"u\""));
  EXPECT_FALSE(fs::exists(folder_ / "out.csv"));
}

}  // namespace
}  // namespace musclesim
