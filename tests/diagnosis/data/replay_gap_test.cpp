#include "diagnosis/data/replay_gap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "diagnosis/report/gap_figure.h"

namespace musclesim {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Rows 0.1 s apart with these residuals, and a noise of 1.
ReplayGap gapWith(const std::vector<double>& residuals) {
  ReplayGap gap{"length_0_mm", {}, {}, {}, 1};
  for (const double residual : residuals) {
    gap.time_s.push_back(0.1 * static_cast<double>(gap.time_s.size()));
    gap.measured.push_back(200 + residual);
    gap.simulated.push_back(200);
  }
  return gap;
}

TEST(ReplayGap, LeavesItsBandWhereTwoRowsInARowAreOutsideOnOneSide) {
  const ReplayGap gap = gapWith({0, 4, 0, 4, 5, 4, 0, -4, 4, 0, -3.5, nan, -3.5});
  const auto outside_s = gap.outsideS();
  ASSERT_EQ(outside_s.size(), 2u);
  EXPECT_NEAR(outside_s[0].first, 0.3, 1e-12);
  EXPECT_NEAR(outside_s[0].second, 0.5, 1e-12);
  EXPECT_NEAR(outside_s[1].first, 1.0, 1e-12) << "a row that is not measured does not interrupt";
  EXPECT_NEAR(outside_s[1].second, 1.2, 1e-12);
  EXPECT_TRUE(gapWith({2.9, 2.9, -2.9, -2.9}).outsideS().empty()) << "three standard deviations";
}

TEST(ReplayGap, ResidualIsMeasuredMinusSimulated) {
  ReplayGap gap = gapWith({3, 4, nan});
  EXPECT_EQ(gap.residual(0), 3);
  EXPECT_NEAR(gap.rmse(), std::sqrt(12.5), 1e-12);
  gap.simulated.pop_back();
  gap.simulated.pop_back();
  EXPECT_TRUE(std::isnan(gap.residual(1))) << "the simulation ended before";
  EXPECT_EQ(gap.rmse(), 3);
}

TEST(ReplayGap, CommandsAndSignalsWithoutReadingsAreLeftOut) {
  Recording measured, simulated;
  measured.time_s = simulated.time_s = {0, 1};
  measured.signals = {{"command_0", {0, 1}}, {"length_0_mm", {200, 210}}, {"force_0_N", {nan, nan}}};
  simulated.signals = {{"command_0", {0, 1}}, {"pressure_0", {0, 1}}, {"force_0_N", {1, 2}}, {"length_0_mm", {200, 205}}};
  measured.info.noise_std["length_0_mm"] = 0.5;
  const std::vector<ReplayGap> gaps = replayGaps(measured, simulated);
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_EQ(gaps[0].name, "length_0_mm");
  EXPECT_EQ(gaps[0].residual(1), 5);
  EXPECT_EQ(gaps[0].noise_sigma, 0.5) << "the estimate of the diagnosis";
}

TEST(ReplayGap, WidestIsTheLargestMultipleOfItsNoise) {
  EXPECT_EQ(widestGap({}), -1);
  std::vector<ReplayGap> gaps = {gapWith({10, 10}), gapWith({3, 3})};
  EXPECT_EQ(widestGap(gaps), 0);
  gaps[1].noise_sigma = 0.1;
  EXPECT_EQ(widestGap(gaps), 1);
}

long count(const std::string& text, const std::string& part) {
  long found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(GapFigure, HasValuesResidualsAndLoops) {
  std::vector<ReplayGap> gaps = {gapWith({1, -1, 1}), gapWith({0, 1, 2}), gapWith({0, -1, -2})};
  gaps[1].name = "pressure_0";
  gaps[2].name = "angle_elbow_deg";
  const std::string svg = gapFigureSvg("run.csv: measured and simulated", gaps);
  for (const char* title : {"pressure_0: residual, RMS 1.29", "length_0_mm over pressure_0", "angle_elbow_deg over pressure_0",
                            "noise band: 3 standard deviations of the noise", "length (mm)", "pressure (fraction)"})
    EXPECT_EQ(count(svg, std::string(">") + title + "<") > 0, true) << title;
  constexpr const char* band = "fill=\"#ccdef2\"";
  EXPECT_EQ(count(svg, band), 3) << "one for each signal";
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace musclesim
