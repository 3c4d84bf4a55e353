#include "log/matlab.h"

#include <gtest/gtest.h>
#include <matio.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include "log/table_look.h"
#include "musclesim/base/error.h"
#include "musclesim/log/import.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

class Matlab : public testing::TestWithParam<mat_ft> {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_matlab_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    file_ = (folder_ / "run.mat").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  static matvar_t* array(const char* name, std::vector<double> values, std::size_t rows) {
    std::size_t sides[2] = {rows, values.size() / rows};
    return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, sides, values.data(), 0);
  }
  /// A structure with a clock and a matrix, a row of bytes, a scalar and a text.
  void writeFile(mat_ft version) const {
    const std::unique_ptr<mat_t, int (*)(mat_t*)> mat(Mat_CreateVer(file_.c_str(), nullptr, version), Mat_Close);
    ASSERT_TRUE(mat);
    const char* fields[] = {"t", "x"};
    std::size_t one[2] = {1, 1};
    matvar_t* run = Mat_VarCreateStruct("run", 2, one, fields, 2);
    Mat_VarSetStructFieldByName(run, "t", 0, array("t", {0, 0.1, 0.2}, 3));
    Mat_VarSetStructFieldByName(run, "x", 0, array("x", {250, 249, std::nan(""), 1, 2, 3}, 3));
    std::uint8_t bytes[3] = {0, 3, 6};
    std::size_t row[2] = {1, 3};
    char text[] = "note";
    std::size_t text_sides[2] = {1, 4};
    for (matvar_t* variable : {run, Mat_VarCreate("u", MAT_C_UINT8, MAT_T_UINT8, 2, row, bytes, 0), array("gain", {2}, 1),
                               array("slow", {1, 2}, 2), Mat_VarCreate("text", MAT_C_CHAR, MAT_T_UINT8, 2, text_sides, text, 0)}) {
      ASSERT_EQ(Mat_VarWrite(mat.get(), variable, MAT_COMPRESSION_NONE), 0);
      Mat_VarFree(variable);
    }
  }
  ImportMapping mapping(const std::string& columns) const {
    std::ofstream(folder_ / "map.toml") << "robot = \"rig\"\npressure_full_scale_kPa = 600\n[columns]\n" + columns;
    return readImportMapping((folder_ / "map.toml").string());
  }
  fs::path folder_;
  std::string file_;
};

TEST_P(Matlab, ArraysAndFieldsAreColumns) {
  writeFile(GetParam());
  const Recording r =
      importTable(file_, mapping("time_s = \"run.t\"\ncommand_0_bar = \"u\"\nlength_0_mm = \"run.x(:,1)\"\nforce_0_N = \"run.x(:,2)\"\n"));
  EXPECT_EQ(r.time_s, (std::vector<double>{0, 0.1, 0.2}));
  EXPECT_EQ(r.find("command_0")->values, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(r.find("length_0_mm")->values[1], 249);
  EXPECT_TRUE(std::isnan(r.find("length_0_mm")->values[2]));
  EXPECT_EQ(r.find("force_0_N")->values, (std::vector<double>{1, 2, 3}));
  std::string notes;
  for (const auto& note : r.notes) notes += note + "\n";
  EXPECT_TRUE(contains(notes, "the table has the 4 arrays of length 3; of other length: gain (1), slow (2)"));
  EXPECT_TRUE(contains(notes, "holds no real numbers that can be read: text"));
}

TEST_P(Matlab, AnotherLengthIsChosenByAVariable) {
  writeFile(GetParam());
  std::vector<std::string> notes;
  EXPECT_EQ(matlabTable(file_, "slow", notes), "\"slow\"\n1\n2\n");
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { matlabTable(file_, "fast", notes); }), "has no array \"fast\"; it has "));
  EXPECT_TRUE(contains(lookText(lookAtTable(file_)), "run.x(:,1)"));
}

INSTANTIATE_TEST_SUITE_P(Versions, Matlab, testing::Values(MAT_FT_MAT5, MAT_FT_MAT73),
                         [](const auto& version) { return version.param == MAT_FT_MAT5 ? "V5" : "V73"; });

/// A file of version 5 byte by byte, as the format's description has it: an array `ab` of 1 by 2 doubles.
TEST_F(Matlab, AFileOfVersion5ByteByByte) {
  std::string bytes = "MATLAB 5.0 MAT-file";
  bytes.resize(124, ' ');
  const auto append = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(std::uint16_t{0x0100});
  bytes += "IM";
  constexpr std::uint32_t matrix = 14, uint32 = 6, int32 = 5, int8 = 1, float64 = 9, double_class = 6;
  for (const std::uint32_t word : {matrix, 16U + 16 + 16 + 24, uint32, 8U, double_class, 0U, int32, 8U, 1U, 2U, int8, 2U}) append(word);
  bytes += std::string("ab\0\0\0\0\0\0", 8);
  append(float64);
  append(std::uint32_t{16});
  append(1.5);
  append(-2.0);
  std::ofstream(file_, std::ios::binary) << bytes;
  std::vector<std::string> notes;
  EXPECT_EQ(matlabTable(file_, "", notes), "\"ab\"\n1.5\n-2\n");
}

TEST_F(Matlab, WhatIsNoMatlabFileIsRefused) {
  std::ofstream(file_) << "t,u\n0,1\n";
  std::vector<std::string> notes;
  EXPECT_TRUE(contains(messageOf<BadFile>([&] { matlabTable(file_, "", notes); }), "run.mat: is not a MATLAB file of version 5 to 7.3"));
  EXPECT_THROW(matlabTable((folder_ / "none.mat").string(), "", notes), IoError);
}

}  // namespace
}  // namespace musclesim
