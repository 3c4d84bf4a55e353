#include "musclesim/base/color.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace musclesim {
namespace {

std::tuple<double, double, double> numbersOf(const Color& color) {
  return {color.red, color.green, color.blue};
}

TEST(MuscleColor, GivenColorsComeFirst) {
  const std::vector<Color> given = {{1, 0, 0, "red"}, {0, 1, 0, "green"}};
  EXPECT_EQ(muscleColor(0, given).name, "red");
  EXPECT_EQ(muscleColor(1, given).name, "green");
  EXPECT_EQ(muscleColor(2, given).name, muscleColor(0, {}).name);
}

TEST(MuscleColor, FurtherMusclesGetDifferentColors) {
  constexpr std::size_t muscle_count = 21;
  std::set<std::tuple<double, double, double>> seen;
  for (std::size_t muscle = 0; muscle < muscle_count; ++muscle) {
    const Color color = muscleColor(muscle, {});
    for (const double part : {color.red, color.green, color.blue}) EXPECT_TRUE(part >= 0 && part <= 1) << muscle;
    seen.insert(numbersOf(color));
  }
  EXPECT_EQ(seen.size(), muscle_count);
}

}  // namespace
}  // namespace musclesim
