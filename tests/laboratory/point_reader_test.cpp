#include "laboratory/point_reader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "laboratory/point_groups.h"
#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// A realistic table of 4 pressures by 4 lengths, F = 100 p (l - 200) / 100 + 5 N.
std::string table(const std::string& header = "pressure,length_mm,force_N", double length_factor = 1) {
  std::string text = header + "\n";
  for (const double p : {0.25, 0.5, 0.75, 1.0})
    for (const double l : {210.0, 240.0, 270.0, 300.0}) text += fmt::format("{},{},{}\n", p, l * length_factor, p * (l - 200) + 5);
  return text;
}

std::string refusal(const std::string& text, const StaticPointsOptions& options = {}) {
  return messageOf<BadFile>([&] { parseStaticPoints(text, "data.csv", options); });
}

TEST(StaticPoints, ReadsAllUnits) {
  const StaticPoints mm = parseStaticPoints(table(), "data.csv");
  ASSERT_EQ(mm.points.size(), 16u);
  EXPECT_FALSE(mm.full_scale_kPa);
  EXPECT_EQ(mm.points[5].line, 7);
  EXPECT_EQ(mm.points[5].pressure_ratio, 0.5);
  EXPECT_EQ(mm.points[5].length_mm, 240);
  EXPECT_EQ(mm.points[5].force_N, 25);
  for (const auto& [unit, factor] : {std::pair<std::string, double>{"cm", 0.1}, {"m", 0.001}})
    EXPECT_NEAR(parseStaticPoints(table("pressure,length_" + unit + ",force_N", factor), "data.csv").points[5].length_mm, 240, 1e-9);
  for (const auto& [unit, kPa] : {std::pair<std::string, double>{"kPa", 1}, {"bar", 100}, {"MPa", 1000}}) {
    const StaticPoints points = parseStaticPoints(table("pressure_" + unit + ",length_mm,force_N"), "data.csv");
    EXPECT_NEAR(*points.full_scale_kPa, kPa, 1e-9) << "the largest pressure of the file is full scale";
    EXPECT_NEAR(points.points[5].pressure_ratio, 0.5, 1e-12);
  }
  StaticPointsOptions options;
  options.full_scale_kPa = 8;
  EXPECT_NEAR(parseStaticPoints(table("pressure_kPa,length_mm,force_N"), "data.csv", options).points[5].pressure_ratio, 0.0625, 1e-12);
}

TEST(StaticPoints, MapsColumnsAndFiltersRows) {
  StaticPointsOptions options;
  options.columns = {{"length", "L:mm"}, {"pressure", "P:fraction"}, {"force", "pull_N"}};
  EXPECT_EQ(parseStaticPoints(table("P,L,pull_N"), "data.csv", options).points[5].force_N, 25);
  options.where = {{"P", "0.5"}};
  EXPECT_TRUE(contains(refusal(table("P,L,pull_N"), options), "4 points pass the filter")) << "the filter keeps one pressure";
  options.where = {{"muscle", "3"}};
  EXPECT_TRUE(contains(refusal(table("P,L,pull_N"), options), "there is no column \"muscle\"; the columns are P, L, pull_N"));
  options.where.clear();
  options.columns = {{"length", "L"}, {"pressure", "P"}, {"force", "pull_N"}};
  const StaticPoints plain = parseStaticPoints(table("P,L,pull_N"), "data.csv", options);
  EXPECT_EQ(plain.points[5].length_mm, parseStaticPoints(table("pressure,length_mm,force_N"), "data.csv").points[5].length_mm);
  EXPECT_TRUE(contains(plain.notes.at(0), "no unit is given; assumed: P in fractions of full scale, L in mm"));
  options.columns = {{"length", "L_kPa"}};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { parseStaticPoints(table("pressure,L_kPa,force_N"), "data.csv", options); }),
                       "length=L_kPa: must be a column that ends like length_mm"));
}

