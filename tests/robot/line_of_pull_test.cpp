#include "musclesim/robot/line_of_pull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "../../robot/actuator_step.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

SimulationOptions lineOptions(const std::string& more = "") {
  SimulationOptions options;
  options.parameters.setFromText("muscle.model=line", "test");
  if (!more.empty()) options.parameters.setFromText(more, "test");
  return options;
}

/// 120 .. 300 mm long, from `top` down to `bottom`.
Muscle* lineBetween(Simulation& simulation, const Vector& top, const Vector& bottom) {
  return new Muscle(simulation.world(), simulation.space(), top, top + (bottom - top) / 3, top + (bottom - top) * 2 / 3, bottom, 120, 300);
}

TEST(LineMuscle, HasNoLinksAndTheLengthOfItsLine) {
  Simulation simulation(lineOptions());
  const auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -210, 0});
  EXPECT_TRUE(muscle->links().empty());
  EXPECT_EQ(muscle->massG(), 0);
  EXPECT_NEAR(muscle->lengthMm(), 210, 1e-12);
}

TEST(LineMuscle, CarriesALoadWhereItsForceEqualsTheWeight) {
  Simulation simulation(lineOptions("rig.load_kg=3"));
  simulation.build("rig");
  simulation.start("settled", {0.6});
  simulation.advance(3);
  const Actuator& muscle = *simulation.world().actuators().front();
  EXPECT_NEAR(muscle.tensionN(), 3 * 9.81, 0.05);
  EXPECT_NEAR(muscle.calculateForce(0.6, muscle.lengthMm()), muscle.tensionN(), 1e-12);
}

TEST(LineMuscle, PullsAtItsViaPointsAlongBothPieces) {
  Simulation simulation(lineOptions());
  auto* ring = new Sphere(simulation.world(), nullptr, {100, -100, 0}, 1000, 0, 5);
  auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -200, 0});
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(nullptr);
  muscle->addViaPoint(ring, {100, -100, 0});
  EXPECT_NEAR(muscle->lengthMm(), 2 * std::sqrt(2e4), 1e-9);
  muscle->setPressure(1);
  simulation.effects().update();
  applyForces(*muscle);
  const dReal* force = dBodyGetForce(ring->body().id);
  const double expected = -std::sqrt(2.0) * muscle->tensionN() * simulation.physics().force_per_N;
  EXPECT_NEAR(force[0], expected, 1e-9 * std::abs(expected)) << "two pieces at 45 degrees pull to the side";
  EXPECT_NEAR(force[1], 0, 1e-9 * std::abs(expected));
}

TEST(LineMuscle, KeepsItsPlacesWhereABodyGetsAPointMass) {
  Simulation simulation(lineOptions());
  auto* bone = new Sphere(simulation.world(), nullptr, {0, -250, 0}, 1000, 0, 5);
  bone->rotate(30, {1, 2, 0});
  auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -200, 0});
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(bone);
  bone->addPointMass(500, {90, -300, 10});
  EXPECT_GT(bone->getPosition().x(), 20);
  EXPECT_NEAR(muscle->lengthMm(), 200, 1e-12);
}

TEST(LineMuscle, ConservesMomentumBetweenTwoBodies) {
  Simulation simulation(lineOptions("physics.gravity_m_per_s2=0"));
  auto* heavy = new Sphere(simulation.world(), nullptr, {0, 0, 0}, 1000, 0, 20);
  auto* light = new Sphere(simulation.world(), nullptr, {0, -220, 0}, 300, 0, 20);
  auto* muscle = lineBetween(simulation, {5, 0, 0}, {0, -210, 3});
  muscle->connectStartTo(heavy);
  muscle->connectEndTo(light);
  muscle->setPressure(0.7);
  for (int i = 0; i < 30; ++i) simulation.step();
  const dReal *v = dBodyGetLinearVel(heavy->body().id), *w = dBodyGetLinearVel(light->body().id);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(1000 * v[i] + 300 * w[i], 0, 1e-6);
  EXPECT_LT(muscle->lengthMm(), 205);
}

TEST(LineMuscle, StopsBeyondItsLongestLength) {
  SimulationOptions options = lineOptions("rig.load_kg=50");
  options.parameters.setFromText("muscle.slider_friction_N=100", "test");  // so that it comes to rest
  Simulation simulation(std::move(options));
  simulation.build("rig");
  simulation.start("built", {0.0});
  simulation.advance(10);
  // F(0, l) + 10 N/mm (l - 300 mm) carries 490 N.
  const Actuator& muscle = *simulation.world().actuators().front();
  EXPECT_NEAR(muscle.tensionN() + 10 * (muscle.lengthMm() - 300), 50 * 9.81, 2);
}

TEST(LineMuscle, SlackLinesDoNotPush) {
  Simulation simulation(lineOptions());
  auto* load = new Sphere(simulation.world(), nullptr, {0, -210, 0}, 1000, 0, 5);
  auto* muscle = lineBetween(simulation, {0, 0, 0}, {0, -210, 0});
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(load);
  load->place({0, -60, 0}, Eigen::Matrix3d::Identity());
  muscle->setPressure(1);
  simulation.effects().update();
  EXPECT_LT(muscle->calculateForce(1, 60), 0) << "Eq. 1 continued below the shortest length";
  EXPECT_EQ(muscle->tensionN(), 0);
}

TEST(LineMuscle, TwiceConnectedEndsAndViaPointsOfChainsAreRefused) {
  Simulation simulation(lineOptions());
  auto* line = lineBetween(simulation, {0, 0, 0}, {0, -210, 0});
  line->connectEndTo(nullptr);
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { line->connectEndTo(nullptr); }), "already connected"));
  Simulation chains;
  auto* chain = lineBetween(chains, {0, 0, 0}, {0, -210, 0});
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { chain->addViaPoint(nullptr, {0, 0, 0}); }), "is a chain"));
}

TEST(LineMuscle, IsNotTiedToAnotherSimulation) {
  Simulation simulation(lineOptions()), other(lineOptions());
  auto* line = lineBetween(simulation, {0, 0, 0}, {0, -210, 0});
  auto* bone = new Sphere(other.world(), nullptr, {0, -210, 0}, 1000, 0, 5);
  for (const auto& tie : std::vector<std::function<void()>>{[&] { line->connectStartTo(bone); }, [&] { line->connectEndTo(bone); },
                                                            [&] {
                                                              line->addViaPoint(bone, {0, -100, 0});
                                                            }})
    EXPECT_TRUE(contains(messageOf<BadParameter>(tie), "different simulations"));
}

}  // namespace
}  // namespace musclesim
