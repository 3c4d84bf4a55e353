#include "musclesim/controller/manual.h"

#include <gtest/gtest.h>

#include "musclesim/base/error.h"

namespace musclesim {
namespace {

/// Counts its calls and commands the count in hundredths.
class Counting final : public Controller {
 public:
  Action output(const State&) override { return Action(3, 0.01 * ++count_); }
  std::optional<double> activity() const override { return 7.0; }

 private:
  int count_ = 0;
};

State at(double time_s) {
  State state;
  state.time_s = time_s;
  return state;
}

TEST(ManualController, PassesTheOtherControllerOn) {
  ManualController hands(std::make_unique<Counting>(), 3);
  EXPECT_EQ(hands.output(at(0)), Action(3, 0.01));
  EXPECT_EQ(hands.output(at(1)), Action(3, 0.02));
  EXPECT_EQ(hands.activity(), 7.0);
  EXPECT_FALSE(hands.isManual());
  EXPECT_TRUE(hands.manualIntervals().empty());
}

TEST(ManualController, TakingOverChangesNothingUntilSomethingIsSet) {
  ManualController hands(std::make_unique<Counting>(), 3);
  hands.output(at(0));
  hands.takeOver();
  EXPECT_EQ(hands.output(at(1)), Action(3, 0.01));
  hands.set(1, 0.8);
  EXPECT_EQ(hands.output(at(2)), (Action{0.01, 0.8, 0.01}));
  hands.handBack();
  EXPECT_EQ(hands.output(at(3)), Action(3, 0.02)) << "the other one goes on where it was";
  ASSERT_EQ(hands.manualIntervals().size(), 1u);
  EXPECT_EQ(hands.manualIntervals()[0].from_s, 1);
  EXPECT_EQ(hands.manualIntervals()[0].to_s, 3);
}

TEST(ManualController, SettingAndVentingTakeOver) {
  ManualController hands(std::make_unique<Counting>(), 3);
  hands.set(0, 2.5);
  EXPECT_TRUE(hands.isManual());
  EXPECT_EQ(hands.output(at(0)), (Action{1, 0, 0}));
  hands.set(2, -3);
  hands.set(1, 0.5);
  EXPECT_EQ(hands.pressures(), (Action{1, 0.5, 0}));
  hands.handBack();
  hands.reset();
  EXPECT_TRUE(hands.isManual());
  EXPECT_EQ(hands.output(at(1)), Action(3, 0.0));
}

TEST(ManualController, RefusesWhatCannotBe) {
  EXPECT_THROW(ManualController(nullptr, 3), BadParameter);
  EXPECT_THROW(ManualController(std::make_unique<Counting>(), 0), BadParameter);
  ManualController hands(std::make_unique<Counting>(), 3);
  EXPECT_THROW(hands.set(3, 0.1), BadParameter);
  EXPECT_THROW(hands.set(-1, 0.1), BadParameter);
}

}  // namespace
}  // namespace musclesim
