#include "musclesim/robot/pull.h"

#include <gtest/gtest.h>

#include "musclesim/musclesim.h"

namespace musclesim {
namespace {

constexpr double stiffness_N_per_mm = 0.5, strongest_N = 100;

TEST(Pull, IsASpringToTheHandWithALimit) {
  Simulation simulation;
  new Sphere(simulation.world(), simulation.space(), {0, 0, 0}, 500, 0, 10);
  const PullForce near = pullForce(simulation.world(), {0, {0, 10, 0}, {30, 10, 40}});
  EXPECT_EQ(near.point_mm, Vector(0, 10, 0));
  EXPECT_LT((near.force_N - stiffness_N_per_mm * Vector(30, 0, 40)).norm(), 1e-12);
  const PullForce far = pullForce(simulation.world(), {0, {0, 0, 0}, {0, 1000, 0}});
  EXPECT_LT((far.force_N - Vector(0, strongest_N, 0)).norm(), 1e-12);
  EXPECT_THROW(pullForce(simulation.world(), {1, {}, {}}), BadParameter);
  EXPECT_THROW(simulation.pull(Pull{1, {}, {}}), BadParameter);
}

/// In equilibrium the spring carries the weight, and the held point stands below the hand.
TEST(Pull, HoldsAWeight) {
  for (const PhysicsKind physics : {PhysicsKind::si, PhysicsKind::scaled}) {
    SimulationOptions options;
    options.physics = physics;
    Simulation simulation(options);
    auto* load = new Box(simulation.world(), simulation.space(), {0, 0, 0}, 500, 0, 40, 40, 40);
    load->rotate(70, Vector::UnitX());
    const Vector hand_mm(20, 100, -30);
    simulation.pull(Pull{0, {0, 20, 0}, hand_mm});
    simulation.advance(physics == PhysicsKind::si ? 20 : 60);
    const PullForce pull = pullForce(simulation.world(), *simulation.pull());
    const double weight_N = 500 * simulation.physics().gravity_mm_per_s2 / simulation.physics().force_per_N;
    EXPECT_NEAR(pull.force_N.y(), weight_N, 0.02);
    EXPECT_LT(Vector(pull.force_N.x(), 0, pull.force_N.z()).norm(), 0.05);
    EXPECT_NEAR(pull.point_mm.y(), hand_mm.y() - weight_N / stiffness_N_per_mm, 0.1);
    simulation.pull(std::nullopt);
    simulation.advance(0.2);
    EXPECT_LT(load->getPosition().y(), hand_mm.y() - 40) << "it falls when nobody holds it";
  }
}

}  // namespace
}  // namespace musclesim
