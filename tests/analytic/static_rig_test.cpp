#include "static_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

namespace musclesim {
namespace {

/// Tests one pressure with all loads from both directions.
class StaticRigAt : public ::testing::TestWithParam<double> {};

TEST_P(StaticRigAt, RestsWithinTheFrictionBandFromBothDirections) {
  int at_stops_count = 0;
  for (const double load_kg : staticLoadsKg())
    for (const bool from_longer : {false, true}) {
      const StaticRig rig{GetParam(), load_kg, 1, from_longer};
      const auto result = rig.settle();
      SCOPED_TRACE(testing::Message() << load_kg << " kg from " << (from_longer ? "longer" : "shorter") << ": " << result.length_mm
                                      << " mm, " << result.long_stop_count << " links at long stops, " << result.short_stop_count
                                      << " at short ones");
      EXPECT_TRUE(result.at_rest);
      if (result.long_stop_count == StaticRig::link_count || result.short_stop_count == StaticRig::link_count) {
        ++at_stops_count;  // the stops carry the load, so the force law does not determine the length
        continue;
      }
      // Closed-form bounds: the chain's weight acts somewhere between its upper and lower end, plus or minus friction.
      constexpr double solver_N = 0.02;
      EXPECT_GT(result.tension_N, rig.loadN() - 1 - solver_N);
      EXPECT_LT(result.tension_N, rig.loadN() + StaticRig::chainN() + 1 + solver_N);
      // The same check for each link.
      for (std::size_t i = 0; i < result.links.size(); ++i) {
        const auto& link = result.links[i];
        const double excess_N = result.tension_N - link.weight_N;
        if (!link.at_long_stop) {
          EXPECT_GT(excess_N, -1 - solver_N) << "link " << i << " would get longer";
        }
        if (!link.at_short_stop) {
          EXPECT_LT(excess_N, 1 + solver_N) << "link " << i << " would get shorter";
        }
      }
    }
  RecordProperty("points_with_all_links_at_their_stops", at_stops_count);
  EXPECT_LE(at_stops_count, 2);
}

TEST_P(StaticRigAt, RestsWithinATenthOfAMillimetreWithoutFriction) {
  for (const double load_kg : staticLoadsKg())
    for (const bool from_longer : {false, true}) {
      const StaticRig rig{GetParam(), load_kg, 0, from_longer};
      const auto result = rig.settle();
      EXPECT_TRUE(result.at_rest) << load_kg;
      EXPECT_NEAR(result.length_mm, rig.frictionlessLengthMm(), 0.1) << load_kg << " kg from " << (from_longer ? "longer" : "shorter");
    }
}

INSTANTIATE_TEST_SUITE_P(Pressure, StaticRigAt, ::testing::ValuesIn(staticPressures()),
                         [](const auto& tested) { return std::to_string(static_cast<int>(std::lround(100 * tested.param))) + "_percent"; });

TEST(StaticRig, WithoutFrictionNeitherDirectionNorHistoryMatters) {
  const StaticRig shorter{0.5, 2, 0, false}, longer{0.5, 2, 0, true};
  EXPECT_NEAR(shorter.settle().length_mm, longer.settle().length_mm, 0.005);
}

TEST(StaticRig, TheChainsWeightMovesTheLengthByLessThanItsShare) {
  for (const double pressure : staticPressures())
    for (const double load_kg : staticLoadsKg()) {
      const StaticRig rig{pressure, load_kg, 0, false};
      const double slope = rig.law().stiffnessNPerMm(pressure, std::min(rig.frictionlessLengthMm(), rig.simpleLengthMm()));
      EXPECT_LT(std::abs(rig.frictionlessLengthMm() - rig.simpleLengthMm()), StaticRig::chainN() / 2 / slope);
    }
}

}  // namespace
}  // namespace musclesim
