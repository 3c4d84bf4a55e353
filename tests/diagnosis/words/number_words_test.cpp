// Numbers in words.
#include "diagnosis/words/number_words.h"

#include <gtest/gtest.h>

namespace musclesim {
namespace {

TEST(Words, NothingIsCertainOrComplete) {
  EXPECT_EQ(percentWords(96.24), "96.2 %");
  EXPECT_EQ(percentWords(99.97), "more than 99.9 %");
  EXPECT_EQ(percentWords(100), "more than 99.9 %");
  EXPECT_EQ(percentWords(-3), "-3.0 %");
  EXPECT_EQ(leftWords(3.81), "3.81 %");
  EXPECT_EQ(leftWords(0.0004), "less than 0.1 %");
  EXPECT_EQ(probabilityWords(0.93), "93 %");
  EXPECT_EQ(probabilityWords(1), "over 99 %");
  EXPECT_EQ(probabilityWords(0), "under 1 %");
}

TEST(Words, AnEstimateHasTheDecimalsThatItsIntervalBears) {
  EXPECT_EQ(estimateWords({1.0452, 1.045, 1.0454}), "1.0452 (1.0450 to 1.0454)");
  EXPECT_EQ(estimateWords({0.060037, 0.059866, 0.060207}), "0.06004 (0.05987 to 0.06021)");
  EXPECT_EQ(estimateWords({-12.92, -13.1, -12.74}), "-12.92 (-13.10 to -12.74)");
  EXPECT_EQ(estimateWords({5400, 5000, 5800}), "5400 (5000 to 5800)");
  EXPECT_EQ(estimateWords({8, 8, 8}), "8");
  EXPECT_EQ(estimateWords({-0.004, -0.07, 0.06}), "0.00 (-0.07 to 0.06)") << "a zero has no sign";
  EXPECT_EQ(estimateWords({0, 0, 0.00162}), "0 (0 to 0.0016)");
  EXPECT_EQ(estimateWords({1e-12, 0, 2e-12}), "1e-12 (0 to 2e-12)");
}

}  // namespace
}  // namespace musclesim
