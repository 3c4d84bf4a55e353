#include "log/row_text.h"

#include <cmath>
#include <limits>

#include "log_fixture.h"

namespace musclesim {
namespace {

TEST(RowText, HeaderAndRows) {
  RowText rows({"command_0", "length_0_mm"});
  std::string text = rows.header();
  rows.append(text, 0, {0.1, std::nan("")});
  rows.append(text, 0.1 + 0.2, {1 + 1e-12, -0.0});
  EXPECT_EQ(text, "time_s,command_0,length_0_mm\n0,0.1,\n0.30000000000000004,1,-0\n");
}

TEST(RowText, RefusesWhatCouldNotBeRead) {
  EXPECT_THROW(RowText({"length_0_mm"}), BadParameter);
  EXPECT_THROW(RowText({"command_0", "command_0"}), BadParameter);
  EXPECT_THROW(RowText({"command_0", "time_s"}), BadParameter);
  EXPECT_THROW(RowText({"command_0", "length_0_cm"}), BadParameter);
  EXPECT_THROW(RowText({"command_0", "speed"}), BadParameter);
  RowText rows({"command_0", "force_0_N"});
  std::string text;
  rows.append(text, 1, {0, 0});
  const std::string before = text;
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([&] { rows.append(text, 1, {0, 0}); }), {"time_s = 1 s", "later"}));
  EXPECT_THROW(rows.append(text, std::nan(""), {0, 0}), BadParameter);
  EXPECT_THROW(rows.append(text, 2, {0}), BadParameter);
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([&] { rows.append(text, 2, {1.5, 0}); }), {"command_0 at 2 s = 1.5", "0 .. 1"}));
  EXPECT_THROW(rows.append(text, 2, {std::nan(""), 0}), BadParameter);
  EXPECT_THROW(rows.append(text, 2, {0, std::numeric_limits<double>::infinity()}), BadParameter);
  EXPECT_EQ(text, before);
  EXPECT_NO_THROW(rows.append(text, 2, {0, 0}));
}

}  // namespace
}  // namespace musclesim