TEST(StaticPoints, ColumnsByNumberAndUnitsOfInstruments) {
  StaticPointsOptions options;
  options.columns = {{"length", "#2:inch"}, {"pressure", "#1:psi"}, {"force", "#3:lbf"}};
  const StaticPoints points = parseStaticPoints(table("x,x,x", 1 / 25.4), "data.csv", options);
  EXPECT_NEAR(points.points[5].length_mm, 240, 1e-9);
  EXPECT_NEAR(*points.full_scale_kPa, 6.894757293168361, 1e-12);
  EXPECT_NEAR(points.points[5].force_N, 25 * 4.4482216152605, 1e-9);
  options.columns = {{"length", "x:mm"}, {"pressure", "#1"}, {"force", "#3"}};
  EXPECT_TRUE(contains(refusal(table("x,x,x"), options), "data.csv:1:3: several columns are named \"x\": 1 and 2"));
  options.columns.clear();
  options.where = {{"a", "1"}};
  EXPECT_TRUE(contains(refusal(table("pressure,length_mm,force_N,a,a"), options), "several columns are named \"a\": 4 and 5"));
}

TEST(StaticPoints, TakesTheMappingOfATable) {
  const auto folder = std::filesystem::temp_directory_path() / ("musclesim_point_mapping_test_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  StaticPointsOptions options;
  options.mapping = (folder / "map.toml").string();
  const auto map = [&](const std::string& text) { std::ofstream(options.mapping) << text; };
  std::string text = "(kPa);(mm);(N)\n";
  for (const double p : {200.0, 400.0, 600.0})
    for (const double l : {210.0, 240.0, 270.0}) text += fmt::format("{},5;{};{}\n", p + 101, l - 200, p / 600 * (l - 200) + 5);
  map("[table]\nseparator = \";\"\ndecimal = \",\"\nheader = false\nskip_before_header = 1\n[columns]\npressure_kPa = { from = 1, "
      "ambient_kPa = 101.5 }\nlength_mm = { from = 2, offset = 200 }\nforce_N = { from = 3 }\n");
  for (char& c : text)
    if (c == '.') c = ',';
  const StaticPoints points = parseStaticPoints(text, "data.csv", options);
  ASSERT_EQ(points.points.size(), 9U);
  EXPECT_NEAR(*points.full_scale_kPa, 600, 1e-9);
  EXPECT_EQ(points.points[0].length_mm, 210);
  EXPECT_EQ(points.points[0].line, 2);
  map("[columns]\npressure_kPa = { value = 300 }\n");
  EXPECT_TRUE(contains(refusal("length_mm,force_N\n200,1\n210,2\n220,3\n230,4\n240,5\n250,6\n260,7\n270,8\n", options),
                       "all 8 points have the pressure 300 kPa"));
  map("[columns]\ntime_s = \"t\"\n");
  EXPECT_TRUE(contains(refusal(table(), options), "static points have no time"));
  map("[columns]\npressure_0_kPa = \"p\"\n");
  EXPECT_TRUE(contains(refusal(table(), options), "columns.pressure_0_kPa: static points have pressure"));
  EXPECT_TRUE(contains(refusal(table(), options), "map.toml:2:1: columns.pressure_0_kPa"));
  map("[columns]\nforce_N = \"forse_N\"\n");
  EXPECT_TRUE(
      contains(refusal(table(), options), "map.toml:2:1: columns.force_N: data.csv:1: there is no column \"forse_N\"; did you mean"));
  std::filesystem::remove_all(folder);
}

TEST(StaticPoints, MissingUnitsAreExplained) {
  const std::string message = refusal(table("pressure,length,force_N"));
  EXPECT_TRUE(contains(message, "data.csv:1:10"));
  EXPECT_TRUE(contains(message, "column length has no unit; allowed: length_mm, length_cm, length_m"));
  EXPECT_TRUE(contains(refusal(table("pressure,length_mm,force")), "column force has no unit; allowed: force_N"));
  EXPECT_TRUE(contains(refusal(table("p,length_mm,force_N")), "no column holds the pressure"));
  EXPECT_TRUE(contains(refusal(table("pressure,length_feet,force_N")), "length_mm, length_cm, length_m"));
  const std::string pressures_without_unit = refusal("pressure,length_mm,force_N\n600,200,5\n" + table().substr(27));
  EXPECT_TRUE(contains(pressures_without_unit, "data.csv:2:1"));
  EXPECT_TRUE(contains(pressures_without_unit, "600 must lie in -0.05 .. 1.05"));
  EXPECT_TRUE(contains(pressures_without_unit, "pressure_kPa"));
}

TEST(StaticPoints, ValuesThatCannotBeAreNamedWithLineAndRange) {
  const std::string negative = refusal(table() + "0.5,-240,25\n");
  EXPECT_TRUE(contains(negative, "data.csv:18:5"));
  EXPECT_TRUE(contains(negative, "column length_mm: -240 mm must lie in 5 .. 10000 mm"));
  EXPECT_TRUE(contains(refusal(table("pressure,length_mm,force_N", 0.001)), "0.21 mm must lie in 5 .. 10000 mm"));
  EXPECT_TRUE(contains(refusal(table() + "0.5,240,1e6\n"), "1e+06 N must lie in -1000 .. 100000 N"));
}

TEST(StaticPoints, TooFewPointsPressuresOrLengthsAreExplained) {
  EXPECT_TRUE(contains(refusal("pressure,length_mm,force_N\n0.5,200,3\n1,250,10\n"), "2 points; at least 8 are needed"));
  std::string one_pressure = "pressure,length_mm,force_N\n", one_length = one_pressure, slack = one_pressure;
  for (int i = 0; i < 10; ++i) {
    one_pressure += fmt::format("0.5,{},{}\n", 200 + 10 * i, 5 * i);
    one_length += fmt::format("{},200,{}\n", 0.1 * i, 5 * i);
    slack += fmt::format("{},{},{}\n", 0.1 * i, 200 + 10 * (i % 3), i > 6 ? 10 * i : 0);
  }
  EXPECT_TRUE(contains(refusal(one_pressure), "data.csv:2: all 10 points have the pressure 0.5"));
  EXPECT_TRUE(contains(refusal(one_length), "data.csv:2: all 10 points have the length 200 mm"));
  EXPECT_TRUE(contains(refusal(slack), "only 3 of 10 points are above the floor of 0 N; at least 8 are needed"));
}

TEST(StaticPoints, SwappedColumnsAreFound) {
  EXPECT_TRUE(contains(refusal(table("length_mm,pressure,force_N")), "must lie in"));
  EXPECT_TRUE(contains(refusal(table("pressure,force_N,length_mm")), "columns"));
  // Pressures in kPa and lengths in mm have similar sizes, but no muscle stretches to ten times its shortest length.
  std::string swapped = "length_mm,pressure_kPa,force_N\n", force_pressure = "force_N,length_mm,pressure_kPa\n";
  for (const double p : {50.0, 100.0, 300.0, 600.0})
    for (const double l : {220.0, 250.0, 280.0}) {
      swapped += fmt::format("{},{},{}\n", p, l, p * (l - 200) / 100 + 1);
      force_pressure += fmt::format("{},{},{}\n", p, l, p * (l - 200) / 100 + 1);
    }
  EXPECT_TRUE(contains(refusal(swapped), "are the columns swapped"));
  EXPECT_TRUE(contains(refusal(force_pressure), "the force falls with length"));
}

TEST(StaticPoints, RepeatedLowestForceIsTheSensorsFloor) {
  std::string text = table();
  for (const double l : {200.0, 205.0, 208.0}) text += fmt::format("0.1,{},-8.74\n", l);
  const StaticPoints points = parseStaticPoints(text, "data.csv");
  EXPECT_EQ(points.censoredCount(), 3);
  EXPECT_EQ(points.floor_N, -8.74);
  EXPECT_EQ(points.measured().size(), 16u);
  EXPECT_TRUE(contains(points.notes.back(), "3 of 19 points are at or below -8.74 N"));
  StaticPointsOptions options;
  options.censored_below_N = 12;
  EXPECT_EQ(parseStaticPoints(text, "data.csv", options).censoredCount(), 5) << "the three, and 7.5 N and 10 N";
}

TEST(StaticPoints, RowsWithoutAMeasurementAreSkippedAndSaid) {
  const StaticPoints points = parseStaticPoints(table() + "0.5,,25\nnan,210,3\n", "data.csv");
  EXPECT_EQ(points.points.size(), 16u);
  EXPECT_TRUE(contains(points.notes.front(), "2 rows without"));
}

TEST(PointGroups, SweptPressuresAreBinned) {
  std::vector<StaticPoint> points(200);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].pressure_ratio = static_cast<double>(i) / 199;
    points[i].length_mm = i % 2 == 0 ? 200 : 200.3;  // 0.15 % apart: counts as one length
  }
  EXPECT_EQ(groupByPressure(points).size(), 10u);
  EXPECT_EQ(groupByLength(points).size(), 1u);
  points.resize(30);
  EXPECT_EQ(groupByPressure(points).size(), 30u);
}

}  // namespace
}  // namespace musclesim
