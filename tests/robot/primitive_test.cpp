#include "musclesim/robot/primitive.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/simulation/simulation.h"
#include "support/not_finite.h"
#include "support/support.h"

namespace musclesim {
namespace {

constexpr double pi = std::numbers::pi;

Eigen::Matrix3d matrixOf(const dReal* m) {
  Eigen::Matrix3d result;
  result << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  return result;
}

Eigen::Matrix3d inertiaOf(const Primitive* primitive) {
  dMass mass;
  dBodyGetMass(primitive->body().id, &mass);
  return matrixOf(mass.I);
}

double bodyMassOf(const Primitive* primitive) {
  dMass mass;
  dBodyGetMass(primitive->body().id, &mass);
  return mass.mass;
}

Vector geomPosition(const Primitive* primitive) {
  const dReal* p = dGeomGetPosition(primitive->geom());
  return {p[0], p[1], p[2]};
}

Eigen::Matrix3d geomRotation(const Primitive* primitive) {
  return matrixOf(dGeomGetRotation(primitive->geom()));
}

Eigen::Matrix3d turn(double angle_deg, const Vector& axis) {
  return Eigen::AngleAxisd(angle_deg * rad_per_deg, axis.normalized()).toRotationMatrix();
}

class PrimitiveTest : public ::testing::Test {
 protected:
  Box* box(const Vector& position, double mass_g, double x = 10, double y = 20, double z = 30) {
    return new Box(simulation.world(), simulation.space(), position, mass_g, 0, x, y, z);
  }
  Sphere* sphere(const Vector& position, double mass_g, double radius_mm = 5) {
    return new Sphere(simulation.world(), simulation.space(), position, mass_g, 0, radius_mm);
  }
  Simulation simulation;
};

using Composite = PrimitiveTest;

TEST_F(PrimitiveTest, BoxHasTheInertiaOfABox) {
  const auto* b = box({1, 2, 3}, 12, 10, 20, 30);
  EXPECT_EQ(b->massG(), 12);
  EXPECT_EQ(b->getPosition(), Vector(1, 2, 3));
  EXPECT_TRUE(inertiaOf(b).isApprox(Eigen::Matrix3d(Vector(1300, 1000, 500).asDiagonal()), 1e-12));
  EXPECT_EQ(b->shape().kind, Shape::Kind::box);
  EXPECT_EQ(b->shape().size_mm, Vector(10, 20, 30));
}

TEST_F(PrimitiveTest, SphereHasTheInertiaOfASphere) {
  const auto* s = sphere({0, 0, 0}, 10, 7.5);
  EXPECT_TRUE(inertiaOf(s).isApprox(225 * Eigen::Matrix3d::Identity(), 1e-12));
}

TEST_F(PrimitiveTest, CappedCylinderHasTheInertiaOfACylinderAndTwoHalfSpheres) {
  const auto* c = new CappedCylinder(simulation.world(), simulation.space(), {0, 0, 0}, 200, 0, 13, 300);
  // Computed by hand from the volumes pi r^2 L and 4/3 pi r^3.
  EXPECT_NEAR(inertiaOf(c)(0, 0), 1688568.91, 1.0);
  EXPECT_NEAR(inertiaOf(c)(2, 2), 16715.38, 0.01);
}

TEST_F(PrimitiveTest, WithoutMassTheDensityCounts) {
  const auto* b = new Box(simulation.world(), simulation.space(), {0, 0, 0}, 0, 1e-3, 10, 20, 30);
  EXPECT_NEAR(b->massG(), 6, 1e-12);
  const auto* s = new Sphere(simulation.world(), simulation.space(), {0, 0, 0}, 0, 1e-3, 10);
  EXPECT_NEAR(s->massG(), 4.0 / 3 * pi, 1e-12);
  const auto* c = new CappedCylinder(simulation.world(), simulation.space(), {0, 0, 0}, 0, 1e-3, 10, 30);
  EXPECT_NEAR(c->massG(), 3 * pi + 4.0 / 3 * pi, 1e-12);
  const auto* both = new Box(simulation.world(), simulation.space(), {0, 0, 0}, 50, 1e-3, 10, 20, 30);
  EXPECT_EQ(both->massG(), 50) << "where both are given the mass counts";
}

TEST_F(PrimitiveTest, RotateTurnsRightHandedAboutTheWorldsAxisAndTheCentreOfMass) {
  auto* b = box({1, 2, 3}, 12);
  b->rotate(90, {0, 0, 5});
  EXPECT_TRUE(b->getRotation().isApprox(turn(90, {0, 0, 1}), 1e-12)) << "x turned to y";
  b->rotate(30, {1, 0, 0});
  EXPECT_TRUE(b->getRotation().isApprox(turn(30, {1, 0, 0}) * turn(90, {0, 0, 1}), 1e-12));
  EXPECT_EQ(b->getPosition(), Vector(1, 2, 3));
}

TEST_F(PrimitiveTest, FixedBodiesStay) {
  auto* b = box({1, 2, 3}, 12);
  b->fix();
  for (int i = 0; i < 20; ++i) simulation.step();
  EXPECT_LT((b->getPosition() - Vector(1, 2, 3)).norm(), 1e-6);
  EXPECT_TRUE(b->getRotation().isApprox(Eigen::Matrix3d::Identity(), 1e-6));
}

TEST_F(PrimitiveTest, ColoursAreSharesOfOne) {
  auto* b = box({0, 0, 0}, 12);
  b->setColor(0.25, 0.5, 1);
  EXPECT_EQ(b->color().red, 0.25);
  EXPECT_EQ(b->color().green, 0.5);
  EXPECT_EQ(b->color().blue, 1);
  for (const double wrong : {-0.1, 1.1, nan, inf}) {
    EXPECT_THROW(b->setColor(wrong, 0, 0), BadParameter);
    EXPECT_THROW(b->setColor(0, wrong, 0), BadParameter);
    EXPECT_THROW(b->setColor(0, 0, wrong), BadParameter);
  }
}

TEST_F(PrimitiveTest, EveryConstructorRefusesNumbersThatCannotBe) {
  const dWorldID world = simulation.world();
  const dSpaceID space = simulation.space();
  using Make = std::function<void(const Vector&, double, double, const Vector&)>;
  const Make makers[] = {
      [&](const Vector& p, double mass, double density, const Vector& s) { new Box(world, space, p, mass, density, s.x(), s.y(), s.z()); },
      [&](const Vector& p, double mass, double density, const Vector& s) { new Sphere(world, space, p, mass, density, s.x()); },
      [&](const Vector& p, double mass, double density, const Vector& s) {
        new CappedCylinder(world, space, p, mass, density, s.x(), s.y());
      }};
  const int size_count[] = {3, 1, 2};
  for (int kind = 0; kind < 3; ++kind) {
    const Make& make = makers[kind];
    for (const double wrong : {nan, inf, -inf, -1.0}) {
      EXPECT_THROW(make({0, 0, 0}, wrong, 0, {1, 1, 1}), BadParameter) << "mass " << wrong;
      EXPECT_THROW(make({0, 0, 0}, 0, wrong, {1, 1, 1}), BadParameter) << "density " << wrong;
      EXPECT_THROW(make({0, 0, 0}, 1, wrong, {1, 1, 1}), BadParameter) << "density beside a mass " << wrong;
      for (int i = 0; i < size_count[kind]; ++i) {
        Vector size(1, 1, 1);
        size[i] = wrong;
        EXPECT_THROW(make({0, 0, 0}, 1, 0, size), BadParameter) << "size " << i << " " << wrong;
        size[i] = 0;
        EXPECT_THROW(make({0, 0, 0}, 1, 0, size), BadParameter) << "size " << i << " zero";
      }
      if (wrong == -1.0) continue;
      for (int i = 0; i < 3; ++i) {
        Vector position(0, 0, 0);
        position[i] = wrong;
        EXPECT_THROW(make(position, 1, 0, {1, 1, 1}), BadParameter) << "position " << i << " " << wrong;
      }
    }
    EXPECT_THROW(make({0, 0, 0}, 0, 0, {1, 1, 1}), BadParameter) << "neither mass nor density";
  }
  EXPECT_TRUE(simulation.world().primitives().empty()) << "a primitive that failed leaves nothing behind";
  EXPECT_TRUE(simulation.world().bodies().empty());
  const auto message = messageOf<BadParameter>([&] { makers[0]({0, 0, 0}, -3, 0, {1, 1, 1}); });
  EXPECT_EQ(message, "mass of a primitive = -3: must be positive and finite");
}

TEST_F(PrimitiveTest, RotateAndSetInertiaRefuseNumbersThatCannotBe) {
  auto* b = box({0, 0, 0}, 12);
  for (const double wrong : {nan, inf}) {
    EXPECT_THROW(b->rotate(wrong, {1, 0, 0}), BadParameter);
    EXPECT_THROW(b->rotate(1, {wrong, 0, 0}), BadParameter);
    EXPECT_THROW(b->setInertia({1, wrong, 1}), BadParameter);
    EXPECT_THROW(b->place({0, wrong, 0}, Eigen::Matrix3d::Identity()), BadParameter);
  }
  EXPECT_THROW(b->rotate(1, {0, 0, 0}), BadParameter);
  EXPECT_THROW(b->setInertia({1, 0, 1}), BadParameter);
  EXPECT_THROW(b->setInertia({1, 1, -1}), BadParameter);
}

TEST_F(PrimitiveTest, AWorldThatIsNoSimulationsIsRefused) {
  EXPECT_THROW(new Sphere(nullptr, nullptr, {0, 0, 0}, 1, 0, 1), BadParameter);
  const dWorldID stray = dWorldCreate();
  EXPECT_THROW(new Sphere(stray, nullptr, {0, 0, 0}, 1, 0, 1), BadParameter);
  dWorldDestroy(stray);
}

TEST_F(Composite, LiesAtTheCommonCentreOfMassAndKeepsItsParentsOrientation) {
  auto* a = box({0, 0, 0}, 10);
  auto* b = sphere({40, 0, 0}, 30);
  a->rotate(25, {0, 1, 1});
  a->compositeWithPrimitive(b);
  EXPECT_EQ(&a->body(), &b->body());
  EXPECT_EQ(simulation.world().bodies().size(), 1u);
  EXPECT_LT((a->getPosition() - Vector(30, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(b->getPosition(), a->getPosition());
  EXPECT_TRUE(a->getRotation().isApprox(turn(25, {0, 1, 1}), 1e-12));
  EXPECT_NEAR(bodyMassOf(a), 40, 1e-12);
  EXPECT_EQ(a->massG(), 10) << "a part keeps its own mass";
}

TEST_F(Composite, PartsKeepTheirPoseInTheWorld) {
  auto* a = box({0, 0, 0}, 10);
  auto* b = box({40, 10, 0}, 30);
  auto* c = sphere({0, 0, -70}, 5);
  a->rotate(25, {0, 1, 1});
  b->rotate(-70, {1, 0, 1});
  Primitive::compositePrimitives({a, b, c}, b);
  EXPECT_LT((geomPosition(a) - Vector(0, 0, 0)).norm(), 1e-11);
  EXPECT_LT((geomPosition(b) - Vector(40, 10, 0)).norm(), 1e-11);
  EXPECT_LT((geomPosition(c) - Vector(0, 0, -70)).norm(), 1e-11);
  EXPECT_TRUE(geomRotation(a).isApprox(turn(25, {0, 1, 1}), 1e-11));
  EXPECT_TRUE(geomRotation(b).isApprox(turn(-70, {1, 0, 1}), 1e-11));
  EXPECT_TRUE(a->getRotation().isApprox(turn(-70, {1, 0, 1}), 1e-11)) << "the parent's orientation";
}

TEST_F(Composite, TheParentIsTheLastPartUnlessNamed) {
  auto* a = box({0, 0, 0}, 10);
  auto* b = box({40, 10, 0}, 30);
  b->rotate(40, {0, 0, 1});
  Primitive::compositePrimitives({a, b});
  EXPECT_TRUE(a->getRotation().isApprox(turn(40, {0, 0, 1}), 1e-12));
}

TEST_F(Composite, RotateTurnsTheWholeAboutItsCentreOfMass) {
  auto* a = sphere({0, 0, 0}, 10);
  auto* b = sphere({40, 0, 0}, 30);
  a->compositeWithPrimitive(b);
  a->rotate(90, {0, 0, 1});
  EXPECT_LT((geomPosition(a) - Vector(30, -30, 0)).norm(), 1e-11);
  EXPECT_LT((geomPosition(b) - Vector(30, 10, 0)).norm(), 1e-11);
  EXPECT_LT((a->getPosition() - Vector(30, 0, 0)).norm(), 1e-11);
}

TEST_F(Composite, ExactInertiaFollowsTheParallelAxisTheorem) {
  auto* a = sphere({0, 0, 0}, 10);
  auto* b = sphere({40, 0, 0}, 30);
  a->compositeWithPrimitive(b);
  // 0.4 m r^2 of both, and the reduced mass 7.5 g at 40 mm.
  const double own = 0.4 * 40 * 25;
  EXPECT_TRUE(inertiaOf(a).isApprox(Eigen::Matrix3d(Vector(own, own + 12000, own + 12000).asDiagonal()), 1e-12));
}

TEST_F(Composite, ExactInertiaHasItsProductsInTheParentsAxes) {
  auto* a = sphere({0, 0, 0}, 10);
  auto* b = sphere({30, 40, 0}, 30);
  a->compositeWithPrimitive(b);
  const double own = 0.4 * 40 * 25;
  EXPECT_NEAR(inertiaOf(a)(0, 0), own + 7.5 * 1600, 1e-9);
  EXPECT_NEAR(inertiaOf(a)(1, 1), own + 7.5 * 900, 1e-9);
  EXPECT_NEAR(inertiaOf(a)(2, 2), own + 7.5 * 2500, 1e-9);
  EXPECT_NEAR(inertiaOf(a)(0, 1), -7.5 * 1200, 1e-9);
  EXPECT_NEAR(inertiaOf(a)(1, 0), -7.5 * 1200, 1e-9);
  EXPECT_NEAR(inertiaOf(a)(0, 2), 0, 1e-9);

  // With the parent's x axis pointing at the other sphere, the products of inertia vanish.
  auto* c = sphere({0, 0, 100}, 10);
  auto* d = sphere({30, 40, 100}, 30);
  c->rotate(std::atan2(40, 30) * deg_per_rad, {0, 0, 1});
  c->compositeWithPrimitive(d);
  EXPECT_TRUE(inertiaOf(c).isApprox(Eigen::Matrix3d(Vector(own, own + 18750, own + 18750).asDiagonal()), 1e-12));
}

TEST_F(Composite, ExactInertiaDoesNotDependOnTheOrderOfComposing) {
  auto build = [&](double z, bool at_once) {
    auto* a = box({0, 0, z}, 10);
    auto* b = box({40, 10, z}, 30);
    auto* c = sphere({-20, 30, z + 15}, 5);
    b->rotate(33, {1, 1, 0});
    if (at_once) {
      Primitive::compositePrimitives({a, b, c}, a);
    } else {
      b->compositeWithPrimitive(c);
      a->compositeWithPrimitive(b);
    }
    return a;
  };
  const auto *once = build(0, true), *stepwise = build(500, false);
  EXPECT_TRUE(inertiaOf(once).isApprox(inertiaOf(stepwise), 1e-12));
  EXPECT_LT((once->getPosition() + Vector(0, 0, 500) - stepwise->getPosition()).norm(), 1e-11);
  EXPECT_EQ(stepwise->body().parts.size(), 3u);
}

TEST_F(Composite, SummedInertiaIsThePlainSumInThePartsOwnAxes) {
  simulation.world().setCompositeInertia(CompositeInertia::summed);
  auto* a = box({0, 0, 0}, 12, 10, 20, 30);
  auto* b = box({40, 10, 0}, 12, 30, 20, 10);
  b->rotate(90, {0, 1, 0});
  a->compositeWithPrimitive(b);
  EXPECT_TRUE(inertiaOf(a).isApprox(Eigen::Matrix3d(Vector(1300 + 500, 2000, 500 + 1300).asDiagonal()), 1e-12));
}

TEST_F(Composite, SetInertiaKeepsTheMassOfTheWhole) {
  auto* a = box({0, 0, 0}, 10);
  auto* b = box({40, 10, 0}, 30);
  a->compositeWithPrimitive(b);
  a->setInertia({1e5, 2e5, 2.5e5});
  EXPECT_EQ(bodyMassOf(a), 40);
  EXPECT_EQ(inertiaOf(a)(1, 1), 2e5);
}

TEST_F(Composite, FallsAsOneBody) {
  auto* a = box({0, 0, 0}, 10);
  auto* b = sphere({40, 0, 0}, 30);
  a->compositeWithPrimitive(b);
  for (int i = 0; i < 10; ++i) simulation.step();
  EXPECT_NEAR((geomPosition(b) - geomPosition(a)).norm(), 40, 1e-9);
  EXPECT_LT(geomPosition(a).y(), -40);
  EXPECT_EQ(simulation.contactCount(), 0) << "parts of one body do not touch each other";
}

TEST_F(Composite, IsRefusedOnceThereIsAJoint) {
  auto *a = box({0, 0, 0}, 10), *b = box({40, 0, 0}, 10), *c = box({80, 0, 0}, 10);
  a->attachBall(b, {20, 0, 0});
  for (auto* jointed : {a, b}) {
    const auto message = messageOf<BadParameter>([&] { c->compositeWithPrimitive(jointed); });
    EXPECT_TRUE(contains(message, "already has a joint; compose first"));
    EXPECT_THROW(jointed->compositeWithPrimitive(c), BadParameter);
  }
  auto* fixed = box({0, 90, 0}, 10);
  fixed->fix();
  EXPECT_THROW(c->compositeWithPrimitive(fixed), BadParameter);
  auto* pulled = box({0, -200, 0}, 10);
  auto* muscle = new Muscle(simulation.world(), simulation.space(), {0, 0, 0}, {0, -70, 0}, {0, -140, 0}, {0, -200, 0}, 120, 300);
  muscle->connectEndTo(pulled);
  EXPECT_THROW(c->compositeWithPrimitive(pulled), BadParameter);
  EXPECT_EQ(simulation.world().bodies().size(), 5u) << "nothing was merged";
}

TEST_F(Composite, RotateIsRefusedOnceThereIsAJoint) {
  auto *a = box({0, 0, 0}, 10), *b = box({40, 0, 0}, 10);
  a->attachHinge(b, {20, 0, 0}, {0, 0, 1});
  for (auto* jointed : {a, b}) {
    const auto message = messageOf<BadParameter>([&] { jointed->rotate(10, {0, 0, 1}); });
    EXPECT_TRUE(contains(message, "already has a joint"));
  }
}

TEST_F(Composite, RefusesPartsThatCannotBeJoined) {
  auto *a = box({0, 0, 0}, 10), *b = box({40, 0, 0}, 10), *c = box({80, 0, 0}, 10);
  EXPECT_THROW(a->compositeWithPrimitive(a), BadParameter);
  EXPECT_THROW(a->compositeWithPrimitive(nullptr), BadParameter);
  EXPECT_THROW(Primitive::compositePrimitives({}), BadParameter);
  EXPECT_THROW(Primitive::compositePrimitives({a}), BadParameter);
  EXPECT_THROW(Primitive::compositePrimitives({a, nullptr}), BadParameter);
  EXPECT_THROW(Primitive::compositePrimitives({a, nullptr}, a), BadParameter);
  EXPECT_THROW(Primitive::compositePrimitives({a, b}, c), BadParameter) << "the parent is not among the parts";
  a->compositeWithPrimitive(b);
  EXPECT_THROW(a->compositeWithPrimitive(b), BadParameter) << "twice";
  Simulation other;
  auto* stranger = new Sphere(other.world(), other.space(), {0, 0, 0}, 1, 0, 1);
  EXPECT_THROW(c->compositeWithPrimitive(stranger), BadParameter);
}

}  // namespace
}  // namespace musclesim
