/// Bodies without joints: free fall, and conservation of momentum without external forces.
#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/base/units.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {
namespace {

Vector velocityOf(dBodyID body) {
  const dReal* v = dBodyGetLinearVel(body);
  return {v[0], v[1], v[2]};
}

SimulationOptions weightless() {
  SimulationOptions options;
  options.parameters.set("physics.gravity_m_per_s2", 0.0, "test");
  options.substeps = 5;
  return options;
}

/// Difference from y = -g t^2 / 2 after one second of free fall, mm.
double fallErrorMm(double step_s) {
  SimulationOptions options;
  options.step_s = step_s;
  options.substeps = 1;
  Simulation simulation(options);
  const auto* stone = new Sphere(simulation.world(), nullptr, {0, 0, 0}, 100, 0, 10);
  while (simulation.time_s() < 1 - step_s / 2) simulation.step();
  EXPECT_NEAR(velocityOf(stone->body().id).y(), -gravity_m_per_s2 * mm_per_m, 1e-8);
  return stone->getPosition().y() + gravity_m_per_s2 * mm_per_m / 2;
}

TEST(FreeFall, FollowsTheParabolaWithinHalfAStep) {
  // Exact for this integrator: y = -g t (t + h) / 2.
  for (const double step_s : {0.02, 0.01, 0.005}) EXPECT_NEAR(fallErrorMm(step_s), -gravity_m_per_s2 * mm_per_m * step_s / 2, 1e-8);
}

TEST(FreeFall, HalfTheStepGivesHalfTheError) {
  EXPECT_NEAR(fallErrorMm(0.02) / fallErrorMm(0.01), 2, 1e-9);
}

TEST(Momentum, OfAFreeBodyDoesNotDrift) {
  Simulation simulation(weightless());
  auto* body = new Box(simulation.world(), nullptr, {0, 0, 0}, 100, 0, 60, 40, 20);
  auto* ball = new Sphere(simulation.world(), nullptr, {0, 500, 0}, 100, 0, 20);
  const Vector velocity(120, -50, 70);
  for (Primitive* p : {static_cast<Primitive*>(body), static_cast<Primitive*>(ball)}) {
    dBodySetLinearVel(p->body().id, velocity.x(), velocity.y(), velocity.z());
    dBodySetAngularVel(p->body().id, 3, -2, 5);
  }
  for (int i = 0; i < 1000; ++i) simulation.step();
  EXPECT_LT((velocityOf(body->body().id) - velocity).norm(), 1e-10 * velocity.norm());
  EXPECT_LT((body->getPosition() - 10 * velocity).norm(), 1e-10 * 10 * velocity.norm());
  const dReal* spin = dBodyGetAngularVel(ball->body().id);
  EXPECT_LT((Vector(spin[0], spin[1], spin[2]) - Vector(3, -2, 5)).norm(), 1e-10 * 6) << "angular momentum of a ball";
}

TEST(Momentum, OfTwoBodiesAndTheMuscleBetweenThemDoesNotDrift) {
  Simulation simulation(weightless());
  auto* left = new Sphere(simulation.world(), nullptr, {0, 0, 0}, 800, 0, 20);
  auto* right = new Sphere(simulation.world(), nullptr, {200, 0, 0}, 300, 0, 20);
  auto* muscle = new Muscle(simulation.world(), simulation.space(), {0, 0, 0}, {70, 20, 0}, {130, -20, 10}, {200, 0, 0}, 90, 300);
  muscle->connectStartTo(left);
  muscle->connectEndTo(right);
  muscle->setPressure(0.4);
  double exchanged = 0, drift = 0;
  for (int i = 0; i < 20; ++i) {
    simulation.step();
    Vector sum = Vector::Zero();
    double absolute = 0;
    auto add = [&](dBodyID body) {
      dMass mass;
      dBodyGetMass(body, &mass);
      sum += mass.mass * velocityOf(body);
      absolute += mass.mass * velocityOf(body).norm();
    };
    for (const auto& body : simulation.world().bodies()) add(body->id);
    for (const Link& link : muscle->links())
      for (const dBodyID bead : link.bead) add(bead);
    exchanged = std::max(exchanged, absolute);
    drift = std::max(drift, sum.norm());
  }
  EXPECT_GT(exchanged, 1e4);
  EXPECT_LT(drift, 1e-10 * exchanged);
}

}  // namespace
}  // namespace musclesim
