#include "musclesim/controller/hands.h"

#include <gtest/gtest.h>

#include "musclesim/base/error.h"

namespace musclesim {
namespace {

constexpr double step_s = 0.01;

UserInput sampled(Hands& hands, long step) {
  return hands.sample(step_s * static_cast<double>(step));
}

TEST(Hands, RestingLeaveNoTrace) {
  Hands hands(2);
  for (long step = 0; step < 5; ++step) {
    EXPECT_EQ(sampled(hands, step), UserInput{});
    hands.note({0.1, 0.2});
  }
  EXPECT_TRUE(hands.history().changes.empty());
  EXPECT_EQ(hands.history().step_count, 5);
  EXPECT_EQ(hands.history().time_s, 0.04);
}

TEST(Hands, RepeatWhatWasDoneAndThenGoOnFromThere) {
  Hands first(2);
  const Pull pull{3, {1, 2, 3}, {40, 50, 60}};
  std::vector<UserInput> done;
  for (long step = 0; step < 6; ++step) {
    if (step == 1) first.set(1, 0.4);
    if (step == 2) first.pull(pull);
    if (step == 3) first.moveTarget({7, 8, 9});
    done.push_back(sampled(first, step));
  }
  EXPECT_EQ(done[0], UserInput{});
  EXPECT_EQ(done[1].pressures, (Action{0, 0.4}));
  EXPECT_EQ(done[5].pull, pull);

  Hands again(2, first.history());
  for (long step = 0; step < 6; ++step) {
    EXPECT_TRUE(again.isRepeating());
    again.set(0, 0.9);  // has no effect yet
    EXPECT_EQ(sampled(again, step), done[static_cast<std::size_t>(step)]) << step;
  }
  EXPECT_FALSE(again.isRepeating());
  EXPECT_EQ(again.history().changes, first.history().changes);
  const UserInput next = sampled(again, 6);
  EXPECT_FALSE(next.pull) << "nobody holds the body any more";
  EXPECT_EQ(next.pressures, (Action{0, 0.4}));
  EXPECT_EQ(next.target_mm, Vector(7, 8, 9));
}

TEST(Hands, NeedMuscles) {
  EXPECT_THROW(Hands(0), BadParameter);
  Hands hands(2);
  EXPECT_THROW(hands.set(2, 0.5), BadParameter);
}

}  // namespace
}  // namespace musclesim
