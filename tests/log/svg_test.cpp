#include "log/svg.h"

#include <gtest/gtest.h>

#include <cmath>

namespace musclesim {
namespace {

TEST(Svg, TextIsEscaped) {
  EXPECT_EQ(escapedXml("<a href=\"b\">&'"), "&lt;a href=&quot;b&quot;&gt;&amp;&#39;");
  EXPECT_EQ(escapedXml("\u00E4\u2212\U0001F600"), "\u00E4\u2212\U0001F600");
  EXPECT_EQ(escapedXml("a\nb\x01"), "a b?");
  EXPECT_EQ(escapedXml("\xFF\xC3 "), "?? ");
  EXPECT_EQ(escapedXml("\xED\xA0\x80"), "???") << "half of a surrogate pair";
  EXPECT_EQ(escapedXml("\xE2\x88"), "??") << "cut off";
}

TEST(Svg, Colors) {
  EXPECT_EQ(hexColor({1, 0.5, 0, ""}), "#ff8000");
  EXPECT_EQ(hexColor({2, -1, std::nan(""), ""}), "#ff0000");
  EXPECT_GT(brightness({0.99, 1, 0, "yellow"}), 0.9);
  EXPECT_LT(brightness({1, 0, 0, "red"}), 0.3);
}

std::size_t pathCount(const Svg& svg) {
  const std::string document = svg.document();
  std::size_t count = 0;
  for (std::size_t at = document.find("<path"); at != std::string::npos; at = document.find("<path", at + 1)) ++count;
  return count;
}

TEST(Svg, LightColorsGetACasing) {
  Svg svg(100, 100, "t");
  svg.curve({{{0, 0}, {10, 10}}}, {0.1, 0, 1, "blue"}, 1, {0, 0, 100, 100}, "");
  EXPECT_EQ(pathCount(svg), 1u);
  svg.curve({{{0, 0}, {10, 10}}}, {0.99, 1, 0, "yellow"}, 1, {0, 0, 100, 100}, "");
  EXPECT_EQ(pathCount(svg), 3u);
  svg.curve({}, {0, 0, 0, "black"}, 1, {0, 0, 100, 100}, "");
  EXPECT_EQ(pathCount(svg), 3u) << "nothing to draw";
}

}  // namespace
}  // namespace musclesim
