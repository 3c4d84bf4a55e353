#include "musclesim/base/text.h"

#include <gtest/gtest.h>

#include <tuple>

namespace musclesim {
namespace {

TEST(PlaceInText, CountsLinesAndColumnsFromOne) {
  const std::string text = "ab\ncd";
  for (const auto& [offset, line, column] : {std::tuple{0, 1, 1}, {1, 1, 2}, {2, 1, 3}, {3, 2, 1}, {4, 2, 2}}) {
    EXPECT_EQ(placeInText(text, static_cast<std::size_t>(offset)).line, line) << offset;
    EXPECT_EQ(placeInText(text, static_cast<std::size_t>(offset)).column, column) << offset;
  }
}

TEST(PlaceInText, AnOffsetBehindTheTextIsItsEnd) {
  EXPECT_EQ(placeInText("ab\ncd", 99).line, 2);
  EXPECT_EQ(placeInText("ab\ncd", 99).column, 3);
  EXPECT_EQ(placeInText("ab\nc\n", 99).line, 3);
}

TEST(InQuotes, EscapesWhatIsNotPrintableAscii) {
  EXPECT_EQ(inQuotes(""), "\"\"");
  EXPECT_EQ(inQuotes("a\tb\xFF"), "\"a\\x09b\\xFF\"");
}

TEST(InQuotes, ShortensLongText) {
  EXPECT_EQ(inQuotes(std::string(40, 'a')), "\"" + std::string(40, 'a') + "\"");
  EXPECT_EQ(inQuotes(std::string(41, 'a')), "\"" + std::string(40, 'a') + "...\"");
}

TEST(Printable, KeepsTextAndShowsControlCharacters) {
  EXPECT_EQ(printable("a\tb\n\u00e9 \u05d0"), "a\tb\n\u00e9 \u05d0");
  EXPECT_EQ(printable("\x1b[31m\r\x07\x7f"), "\\x1B[31m\\x0D\\x07\\x7F");
  EXPECT_EQ(printable("\u009b31m"), "\\x9B31m");
}

}  // namespace
}  // namespace musclesim
