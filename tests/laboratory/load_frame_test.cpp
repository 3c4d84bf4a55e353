#include "laboratory/load_frame.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "laboratory/frame_report.h"
#include "musclesim/base/units.h"

namespace musclesim {
namespace {

const FrameSpecimen& medium() {
  return frameSpecimens()[1];
}

TEST(LoadFrame, StepsAreThePapers) {
  EXPECT_EQ(framePressures().size(), 9u);
  EXPECT_EQ(framePressures().front(), 0);
  EXPECT_NEAR(framePressures()[1], 32.0 / 255, 1e-15);
  EXPECT_EQ(framePressures().back(), 1);
  EXPECT_EQ(frameLoadsKg().size(), 11u);
  EXPECT_NEAR(frameLoadsKg().back(), 8.7, 1e-12);
}

/// Friction of 1 N per slider opposes the motion: while loading the law is below the load, while unloading above it.
TEST(LoadFrame, LoadsHangWhereTheLawSaysUpToFrictionAndWeight) {
  const auto points = loadSteps(medium(), {}, {0.5});
  ASSERT_EQ(points.size(), 21u);
  constexpr double friction_N = 1, chain_N = 10 * 0.010 * gravity_m_per_s2, solver_N = 0.05;
  int free_count = 0;
  for (const auto& point : points) {
    EXPECT_TRUE(point.at_rest) << point.force_N;
    if (point.isStopped()) continue;
    ++free_count;
    EXPECT_GT(point.law_N, point.force_N - friction_N - solver_N) << point.length_mm;
    EXPECT_LT(point.law_N, point.force_N + friction_N + chain_N + solver_N) << point.length_mm;
  }
  EXPECT_GT(free_count, 10);
  EXPECT_LE(frameError(freePoints(points)), 1e-3);
}

TEST(LoadFrame, WithoutFrictionBothWaysAgree) {
  Parameters parameters;
  parameters.set("muscle.slider_friction_N", 0.0, "test");
  parameters.set("muscle.hinge_friction_Nm", 0.0, "test");
  const auto points = loadSteps(medium(), parameters, {0.75});
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(points[i].length_mm, points[20 - i].length_mm, 0.3) << i;
}

TEST(LoadFrame, HeavierLoadsThanTheMuscleHoldsRestOnAllStops) {
  const auto points = loadSteps(medium(), {}, {0});
  const FramePoint& heaviest = points[10];
  EXPECT_EQ(heaviest.long_stop_count, heaviest.link_count);
  EXPECT_NEAR(heaviest.length_mm, 300, 0.1);
  EXPECT_LT(heaviest.law_N, heaviest.force_N - 5) << "the stops carry the rest";
}

TEST(LoadFrame, ImposedLengthsReadTheLawUpToFrictionAndWeight) {
  const auto points = lengthSteps(medium(), {}, {0.5});
  ASSERT_EQ(points.size(), 21u);
  constexpr double friction_N = 1, chain_N = 10 * 0.010 * gravity_m_per_s2, solver_N = 0.2;
  for (const auto& point : points) EXPECT_NEAR(point.force_N, point.law_N, friction_N + chain_N + solver_N) << point.length_mm;
  EXPECT_NEAR(points[5].length_mm, (75 + 300) / 2.0, 0.5);
}

/// A law for a made-up experiment.
class Line final : public ForceLaw {
 public:
  double tensionN(double, double length_mm) const override { return length_mm - 100; }
  std::string name() const override { return "line"; }
};

/// The frame reads 2 N more than the law while loading and 2 N less while unloading: the mean is the law.
TEST(FrameReport, MeasuredPointsAreComparedAtTheSamePressureAndLength) {
  std::vector<FramePoint> lengths;
  for (const FrameWay way : {FrameWay::loading, FrameWay::unloading})
    for (const double pressure_ratio : {0.0, 1.0})
      for (const double length_mm : {150.0, 200.0}) {
        FramePoint point;
        point.pressure_ratio = pressure_ratio;
        point.length_mm = length_mm;
        point.law_N = length_mm - 100;
        point.force_N = point.law_N + (way == FrameWay::loading ? 2 : -2);
        point.way = way;
        point.link_count = 4;
        lengths.push_back(point);
      }
  StaticPoints measured;
  measured.points = {{0.5, 180, 80, 2}, {0.0, 160, 50, 3}, {0.5, 220, 120, 4}};
  const DataComparison comparison = compareWithData(lengths, Line(), measured);
  EXPECT_EQ(comparison.compared_count, 2);
  EXPECT_EQ(comparison.outside_count, 1);
  EXPECT_NEAR(comparison.relative_squared_error, 100.0 / (80 * 80 + 50 * 50), 1e-12);
}

}  // namespace
}  // namespace musclesim
