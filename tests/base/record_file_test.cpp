// Results on the disk by key: what is kept after a kill, what is dropped, what is refused.
#include "musclesim/base/record_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t limit_bytes = std::size_t{1} << 30;

class RecordFileTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  /// A file with these numbers of records, key "k<i>", value "value <i>".
  void write(int count) const {
    RecordFile file(name_);
    file.begin("origin");
    for (int i = 0; i < count; ++i) file.add("k" + std::to_string(i), "value " + std::to_string(i));
  }
  void replace(const std::string& text) const { replaceFile(name_, text); }
  std::string text() const { return readTextFile(name_, limit_bytes); }
  const fs::path folder_ = fs::temp_directory_path() / ("musclesim_record_file_test_" + std::to_string(getpid()));
  const std::string name_ = (folder_ / "records").string();
};

TEST_F(RecordFileTest, GivesBackWhatWasKept) {
  write(3);
  RecordFile file(name_);
  EXPECT_EQ(file.origin(), "origin");
  EXPECT_EQ(file.resume(), 3u);
  EXPECT_EQ(file.droppedBytes(), 0u);
  EXPECT_EQ(file.find("k1"), "value 1");
  EXPECT_EQ(file.find("k3"), std::nullopt);
  file.add("k3", std::string("a\0b", 3));
  EXPECT_EQ(file.find("k3"), std::string("a\0b", 3));
}

TEST_F(RecordFileTest, EveryCutLosesOnlyWhatIsNotWhole) {
  write(3);
  const std::string whole = text();
  std::size_t most = 3;
  for (std::size_t size = whole.size(); size-- > 0;) {
    replace(whole.substr(0, size));
    RecordFile file(name_);
    if (file.origin().empty()) continue;
    const std::size_t count = file.resume();
    EXPECT_LE(count, most);
    most = count;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(file.find("k" + std::to_string(i)), i < count ? std::optional("value " + std::to_string(i)) : std::nullopt) << size;
    file.add("new", "1");  // goes on behind the last whole record
    EXPECT_EQ(file.find("new"), "1");
  }
  EXPECT_EQ(most, 0u);
}

TEST_F(RecordFileTest, AChangedByteIsNeverTakenForTheRecord) {
  write(3);
  const std::string whole = text();
  for (std::size_t place = 0; place < whole.size(); ++place) {
    std::string changed = whole;
    changed[place] ^= 0x10;
    replace(changed);
    RecordFile file(name_);
    if (file.origin().empty()) continue;
    EXPECT_EQ(file.origin(), "origin");
    EXPECT_LT(file.resume(), 3u) << place;
    EXPECT_GT(file.droppedBytes(), 0u);
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(file.find("k" + std::to_string(i)).value_or("value " + std::to_string(i)), "value " + std::to_string(i));
  }
}

TEST_F(RecordFileTest, WhatFollowsAHalfWrittenRecordIsKeptByTheNextProcess) {
  write(2);
  replace(text().substr(0, text().size() - 3));
  {
    RecordFile file(name_);
    EXPECT_EQ(file.resume(), 1u);
    file.add("later", "x");
  }
  RecordFile file(name_);
  EXPECT_EQ(file.resume(), 2u);
  EXPECT_EQ(file.find("later"), "x");
}

TEST_F(RecordFileTest, OneProcessAtATime) {
  RecordFile file(name_);
  EXPECT_THROW(RecordFile second(name_), IoError);
}

TEST_F(RecordFileTest, KeepsNoMoreThanTheLimit) {
  RecordFile file(name_, 500);
  file.begin("origin");
  for (int i = 0; i < 100; ++i) file.add("k" + std::to_string(i), "0123456789");
  EXPECT_LE(fs::file_size(name_), 500u);
  EXPECT_EQ(file.find("k0"), "0123456789");
  EXPECT_EQ(file.trouble(), "");
}

TEST_F(RecordFileTest, BeginningAnewForgets) {
  write(2);
  RecordFile file(name_);
  file.resume();
  file.begin("other");
  EXPECT_EQ(file.find("k0"), std::nullopt);
  EXPECT_EQ(file.origin(), "other");
}

TEST_F(RecordFileTest, ADiskThatIsFullEndsTheKeepingOnly) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  RecordFile file("/dev/full");
  EXPECT_THROW(file.begin("origin"), IoError);
}

}  // namespace
}  // namespace musclesim
