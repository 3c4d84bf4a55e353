#include "musclesim/controller/task.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "controller/request.h"
#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

using test::Prepared;
using test::stateAtHeight;
using test::stateWithHand;

TEST(HeightTask, IsInverselyProportionalToTheHeightError) {
  // gain 2, e0 = 10 mm: 2 * 10 / (|y - 50| + 10)
  Prepared prepared{"height_task.gain=2", "height_task.error_scale_mm=10", "height_task.target_mm=50"};
  HeightTask task(prepared.request);
  EXPECT_DOUBLE_EQ(task.activity(stateAtHeight(50)), 2);
  EXPECT_DOUBLE_EQ(task.activity(stateAtHeight(60)), 1);
  EXPECT_DOUBLE_EQ(task.activity(stateAtHeight(40)), 1);
  EXPECT_DOUBLE_EQ(task.activity(stateAtHeight(-240)), 20.0 / 300);
  EXPECT_TRUE(task.targetIsHeight());
  EXPECT_EQ(task.targetMm(), Vector(0, 50, 0));
}

TEST(HeightTask, IgnoresSidewaysDistance) {
  Prepared prepared;
  HeightTask task(prepared.request);
  EXPECT_EQ(task.activity(stateWithHand({1000, 30, -500})), task.activity(stateWithHand({0, 30, 0})));
}

TEST(ReachTask, MatchesEquations7To9WorkedOutByHand) {
  // gamma = 0.5, d_scale = 100 mm, distances 100, 60, 80, 40 mm:
  //   mean       100 (itself)   100    55 / 0.75 = 73.3333   67.5 / 0.875 = 77.142857
  //   (mean-d)/d_scale   0      0.4    -0.0666667            0.37142857
  Prepared prepared{"reach_task.discount=0.5", "reach_task.distance_scale_mm=100"};
  prepared.request.task = "reach";
  ReachTask task(prepared.request);
  const auto atDistance = [](double d) { return stateWithHand(Vector(-300, 0, 150) + d * Vector(0.6, 0, 0.8)); };
  EXPECT_NEAR(task.activity(atDistance(100)), 0, 1e-14);
  EXPECT_NEAR(task.activity(atDistance(60)), 0.4, 1e-12);
  EXPECT_NEAR(task.activity(atDistance(80)), -0.2 / 3, 1e-12);
  EXPECT_NEAR(task.activity(atDistance(40)), 0.37142857142857144, 1e-12);
}

TEST(Target, ComesFromParametersOrFromTheRequest) {
  Prepared reach;
  reach.request.task = "reach";
  EXPECT_EQ(Target::make(reach.request).point_mm, Vector(-300, 0, 150));
  Prepared set{"reach_task.target_y_mm=20"};
  set.request.task = "reach";
  EXPECT_EQ(Target::make(set.request).point_mm, Vector(-300, 20, 150));
  // A target in the request replaces the parameters, and --print-config shows it.
  set.request.target_mm = Vector(1, 2, 3);
  Parameters fresh;
  const Target target = Target::make({fresh, 2, 0.01, 6, 1, "reach", Vector(1, 2, 3)});
  EXPECT_EQ(target.point_mm, Vector(1, 2, 3));
  EXPECT_FALSE(target.is_height);
  EXPECT_EQ(std::get<double>(fresh.declared().at(2).value), 3);
  EXPECT_EQ(Target::make({fresh, 2, 0.01, 6, 1, "height", Vector(1, 2, 3)}).point_mm, Vector(0, 2, 0));
}

TEST(Target, MustLieWithinRange) {
  Parameters parameters;
  const auto text = messageOf<BadParameter>([&] { Target::make({parameters, 2, 0.01, 6, 1, "reach", Vector(0, 0, std::nan(""))}); });
  EXPECT_TRUE(contains(text, "reach_task.target_z_mm"));
}

TEST(Task, UnknownNameSuggestsTheNearest) {
  Prepared prepared;
  prepared.request.task = "heigth";
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { Task::make(prepared.request); }), "did you mean \"height\"?"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { Target::make(prepared.request); }), "did you mean \"height\"?"));
}

TEST(ReportedHand, MustExistAndBeFinite) {
  EXPECT_TRUE(contains(messageOf<BadParameter>([] { reportedHand(State()); }), "needs a robot that reports the position of its hand"));
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, std::numeric_limits<double>::lowest()}) {
    State state = stateWithHand({0, bad, 0}, 12.5);
    EXPECT_TRUE(contains(messageOf<Diverged>([&] { reportedHand(state); }), "hand"));
  }
}

}  // namespace
}  // namespace musclesim
