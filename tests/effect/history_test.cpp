#include "effect/history.h"

#include <gtest/gtest.h>

namespace musclesim {
namespace {

TEST(HeldHistory, GivesTheValueThatWasInForce) {
  HeldHistory history;
  history.hold(0, 1);
  history.hold(1, 2);
  history.hold(2, 5);
  EXPECT_EQ(history.at(-10), 1);
  EXPECT_EQ(history.at(0.5), 1);
  EXPECT_EQ(history.at(1), 2);
  EXPECT_EQ(history.at(1.9), 2);
  EXPECT_EQ(history.at(7), 5);
}

TEST(HeldHistory, MeansOverChanges) {
  HeldHistory history;
  history.hold(0, 1);
  history.hold(1, 2);
  history.hold(2, 5);
  EXPECT_DOUBLE_EQ(history.mean(-3, 0.5), 1);
  EXPECT_DOUBLE_EQ(history.mean(0.5, 1.5), 1.5);
  EXPECT_DOUBLE_EQ(history.mean(0.5, 2.5), (0.5 * 1 + 1 * 2 + 0.5 * 5) / 2);
  EXPECT_EQ(history.mean(2, 3), 5);
}

TEST(HeldHistory, ForgetsOnlyWhatLiesBefore) {
  HeldHistory history;
  for (int i = 0; i < 10; ++i) history.hold(i, i);
  history.forgetBefore(5.5);
  EXPECT_EQ(history.at(5.5), 5);
  EXPECT_EQ(history.at(9), 9);
}

TEST(SampledHistory, JoinsSamplesByStraightLines) {
  SampledHistory history;
  history.add(0, 1);
  history.add(1, 3);
  history.add(1, 5);
  EXPECT_EQ(history.at(-1), 1);
  EXPECT_EQ(history.at(0.25), 2);
  EXPECT_EQ(history.at(1), 5);
  EXPECT_EQ(history.at(2), 5);
}

}  // namespace
}  // namespace musclesim
