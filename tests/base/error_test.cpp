#include "musclesim/base/error.h"

#include <gtest/gtest.h>

namespace musclesim {
namespace {

TEST(BadParameter, NamesValueAndAllowedRange) {
  EXPECT_STREQ(BadParameter("rig.load_kg", "-3 kg", "lie in 0 .. 1000 kg").what(), "rig.load_kg = -3 kg: must lie in 0 .. 1000 kg");
}

TEST(BadFile, GivesThePlaceAsFarAsItIsKnown) {
  const BadFile cell("a.csv", 3, 14, "is not a number");
  EXPECT_STREQ(cell.what(), "a.csv:3:14: is not a number");
  EXPECT_EQ(cell.file(), "a.csv");
  EXPECT_EQ(cell.line(), 3);
  EXPECT_EQ(cell.column(), 14);
  EXPECT_STREQ(BadFile("a.csv", 3, 0, "is too short").what(), "a.csv:3: is too short");
  EXPECT_STREQ(BadFile("a.csv", "has no rows").what(), "a.csv: has no rows");
}

TEST(Diverged, NamesTimeAndPlace) {
  const Diverged error(1.25, "humerus", "position is not finite");
  EXPECT_STREQ(error.what(), "the simulation diverged at 1.25 s: humerus: position is not finite");
  EXPECT_EQ(error.time_s(), 1.25);
  EXPECT_EQ(error.where(), "humerus");
}

}  // namespace
}  // namespace musclesim
