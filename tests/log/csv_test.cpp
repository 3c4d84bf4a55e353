#include "musclesim/log/csv.h"

#include <cmath>
#include <limits>

#include "log_fixture.h"
#include "musclesim/base/text.h"

namespace musclesim {
namespace {

double numberIn(const std::string& cell) {
  const std::string text = "a,b\n" + cell + ",1\n";
  CsvReader csv(text, "data.csv");
  std::vector<CsvCell> cells;
  csv.readRow(cells);
  return csv.number(cells[0], "a");
}

TEST(Csv, ReadsCellsWithTheirPlaces) {
  const std::string text = "# machine 3\n# second comment, with \"quotes\"\nx, y ,z\r\n1,  2.5,\n3,4,5";
  CsvReader csv(text, "data.csv");
  ASSERT_EQ(csv.header().size(), 3u);
  EXPECT_EQ(csv.header()[1].text, "y");
  EXPECT_EQ(csv.header()[1].line, 3);
  EXPECT_EQ(csv.header()[1].column, 4);
  EXPECT_EQ(csv.headerLine(), 3);
  std::vector<CsvCell> cells;
  ASSERT_TRUE(csv.readRow(cells));
  EXPECT_EQ(cells[1].text, "2.5");
  EXPECT_EQ(cells[1].line, 4);
  EXPECT_EQ(cells[1].column, 5);
  EXPECT_EQ(cells[2].text, "");
  EXPECT_EQ(cells[2].column, 9);
  ASSERT_TRUE(csv.readRow(cells));
  EXPECT_EQ(cells[2].text, "5");
  EXPECT_FALSE(csv.readRow(cells));
}

TEST(Csv, ByteOrderMarkDoesNotCount) {
  const std::string text = "\xEF\xBB\xBFx,y\n1,2\n";
  CsvReader csv(text, "data.csv");
  EXPECT_EQ(csv.header()[0].text, "x");
  EXPECT_EQ(csv.header()[0].column, 1);
  EXPECT_EQ(csv.header()[1].column, 3);
}

TEST(Csv, Numbers) {
  EXPECT_EQ(numberIn("1.5"), 1.5);
  EXPECT_EQ(numberIn("+1.5"), 1.5);
  EXPECT_EQ(numberIn("-2e-3"), -0.002);
  EXPECT_EQ(numberIn(".5"), 0.5);
  EXPECT_EQ(numberIn("7."), 7);
  EXPECT_EQ(numberIn("5e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_TRUE(std::signbit(numberIn("-0")));
  for (const char* cell : {"", " ", "nan", "NaN", "NAN"}) EXPECT_TRUE(std::isnan(numberIn(cell))) << cell;
}

TEST(Csv, RefusesWhatIsNotANumber) {
  for (const char* cell : {"abc", "1.5x", "1 5", "0x10", "--1", "+-1", "+", "1,5e", "nan(1)", "-nan", "1e", "1.2.3", "\x01", "１"})
    EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { numberIn(cell); }), {"data.csv:2:"})) << cell;
  for (const char* cell : {"inf", "-inf", "Infinity"})
    EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { numberIn(cell); }), {"infinite"})) << cell;
  for (const char* cell : {"1e999", "-1e999", "1e-999"})
    EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { numberIn(cell); }), {"for a double"})) << cell;
}

TEST(Csv, LimitsAreChecked) {
  const auto readAll = [](const std::string& text, const CsvLimits& limits) {
    CsvReader csv(text, "data.csv", limits);
    std::vector<CsvCell> cells;
    while (csv.readRow(cells)) continue;
  };
  const std::string text = "a,b\n1,2\n3,4\n";
  EXPECT_NO_THROW(readAll(text, {12, 3, 2, 2, 4}));
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { readAll(text, {11, 3, 2, 2, 4}); }), {"data.csv: is larger"}));
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { readAll(text, {12, 2, 2, 2, 4}); }), {"data.csv:1:3: ", "longer than the 2 bytes"}));
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { readAll(text, {12, 3, 1, 2, 4}); }), {"data.csv:3:1: ", "more than the 1 rows"}));
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { readAll(text, {12, 3, 2, 1, 4}); }), {"data.csv:1:3: ", "more than the 1 columns"}));
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { readAll(text, {12, 3, 2, 2, 3}); }), {"data.csv:3:1: ", "more than the 3 cells"}));
}

TEST(Csv, TheLongestLineAndTheLimitsOfTheContract) {
  EXPECT_EQ(CsvLimits().file_bytes, 512u * 1024 * 1024);
  EXPECT_EQ(CsvLimits().row_count, 10'000'000u);
  EXPECT_EQ(CsvLimits().column_count, 1000u);
  const std::string long_line(1024 * 1024 + 1, 'x');
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { CsvReader(long_line, "data.csv"); }), {"data.csv:1:1048577: ", "longer"}));
  std::string many = "a";
  for (int i = 0; i < 1000; ++i) many += ",a";
  EXPECT_TRUE(hasWords(messageOf<BadFile>([&] { CsvReader(many, "data.csv"); }), {"data.csv:1:2001: ", "1000 columns"}));
}

TEST(Csv, TextInMessagesIsShortAndPrintable) {
  EXPECT_EQ(inQuotes("a\tb\xFF"), "\"a\\x09b\\xFF\"");
  EXPECT_EQ(inQuotes(std::string(100, 'a')), "\"" + std::string(40, 'a') + "...\"");
}

}  // namespace
}  // namespace musclesim
