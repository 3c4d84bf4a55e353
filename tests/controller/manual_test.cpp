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
  ManualController controller(std::make_unique<Counting>(), 3);
  EXPECT_EQ(controller.output(at(0)), Action(3, 0.01));
  EXPECT_EQ(controller.output(at(1)), Action(3, 0.02));
  EXPECT_EQ(controller.activity(), 7.0);
  EXPECT_FALSE(controller.hands()->isManual());
  EXPECT_TRUE(controller.manualIntervals().empty());
}

TEST(ManualController, TakingOverChangesNothingUntilSomethingIsSet) {
  ManualController controller(std::make_unique<Counting>(), 3);
  controller.output(at(0));
  controller.hands()->takeOver();
  EXPECT_EQ(controller.output(at(1)), Action(3, 0.01));
  controller.hands()->set(1, 0.8);
  EXPECT_EQ(controller.output(at(2)), (Action{0.01, 0.8, 0.01}));
  controller.hands()->handBack();
  EXPECT_EQ(controller.output(at(3)), Action(3, 0.02)) << "the other one goes on where it was";
  ASSERT_EQ(controller.manualIntervals().size(), 1u);
  EXPECT_EQ(controller.manualIntervals()[0].from_s, 1);
  EXPECT_EQ(controller.manualIntervals()[0].to_s, 3);
}

TEST(ManualController, SettingAndVentingTakeOver) {
  ManualController controller(std::make_unique<Counting>(), 3);
  controller.hands()->set(0, 2.5);
  EXPECT_TRUE(controller.hands()->isManual());
  EXPECT_EQ(controller.output(at(0)), (Action{1, 0, 0}));
  controller.hands()->set(2, -3);
  controller.hands()->set(1, 0.5);
  EXPECT_EQ(controller.hands()->pressures(), (Action{1, 0.5, 0}));
  controller.hands()->handBack();
  controller.hands()->reset();
  EXPECT_TRUE(controller.hands()->isManual());
  EXPECT_EQ(controller.output(at(1)), Action(3, 0.0));
}

TEST(ManualController, RefusesWhatCannotBe) {
  EXPECT_THROW(ManualController(nullptr, 3), BadParameter);
  EXPECT_THROW(ManualController(std::make_unique<Counting>(), 0), BadParameter);
  ManualController controller(std::make_unique<Counting>(), 3);
  EXPECT_THROW(controller.hands()->set(3, 0.1), BadParameter);
  EXPECT_THROW(controller.hands()->set(-1, 0.1), BadParameter);
}

}  // namespace
}  // namespace musclesim
