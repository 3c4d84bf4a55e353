/// The skeleton's poses and forces against ODE's joints.
#include "skeleton.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <vector>

#include "musclesim/base/units.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// Two bars, not along the axes of the world, with a joint between them and a hinge to the environment.
struct JointedBars {
  explicit JointedBars(const std::function<Joint*(Primitive& a, Primitive& b)>& join) {
    World& world = simulation.world();
    first = new Box(world, nullptr, {20, 30, -10}, 100, 0, 40, 20, 10);
    second = new Box(world, nullptr, {70, 60, 15}, 150, 0, 30, 20, 50);
    first->rotate(25, {1, 2, 3});
    second->rotate(-40, {3, -1, 1});
    first->attachHinge(nullptr, {0, 0, 0}, {1, 1, 0});
    joint = join(*first, *second);
  }
  Simulation simulation;
  Primitive *first, *second;
  Joint* joint;
};

TEST(Skeleton, CoordinatesAreTheAnglesAndPositionsOfTheJoints) {
  const Vector anchor(40, 50, 5), axis(0.6, 0, 0.8), across(0, 1, 0);
  const std::vector<std::function<Joint*(Primitive&, Primitive&)>> joints = {
      [&](Primitive& a, Primitive& b) { return b.attachHinge(&a, anchor, axis); },
      [&](Primitive& a, Primitive& b) { return a.attachHinge(&b, anchor, axis); },
      [&](Primitive& a, Primitive& b) { return b.attachUniversal(&a, anchor, axis, across); },
      [&](Primitive& a, Primitive& b) { return a.attachUniversal(&b, anchor, axis, across); },
      [&](Primitive& a, Primitive& b) { return b.attachHinge(&a, anchor, axis, across); },
      [&](Primitive& a, Primitive& b) { return a.attachHinge(&b, anchor, axis, Vector(0.2, 1, 0)); },
      [&](Primitive& a, Primitive& b) { return b.attachSlider(&a, axis); },
      [&](Primitive& a, Primitive& b) { return a.attachSlider(&b, axis); },
      [&](Primitive& a, Primitive& b) { return b.attachBall(&a, anchor); }};
  for (std::size_t number = 0; number < joints.size(); ++number) {
    JointedBars pair(joints[number]);
    Skeleton skeleton(pair.simulation.world());
    const auto count = static_cast<Eigen::Index>(skeleton.coordinates().size());
    Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(count, -0.7, 0.9);
    skeleton.setPose(q);
    skeleton.placeBodies();
    EXPECT_LT(pair.joint->constraintErrorMm(), 1e-10) << number;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Coordinate& coordinate = skeleton.coordinates()[static_cast<std::size_t>(i)];
      const Joint& joint = *coordinate.joint;
      if (joint.kind() == Joint::Kind::ball) continue;
      const bool slides = joint.kind() == Joint::Kind::slider;
      const double value = slides ? dJointGetSliderPosition(joint.id()) : joint.angleDeg(coordinate.axis) * rad_per_deg;
      EXPECT_NEAR(value, q[i], 1e-10) << number << ", axis " << coordinate.axis;
    }
    const Vector moved = pair.second->getPosition();
    skeleton.setPose(Eigen::VectorXd::Zero(count));
    skeleton.placeBodies();
    EXPECT_LT((pair.second->getPosition() - Vector(70, 60, 15)).norm(), 1e-12) << "the pose as built";
    EXPECT_GT((pair.second->getPosition() - moved).norm(), 1) << number;
  }
}

TEST(Skeleton, GeneralisedForcesAreTheWorkPerDisplacement) {
  JointedBars pair([](Primitive& a, Primitive& b) { return b.attachUniversal(&a, {40, 50, 5}, {0.6, 0, 0.8}, {0, 1, 0}); });
  auto* third = new Sphere(pair.simulation.world(), nullptr, {90, 10, 40}, 200, 0, 10);
  third->attachBall(pair.second, {80, 50, 20});
  Skeleton skeleton(pair.simulation.world());
  const int number = skeleton.numberOf(third->body().id);
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(6, -0.7, 0.9);
  const Vector force(1, -2, 3), place(5, 6, -7);
  skeleton.setPose(q);
  skeleton.loadWithWeights(Vector::Zero());
  skeleton.addForce(number, force, skeleton.pointMm(number, place));
  Eigen::VectorXd forces(6);
  skeleton.takeForces(forces);
  for (Eigen::Index i = 0; i < 6; ++i) {
    constexpr double d = 1e-5;
    skeleton.setPose(skeleton.displaced(q, d * Eigen::VectorXd::Unit(6, i)));
    const Vector ahead = skeleton.pointMm(number, place);
    skeleton.setPose(skeleton.displaced(q, -d * Eigen::VectorXd::Unit(6, i)));
    EXPECT_NEAR(forces[i], force.dot(ahead - skeleton.pointMm(number, place)) / (2 * d), 1e-6) << i;
  }
}

}  // namespace
}  // namespace musclesim
