#include "musclesim/controller/hold.h"

#include <gtest/gtest.h>

#include "controller/request.h"
#include "musclesim/base/error.h"
#include "musclesim/controller/random_pressures.h"
#include "support/support.h"

namespace musclesim {
namespace {

using test::Prepared;

TEST(HoldController, HoldsHalfPressureUnlessTold) {
  Prepared prepared;
  HoldController hold(prepared.request);
  EXPECT_EQ(hold.output(State()), Action({0.5, 0.5}));
  EXPECT_FALSE(hold.activity());
  EXPECT_FALSE(hold.targetMm());
}

TEST(HoldController, TakesOnePressurePerMuscleWithTheCommonOneAsDefault) {
  Prepared prepared{"hold.pressure=0.2", "hold.pressure_1=0.9"};
  prepared.request.muscle_count = 3;
  HoldController hold(prepared.request);
  EXPECT_EQ(hold.output(State()), Action({0.2, 0.9, 0.2}));
  prepared.parameters.requireAllKnown();
}

TEST(HoldController, RejectsPressuresOutOfRange) {
  Prepared prepared{"hold.pressure_1=1.1"};
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { HoldController hold(prepared.request); }), "hold.pressure_1 = 1.1"));
}

TEST(RandomPressuresController, DrawsAtDecisionsAndHoldsBetween) {
  Prepared prepared;  // four steps per decision
  RandomPressuresController random(prepared.request);
  Action last;
  double sum = 0;
  for (int step = 0; step < 8000; ++step) {
    const Action action = random.output(State());
    ASSERT_TRUE(test::allInUnitRange(action));
    ASSERT_EQ(action != last, step % 4 == 0);
    last = action;
    sum += action[0] + action[1];
  }
  EXPECT_NEAR(sum / 16000, 0.5, 0.02);
}

TEST(RandomPressuresController, RepeatsWithTheSeedOnly) {
  Prepared first, second, third;
  third.request.seed = 2;
  RandomPressuresController a(first.request), b(second.request), c(third.request);
  const Action action = a.output(State());
  EXPECT_EQ(action, b.output(State()));
  EXPECT_NE(action, c.output(State()));
}

}  // namespace
}  // namespace musclesim
