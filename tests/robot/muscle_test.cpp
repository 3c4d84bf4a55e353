#include "musclesim/robot/muscle.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "../../robot/actuator_step.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/simulation/simulation.h"
#include "support/not_finite.h"
#include "support/support.h"

namespace musclesim {
namespace {

Vector positionOfBead(const Link& link, int end) {
  const dReal* p = dBodyGetPosition(link.bead[end]);
  return {p[0], p[1], p[2]};
}

Vector directionOf(const Link& link) {
  return (positionOfBead(link, 1) - positionOfBead(link, 0)).normalized();
}

Vector axisOf(const Joint* hinge) {
  dVector3 axis;
  dJointGetHingeAxis(hinge->id(), axis);
  return {axis[0], axis[1], axis[2]};
}

/// A straight muscle from the origin along a direction.
Muscle* straight(Simulation& simulation, const Vector& direction, double length_mm, double minimum_mm, double maximum_mm) {
  const Vector end = length_mm * direction.normalized();
  return new Muscle(simulation.world(), simulation.space(), Vector::Zero(), end / 3, 2 * end / 3, end, minimum_mm, maximum_mm);
}

TEST(Bezier, DeCasteljauAgreesWithTheClosedForm) {
  const Vector a(1, 2, 3), b(-40, 10, 7), c(60, -30, 12), d(5, 80, -9);
  for (int i = 0; i <= 20; ++i) {
    const double t = i / 20.0, u = 1 - t;
    const Vector expected = u * u * u * a + 3 * u * u * t * b + 3 * u * t * t * c + t * t * t * d;
    EXPECT_LT((bezierPoint(a, b, c, d, t) - expected).norm(), 1e-13);
  }
  EXPECT_EQ(bezierPoint(a, b, c, d, 0), a);
  EXPECT_EQ(bezierPoint(a, b, c, d, 1), d);
}

TEST(Muscle, LinksRunBetweenThePointsOfTheCurve) {
  Simulation simulation;
  const Vector a(0, 0, 0), b(60, 40, 0), c(120, -40, 30), d(200, 0, 30);
  const auto* muscle = new Muscle(simulation.world(), simulation.space(), a, b, c, d, 105, 300);
  ASSERT_EQ(muscle->links().size(), 7u);
  double length_mm = 0;
  for (std::size_t i = 0; i < 7; ++i) {
    const double t = static_cast<double>(i) / 7, s = static_cast<double>(i + 1) / 7;
    const Vector from = bezierPoint(a, b, c, d, t), to = bezierPoint(a, b, c, d, s), along = (to - from).normalized();
    EXPECT_LT((positionOfBead(muscle->links()[i], 0) - (from + 7.5 * along)).norm(), 1e-12);
    EXPECT_LT((positionOfBead(muscle->links()[i], 1) - (to - 7.5 * along)).norm(), 1e-12);
    length_mm += (to - from).norm();
  }
  EXPECT_NEAR(muscle->lengthMm(), length_mm, 1e-11);
  EXPECT_EQ(muscle->hinges().size(), 6u);
  EXPECT_EQ(muscle->massG(), 140);
}

TEST(Muscle, NumberOfLinksIsTheRoundedMinimumOverABeadPair) {
  struct Case {
    double minimum_mm;
    std::size_t count;
  };
  for (const auto& [minimum_mm, count] : {Case{1, 2}, {20, 2}, {37, 2}, {38, 3}, {112, 7}, {113, 8}, {120, 8}, {127, 8}, {128, 9}}) {
    Simulation simulation;
    const auto* muscle = straight(simulation, {0, -1, 0}, 200, minimum_mm, 300);
    EXPECT_EQ(muscle->links().size(), count) << minimum_mm;
    EXPECT_EQ(muscle->minimumLengthMm(), static_cast<double>(count) * 15) << "the shortest length becomes that of its beads";
    EXPECT_EQ(muscle->maximumLengthMm(), 300);
    EXPECT_NEAR(muscle->lengthRatio(), (200.0 - 15.0 * count) / (300 - 15.0 * count), 1e-12);
  }
}

TEST(Muscle, ForceLawUsesTheShortenedMinimum) {
  Simulation simulation;
  const auto* muscle = straight(simulation, {0, -1, 0}, 200, 127, 300);
  EXPECT_EQ(muscle->calculateForce(0.3, 180), BraunForceLaw(120, 300).tensionN(0.3, 180));
}

TEST(Muscle, SlidersStopAtAnEqualShareOfTheMaximumAndAtTheirBeads) {
  Simulation simulation;
  const Vector a(0, 0, 0), b(60, 40, 0), c(120, -40, 30), d(200, 0, 30);
  const auto* muscle = new Muscle(simulation.world(), simulation.space(), a, b, c, d, 105, 280);
  for (const Link& link : muscle->links()) {
    const double length_mm = (positionOfBead(link, 0) - positionOfBead(link, 1)).norm() + 15;
    EXPECT_NEAR(dJointGetSliderParam(link.slider->id(), dParamLoStop), length_mm - 40, 1e-12);
    EXPECT_NEAR(dJointGetSliderParam(link.slider->id(), dParamHiStop), length_mm - 15, 1e-12);
    EXPECT_EQ(dJointGetSliderPosition(link.slider->id()), 0);
    EXPECT_EQ(dJointGetSliderParam(link.slider->id(), dParamFMax), 1e6) << "1 N in g mm/s^2";
    EXPECT_EQ(dJointGetSliderParam(link.slider->id(), dParamVel), 0);
  }
  for (const Joint* hinge : muscle->hinges()) EXPECT_DOUBLE_EQ(dJointGetHingeParam(hinge->id(), dParamFMax), 8e6) << "0.008 N m";
}

TEST(Muscle, FrictionIsAThousandthInTheOriginalsUnits) {
  SimulationOptions options;
  options.physics = PhysicsKind::original;
  Simulation simulation(options);
  const auto* muscle = straight(simulation, {0, -1, 0}, 200, 120, 300);
  EXPECT_EQ(dJointGetSliderParam(muscle->links()[0].slider->id(), dParamFMax), 1000);
  EXPECT_DOUBLE_EQ(dJointGetHingeParam(muscle->hinges()[0]->id(), dParamFMax), 8000);
}

TEST(Muscle, HingesTurnAboutUpCrossTheLinkBefore) {
  Simulation simulation;
  const Vector a(0, 0, 0), b(60, 40, 0), c(120, -40, 30), d(200, 0, 30);
  const auto* muscle = new Muscle(simulation.world(), simulation.space(), a, b, c, d, 105, 300);
  for (std::size_t i = 0; i < muscle->hinges().size(); ++i) {
    const Vector expected = Vector::UnitY().cross(directionOf(muscle->links()[i])).normalized();
    EXPECT_LT((axisOf(muscle->hinges()[i]) - expected).norm(), 1e-12) << i;
  }
}

TEST(Muscle, HingesOfAVerticalMuscleTurnAboutX) {
  for (const double sign : {1.0, -1.0}) {
    Simulation simulation;
    const auto* muscle = straight(simulation, {0, sign, 0}, 200, 120, 300);
    for (const Joint* hinge : muscle->hinges()) EXPECT_EQ(axisOf(hinge), Vector::UnitX());
  }
}

TEST(Muscle, HingeStopsCloseInProportionToTheLength) {
  Simulation simulation;
  auto* muscle = straight(simulation, {0, -1, 0}, 210, 120, 300);
  applyForces(*muscle);
  for (const Joint* hinge : muscle->hinges()) {
    EXPECT_NEAR(dJointGetHingeParam(hinge->id(), dParamHiStop) * deg_per_rad, 30, 1e-9);
    EXPECT_NEAR(dJointGetHingeParam(hinge->id(), dParamLoStop) * deg_per_rad, -30, 1e-9);
  }
}

TEST(Muscle, HingesHaveTheirAnchorBetweenTheLinks) {
  Simulation simulation;
  const auto* muscle = straight(simulation, {1, -1, 0.5}, 160, 60, 300);
  for (std::size_t i = 0; i < muscle->hinges().size(); ++i) {
    dVector3 anchor;
    dJointGetHingeAnchor(muscle->hinges()[i]->id(), anchor);
    const Vector expected = Vector(1, -1, 0.5).normalized() * 40.0 * static_cast<double>(i + 1);
    EXPECT_LT((Vector(anchor[0], anchor[1], anchor[2]) - expected).norm(), 1e-12);
  }
}

TEST(Muscle, StartLengthOutsideItsRangeNamesAllNumbers) {
  Simulation simulation;
  const auto shorter = messageOf<BadParameter>([&] { straight(simulation, {0, -1, 0}, 150, 200, 300); });
  EXPECT_TRUE(contains(shorter, "start length of muscle_0"));
  EXPECT_TRUE(contains(shorter, "150 mm"));
  EXPECT_TRUE(contains(shorter, "200 .. 300 mm"));
  const auto longer = messageOf<BadParameter>([&] { straight(simulation, {0, -1, 0}, 301, 120, 300); });
  EXPECT_TRUE(contains(longer, "301 mm"));
  EXPECT_TRUE(contains(longer, "120 .. 300 mm"));
  EXPECT_TRUE(simulation.world().actuators().empty()) << "a muscle that failed leaves nothing behind";
  EXPECT_EQ(simulation.world().joints().size(), 0u);
}

TEST(Muscle, TheGivenMinimumCountsForTheStartNotTheShortenedOne) {
  Simulation simulation;
  EXPECT_THROW(straight(simulation, {0, -1, 0}, 125, 127, 300), BadParameter) << "eight links would be 120 mm";
  EXPECT_NO_THROW(straight(simulation, {0, -1, 0}, 127, 127, 300));
}

TEST(Muscle, RefusesLinksShorterThanTheirBeads) {
  Simulation simulation;
  // The curve's points are dense near its start: the chain is long enough, but the first link is not.
  const auto message = messageOf<BadParameter>([&] {
    new Muscle(simulation.world(), simulation.space(), {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, -200, 0}, 120, 300);
  });
  EXPECT_TRUE(contains(message, "shortest link of muscle_0"));
  EXPECT_TRUE(contains(message, "15 mm"));
}

TEST(Muscle, RefusesNumbersThatAreNotFiniteAndLengthsThatCannotBe) {
  Simulation simulation;
  for (const double wrong : {nan, inf, -inf}) {
    for (int point = 0; point < 4; ++point)
      for (int axis = 0; axis < 3; ++axis) {
        Vector points[4] = {{0, 0, 0}, {0, -70, 0}, {0, -140, 0}, {0, -210, 0}};
        points[point][axis] = wrong;
        EXPECT_THROW(new Muscle(simulation.world(), simulation.space(), points[0], points[1], points[2], points[3], 120, 300), BadParameter)
            << "point " << point << " axis " << axis << " " << wrong;
      }
    EXPECT_THROW(straight(simulation, {0, -1, 0}, 200, wrong, 300), BadParameter) << wrong;
    EXPECT_THROW(straight(simulation, {0, -1, 0}, 200, 120, wrong), BadParameter) << wrong;
  }
  EXPECT_THROW(straight(simulation, {0, -1, 0}, 200, -120, 300), BadParameter);
  EXPECT_THROW(straight(simulation, {0, -1, 0}, 200, 300, 120), BadParameter);
  EXPECT_THROW(straight(simulation, {0, -1, 0}, 210, 210, 210), BadParameter);
  EXPECT_TRUE(simulation.world().actuators().empty());
}

TEST(Muscle, RefusesAWorldThatIsNoSimulations) {
  EXPECT_THROW(new Muscle(nullptr, nullptr, {0, 0, 0}, {0, -70, 0}, {0, -140, 0}, {0, -210, 0}, 120, 300), BadParameter);
}

TEST(Muscle, PlaceStraightMakesAllLinksEquallyLong) {
  Simulation simulation;
  auto* muscle = straight(simulation, {0, -1, 0}, 200, 120, 300);
  const Vector from(10, 20, 30), to(150, -40, 110);
  muscle->placeStraight(from, to);
  EXPECT_NEAR(muscle->lengthMm(), (to - from).norm(), 1e-11);
  const Vector along = (to - from).normalized();
  for (const Link& link : muscle->links()) {
    EXPECT_LT((directionOf(link) - along).norm(), 1e-12);
    EXPECT_NEAR((positionOfBead(link, 1) - positionOfBead(link, 0)).norm() + 15, (to - from).norm() / 8, 1e-11);
    EXPECT_LT(link.slider->constraintErrorMm(), 1e-9);
  }
  for (const Joint* hinge : muscle->hinges()) EXPECT_LT(hinge->constraintErrorMm(), 1e-9);
  EXPECT_THROW(muscle->placeStraight({0, 0, 0}, {0, -119, 0}), BadParameter);
  EXPECT_THROW(muscle->placeStraight({0, 0, 0}, {0, nan, 0}), BadParameter);
}

}  // namespace
}  // namespace musclesim
