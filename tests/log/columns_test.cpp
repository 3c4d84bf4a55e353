#include "log/columns.h"

#include <numbers>

#include "log_fixture.h"

namespace musclesim {
namespace {

TEST(Columns, EveryAllowedNameAndItsConversion) {
  struct Case {
    const char* written;
    const char* canonical;
    double factor;
    FullScale full_scale;
  };
  const double degrees = 180 / std::numbers::pi;
  const std::vector<Case> cases = {
      {"time_s", "time_s", 1, FullScale::none},
      {"command_0", "command_0", 1, FullScale::none},
      {"command_12", "command_12", 1, FullScale::none},
      {"command_3_kPa", "command_3", 1, FullScale::pressure_kPa},
      {"command_3_bar", "command_3", 100, FullScale::pressure_kPa},
      {"command_3_MPa", "command_3", 1000, FullScale::pressure_kPa},
      {"command_3_V", "command_3", 1, FullScale::command_V},
      {"pressure_9", "pressure_9", 1, FullScale::none},
      {"pressure_9_kPa", "pressure_9", 1, FullScale::pressure_kPa},
      {"pressure_9_bar", "pressure_9", 100, FullScale::pressure_kPa},
      {"pressure_9_MPa", "pressure_9", 1000, FullScale::pressure_kPa},
      {"force_0_N", "force_0_N", 1, FullScale::none},
      {"length_0_mm", "length_0_mm", 1, FullScale::none},
      {"length_0_cm", "length_0_mm", 10, FullScale::none},
      {"length_0_m", "length_0_mm", 1000, FullScale::none},
      {"angle_elbow_deg", "angle_elbow_deg", 1, FullScale::none},
      {"angle_left_wrist_2_rad", "angle_left_wrist_2_deg", degrees, FullScale::none},
      {"hand_x_mm", "hand_x_mm", 1, FullScale::none},
      {"hand_y_cm", "hand_y_mm", 10, FullScale::none},
      {"hand_z_m", "hand_z_mm", 1000, FullScale::none},
      {"target_x_mm", "target_x_mm", 1, FullScale::none},
      {"target_y_m", "target_y_mm", 1000, FullScale::none},
      {"target_elbow_deg", "target_elbow_deg", 1, FullScale::none},
      {"target_elbow_rad", "target_elbow_deg", degrees, FullScale::none},
      {"angle_left_wrist_2_deg_per_s", "angle_left_wrist_2_deg_per_s", 1, FullScale::none},
      {"angle_elbow_deg_per_s2", "angle_elbow_deg_per_s2", 1, FullScale::none},
      {"length_0_mm_per_s", "length_0_mm_per_s", 1, FullScale::none},
      {"hand_y_mm_per_s2", "hand_y_mm_per_s2", 1, FullScale::none},
      {"target_z_mm", "target_z_mm", 1, FullScale::none},
      {"activity", "activity", 1, FullScale::none},
      {"controller_integral_kPa", "controller_integral_kPa", 1, FullScale::none},
  };
  for (const auto& expected : cases) {
    const Column column = parseColumnName(expected.written);
    EXPECT_EQ(column.name, expected.canonical) << expected.written;
    EXPECT_DOUBLE_EQ(column.factor, expected.factor) << expected.written;
    EXPECT_EQ(column.full_scale, expected.full_scale) << expected.written;
  }
}

TEST(Columns, RefusesOtherNamesAndSaysWhatIsAllowed) {
  for (const char* name : {"",
                           "time",
                           "time_ms",
                           "command",
                           "command_",
                           "command_-1",
                           "command_01",
                           "command_1000",
                           "command_999",
                           "command_0_psi",
                           "pressure_0_V",
                           "force_0",
                           "force_0_kN",
                           "length_0",
                           "length_0_",
                           "length_x_mm",
                           "angle_deg",
                           "angle__deg",
                           "angle_elbow",
                           "angle_el bow_deg",
                           "hand_y",
                           "hand_w_mm",
                           "hand_xy_mm",
                           "activity_0",
                           "activity_",
                           "Time_s",
                           "time_s_s",
                           "_",
                           "x"})
    EXPECT_TRUE(hasWords(messageOf<BadParameter>([&] { parseColumnName(name); }), {"allowed: "})) << name;
  EXPECT_TRUE(
      hasWords(messageOf<BadParameter>([] { parseColumnName("velocity_0_mm"); }),
               {"unknown quantity", "time_s", "command_<i>[_kPa|bar|MPa|V]", "angle_<joint>_deg|rad", "hand_x|y|z_mm|cm|m", "activity"}));
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([] { parseColumnName("length_3_inch"); }), {"unknown unit", "allowed: length_<i>_mm|cm|m"}));
}

TEST(Columns, SuggestsTheNearestName) {
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([] { parseColumnName("time"); }), {"did you mean \"time_s\"?"}));
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([] { parseColumnName("lenght_7_mm"); }), {"did you mean \"length_7_mm\"?"}));
}

TEST(Columns, CanonicalNamesOnly) {
  EXPECT_NO_THROW(parseCanonicalName("length_0_mm"));
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([] { parseCanonicalName("length_0_cm"); }), {"canonical unit: length_0_mm"}));
}

int countCommands(const std::vector<std::string>& names) {
  std::vector<Column> columns;
  for (const auto& name : names) columns.push_back(parseColumnName(name));
  return requireCommands(columns);
}

TEST(Columns, CommandsAreNumberedWithoutGaps) {
  EXPECT_EQ(countCommands({"time_s", "command_1", "length_0_mm", "command_0"}), 2);
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([] { countCommands({"time_s"}); }), {"no column command_0"}));
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([] { countCommands({"command_0", "command_2"}); }), {"no column command_1", "command_2"}));
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([] { countCommands({"command_1"}); }), {"no column command_0"}));
  EXPECT_TRUE(hasWords(messageOf<BadParameter>([] { countCommands({"command_0", "force_1_N"}); }), {"force_1_N", "without command"}));
}

TEST(Columns, UnitsOfSignals) {
  EXPECT_EQ(signalUnit("length_0_mm"), "mm");
  EXPECT_EQ(signalUnit("force_0_N"), "N");
  EXPECT_EQ(signalUnit("angle_elbow_deg"), "deg");
  EXPECT_EQ(signalUnit("command_0"), "");
  EXPECT_EQ(signalUnit("no such signal"), "");
}

}  // namespace
}  // namespace musclesim
