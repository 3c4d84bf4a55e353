#include "musclesim/robot/linear_actuator.h"

#include <gtest/gtest.h>

#include "musclesim/base/error.h"
#include "musclesim/simulation/simulation.h"
#include "support/not_finite.h"
#include "support/support.h"

namespace musclesim {
namespace {

TEST(LinearActuator, IsOneLinkThatKeepsItsMinimumLength) {
  Simulation simulation;
  const auto* actuator = new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, 0, 100}, 87, 140);
  EXPECT_EQ(actuator->links().size(), 1u);
  EXPECT_TRUE(actuator->hinges().empty());
  EXPECT_EQ(actuator->minimumLengthMm(), 87);
  EXPECT_EQ(actuator->maximumLengthMm(), 140);
  EXPECT_EQ(actuator->lengthMm(), 100);
  EXPECT_EQ(actuator->massG(), 20);
  EXPECT_EQ(actuator->calculateForce(0.4, 120), BraunForceLaw(87, 140).tensionN(0.4, 120));
}

TEST(LinearActuator, SliderStopsBelowTheMinimumWhereTheBeadsTouch) {
  Simulation simulation;
  const auto* actuator = new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, 0, 100}, 87, 140);
  const dJointID slider = actuator->links()[0].slider->id();
  EXPECT_DOUBLE_EQ(dJointGetSliderParam(slider, dParamLoStop), 100 - 140);
  EXPECT_DOUBLE_EQ(dJointGetSliderParam(slider, dParamHiStop), 100 - 15);
  EXPECT_EQ(actuator->straightLengthRange().shortest_mm, 15);
  EXPECT_EQ(actuator->straightLengthRange().longest_mm, 140);
}

TEST(LinearActuator, PullsALoadUpToItsForceLaw) {
  Simulation simulation;
  auto* load = new Sphere(simulation.world(), nullptr, {0, -75, 0}, 1000, 0, 10);
  auto* actuator = new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, -75, 0}, 60, 140);
  actuator->connectStartTo(nullptr);
  actuator->connectEndTo(load);
  actuator->setPressure(1);
  for (int i = 0; i < 200; ++i) simulation.step();
  // 1000 g and the lower bead hang from the slider, whose friction of 1 N acts against a stiffness of 1.2 N/mm.
  const BraunForceLaw law(60, 140);
  const double l = actuator->lengthMm();
  EXPECT_NEAR(law.tensionN(1, l), 1.010 * 9.81, 1.001) << l << " mm";
}

TEST(LinearActuator, RefusesStartLengthsOutsideItsRange) {
  Simulation simulation;
  for (const auto& [low, high] : {std::pair{101.0, 140.0}, {50.0, 99.0}}) {
    const auto message = messageOf<BadParameter>([&, low = low, high = high] {
      new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, 0, 100}, low, high);
    });
    EXPECT_TRUE(contains(message, "100 mm"));
    EXPECT_TRUE(contains(message, "minimum and maximum length"));
  }
  EXPECT_THROW(new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, 0, 14}, 10, 40), BadParameter)
      << "shorter than its two beads";
}

TEST(LinearActuator, RefusesNumbersThatAreNotFiniteOrNegative) {
  Simulation simulation;
  for (const double wrong : {nan, inf, -inf}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vector point(0, 0, 0);
      point[axis] = wrong;
      EXPECT_THROW(new LinearActuator(simulation.world(), simulation.space(), point, {0, 0, 100}, 50, 140), BadParameter);
      EXPECT_THROW(new LinearActuator(simulation.world(), simulation.space(), {0, 0, 100}, point, 50, 140), BadParameter);
    }
    EXPECT_THROW(new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, 0, 100}, wrong, 140), BadParameter);
    EXPECT_THROW(new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, 0, 100}, 50, wrong), BadParameter);
  }
  EXPECT_THROW(new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, 0, 100}, -1, 140), BadParameter);
  EXPECT_TRUE(simulation.world().actuators().empty());
}

}  // namespace
}  // namespace musclesim
