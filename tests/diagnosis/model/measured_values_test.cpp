// What was measured over all recordings.
#include "diagnosis/model/measured_values.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../planted.h"

namespace musclesim {
namespace {

TEST(MeasuredValues, AreThoseOfAllRecordings) {
  const DiagnosisOptions options;
  const Plant plant({planted::recorded({}, 0.15, 1), planted::recorded({}, 0.1, 3)}, options);
  const std::vector<double> lengths = measuredValues(plant, "length_0_mm");
  ASSERT_EQ(lengths.size(), plant.measured(0, 0).size() + plant.measured(1, 0).size());
  EXPECT_EQ(lengths.front(), plant.measured(0, 0).front());
  EXPECT_EQ(lengths.back(), plant.measured(1, 0).back());
  EXPECT_TRUE(measuredValues(plant, "angle_elbow_deg").empty());
}

/// The load of the rig hangs on its muscle and is not reported.
TEST(HandMm, FollowsFromTheLengthWhereItWasNotMeasured) {
  const DiagnosisOptions options;
  const Plant plant({planted::recorded({{"payload", "hand", {{"mass_kg", 0.5}}}}, 0.15, 1)}, options);
  const std::vector<double> lengths = measuredValues(plant, "length_0_mm");
  const std::array<std::vector<double>, 3> hand = handMm(plant);
  ASSERT_EQ(hand[1].size(), lengths.size());
  for (std::size_t i = 0; i < lengths.size(); ++i) EXPECT_NEAR(hand[1][i], -lengths[i], 0.05) << i;
  EXPECT_TRUE(hand[0].empty());
  EXPECT_TRUE(hand[2].empty());
}

}  // namespace
}  // namespace musclesim
