#include "../../simulation/bone_mobility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../robot/ode_vector.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {
namespace {

using Pushes = std::vector<LineOfPull::Push>;

std::unique_ptr<Simulation> buildWithLines(const std::string& robot) {
  SimulationOptions options;
  options.physics = PhysicsKind::si;
  options.parameters.setFromText("muscle.model=line", "test");
  options.parameters.setFromText("physics.constraint_force_mixing=1e-15", "test");  // hard joints
  auto simulation = std::make_unique<Simulation>(std::move(options));
  simulation->build(robot);
  for (const auto& joint : simulation->world().joints()) {
    if (joint->kind() != Joint::Kind::hinge) continue;
    dJointSetHingeParam(joint->id(), dParamLoStop, -dInfinity);
    dJointSetHingeParam(joint->id(), dParamHiStop, dInfinity);
  }
  return simulation;
}

/// Speed at which the line gets longer.
double speedOf(const Pushes& line) {
  double sum = 0;
  for (const auto& push : line)
    sum += push.force.dot(fromOde(dBodyGetLinearVel(push.body))) + push.torque.dot(fromOde(dBodyGetAngularVel(push.body)));
  return sum;
}

/// Response of dWorldStep to a force on one line: speeds of all lines per force and time, from rest, without gravity.
std::vector<double> responses(const std::string& robot, std::size_t pushed) {
  constexpr double force = 1e12, h_s = 1e-3;  // far above the forces that correct rounding errors of the joints
  const auto simulation = buildWithLines(robot);
  dWorldSetGravity(simulation->world(), 0, 0, 0);
  for (const auto& push : simulation->world().actuators()[pushed]->line()->pushes()) {
    const Vector f = force * push.force, t = force * push.torque;
    dBodyAddForce(push.body, f.x(), f.y(), f.z());
    dBodyAddTorque(push.body, t.x(), t.y(), t.z());
  }
  std::vector<Pushes> lines;
  for (const auto& actuator : simulation->world().actuators()) lines.push_back(actuator->line()->pushes());
  dWorldStep(simulation->world(), h_s);
  std::vector<double> speeds;
  for (const Pushes& line : lines) speeds.push_back(speedOf(line) / (force * h_s));
  return speeds;
}

TEST(BoneMobility, IsWhatDWorldStepDoesWithAForce) {
  for (const char* robot : {"arm", "elbow", "rig", "wrist"}) {
    const auto simulation = buildWithLines(robot);
    const std::size_t count = simulation->world().actuators().size();
    const BoneMobility mobility(simulation->world().joints(), {});
    for (std::size_t a = 0; a < count; ++a) {
      const Pushes pushed = simulation->world().actuators()[a]->line()->pushes();
      std::vector<double> expected;
      for (const auto& actuator : simulation->world().actuators()) expected.push_back(mobility.between(actuator->line()->pushes(), pushed));
      const std::vector<double> measured = responses(robot, a);
      const double scale = std::abs(expected[a]);
      EXPECT_GT(scale, 0) << robot;
      for (std::size_t b = 0; b < count; ++b) EXPECT_NEAR(measured[b], expected[b], 1e-4 * scale) << robot << ", " << b << " by " << a;
    }
  }
}

TEST(BoneMobility, BodiesWithoutJointsMoveFreely) {
  const auto simulation = buildWithLines("arm");
  const BoneMobility held(simulation->world().joints(), {}), loose({}, {});
  for (const auto& actuator : simulation->world().actuators()) {
    const Pushes line = actuator->line()->pushes();
    EXPECT_GT(held.between(line, line), 0);
    EXPECT_LT(held.between(line, line), loose.between(line, line));
  }
}

TEST(BoneMobility, LeavesOutBodiesAndTheirJoints) {
  const auto simulation = buildWithLines("elbow");
  std::vector<dBodyID> bodies;
  for (const auto& body : simulation->world().bodies()) bodies.push_back(body->id);
  std::sort(bodies.begin(), bodies.end());
  const BoneMobility without(simulation->world().joints(), bodies), loose({}, {});
  const Pushes line = simulation->world().actuators().front()->line()->pushes();
  EXPECT_EQ(without.between(line, line), loose.between(line, line));
}

}  // namespace
}  // namespace musclesim
