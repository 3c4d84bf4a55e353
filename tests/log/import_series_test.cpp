// What one column of a table read: values between its readings, and the notes on what is missing.
#include "log/import_series.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "musclesim/base/error.h"

namespace musclesim {
namespace {

class ImportSeriesTest : public testing::Test {
 protected:
  ImportSeriesTest() {
    std::ofstream(file_) << "u,l\n1,10\n2,20\n3,\n4,40\n5,50\n";
    table_.emplace(file_, TableFormat{});
    mapping_.step_s = 0.5;
    mapping_.longest_gap_s = 1;
  }
  ~ImportSeriesTest() override { std::filesystem::remove(file_); }

  ImportSeries seriesOf(const ImportColumn& column) {
    return ImportSeries(column, *table_, table_->indexOf(column.from), {0, 1, 2, 3, 4}, mapping_, ImportSeries::Clock::own, notes_);
  }

  const std::string file_ = (std::filesystem::temp_directory_path() / ("import_series_" + std::to_string(getpid()) + ".csv")).string();
  std::optional<DataTable> table_;
  ImportMapping mapping_;
  std::vector<std::string> notes_;
};

TEST_F(ImportSeriesTest, ReadingsLieOnStraightLinesButNotAcrossGapsOrOutside) {
  const ImportColumn column = importColumn("length_0_mm", {"l", 0});
  ImportSeries series = seriesOf(column);
  EXPECT_EQ(series.valueAt(1, column, true), 20);
  EXPECT_EQ(series.valueAt(0.25, column, true), 12.5);
  EXPECT_TRUE(std::isnan(series.valueAt(2, column, true))) << "an empty cell between readings two seconds apart";
  EXPECT_TRUE(std::isnan(series.valueAt(5, column, true)));
  series.noteMissing(column, 4, notes_);
  ASSERT_EQ(notes_.size(), 3U);
  EXPECT_EQ(notes_[0], "length_0_mm: 1 of 5 cells hold no reading");
  EXPECT_TRUE(notes_[1].starts_with("length_0_mm: 1 of 4 rows lie outside of its own times, 0 .. 4 s"));
  EXPECT_TRUE(notes_[2].starts_with("length_0_mm: 1 of 4 rows lie in gaps longer than 1 s"));
}

TEST_F(ImportSeriesTest, CommandsAreHeldAndConstantsHoldAlways) {
  const ImportColumn column = importColumn("command_0", {"u", 0});
  ImportSeries series = seriesOf(column), constant(7);
  EXPECT_EQ(series.valueAt(0.75, column, true), 1);
  EXPECT_EQ(series.valueAt(9, column, true), 5);
  EXPECT_TRUE(std::isnan(series.valueAt(-1, column, true))) << "nothing was commanded yet";
  EXPECT_EQ(constant.valueAt(-1, column, true), 7);
  EXPECT_EQ(constant.table(), nullptr);
}

TEST_F(ImportSeriesTest, RefusesAClockThatDoesNotOverlap) {
  const ImportColumn column = importColumn("length_0_mm", {"l", 0});
  const ImportSeries series = seriesOf(column);
  series.requireOverlap(column, {0, 2, 4});
  EXPECT_THROW(series.requireOverlap(column, {100, 101}), BadFile);
}

}  // namespace
}  // namespace musclesim
