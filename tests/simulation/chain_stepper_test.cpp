#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <thread>

#include "musclesim/robot/linear_actuator.h"
#include "step_comparison.h"
#include "support/support.h"

namespace musclesim {
namespace {

constexpr double exactness = 1e-9;

void expectSameSteps(const ComparisonCase& c) {
  const Comparison r = compareSteps(c);
  EXPECT_LT(r.worst, exactness) << c.robot << " " << nameOf(c.physics) << " " << c.muscle_count;
  EXPECT_EQ(r.chain.unsolved_steps, 0);
}

TEST(ChainStepper, RigAndElbowStepLikeDWorldStep) {
  for (const PhysicsKind physics : {PhysicsKind::original, PhysicsKind::si})
    for (const char* initial_state : {"built", "settled"}) {
      expectSameSteps({.robot = "rig", .physics = physics, .steps = 1000, .hold_s = 0.1, .initial_state = initial_state});
      expectSameSteps({.robot = "elbow", .physics = physics, .steps = 300, .hold_s = 0.03, .initial_state = initial_state});
    }
}

TEST(ChainStepper, ArmStepsLikeDWorldStep) {
  for (const PhysicsKind physics : {PhysicsKind::original, PhysicsKind::si}) {
    const double hold_s = physics == PhysicsKind::original ? 0.5 : 0.01;
    expectSameSteps({.physics = physics, .muscle_count = 1, .steps = 1000, .hold_s = hold_s});
    expectSameSteps({.physics = physics, .muscle_count = 5, .steps = 200, .hold_s = hold_s});
    expectSameSteps({.physics = physics, .muscle_count = 10, .steps = longTests() ? 1000 : 50, .hold_s = hold_s});
  }
}

/// Reads a trajectory of the reference: rows of time, ten commands, hand position, ten lengths.
std::vector<std::vector<double>> readRows(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line)) {
    std::stringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

TEST(ChainStepper, FollowsTheReferenceTrajectories) {
  for (const char* name : {"steps_every_6s.csv", "vented.csv"}) {
    const auto file = sharedFolder() / "reference" / "trajectories" / name;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    const auto simulation = makeSimulation({}, StepperKind::automatic);
    ASSERT_EQ(simulation->stepper().name(), "chain");
    for (const auto& row : readRows(file)) {
      if (row[0] > 18.01) break;
      const double apart_mm = (*simulation->robot().getState().hand_mm - Vector(row[11], row[12], row[13])).norm();
      EXPECT_LT(apart_mm, row[0] <= 10 ? 0.01 : 0.5) << name << " at " << row[0] << " s";
      simulation->robot().step(Action(row.begin() + 1, row.begin() + 11));
      for (int i = 0; i < 10; ++i) simulation->step();
    }
    EXPECT_EQ(simulation->stepper().unsolvedSteps(), 0);
  }
}

/// All positions after 300 steps of random pressures.
std::vector<double> positionsAfterRun(std::uint64_t seed) {
  const auto simulation = makeSimulation({.seed = seed}, StepperKind::automatic);
  RandomStream random(seed, "pressures");
  for (int i = 0; i < 300; ++i) {
    if (i % 50 == 0) {
      Action command(10);
      for (double& pressure : command) pressure = random.uniform();
      simulation->robot().step(command);
    }
    simulation->step();
  }
  std::vector<double> positions;
  for (const dBodyID body : allBodies(*simulation))
    for (int i = 0; i < 3; ++i) positions.push_back(dBodyGetPosition(body)[i]);
  return positions;
}

TEST(ChainStepper, TwoThreadsGiveTheBitsOfOne) {
  const auto first = positionsAfterRun(1), second = positionsAfterRun(2);
  std::vector<double> of_threads[2];
  std::thread threads[2];
  for (int i = 0; i < 2; ++i) threads[i] = std::thread([&, i] { of_threads[i] = positionsAfterRun(static_cast<std::uint64_t>(i) + 1); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(of_threads[0], first);
  EXPECT_EQ(of_threads[1], second);
  EXPECT_NE(first, second);
}

/// Two bones, a linear actuator between them, a sphere on a plane, a body without joints.
void buildMixture(Simulation& simulation) {
  const dWorldID world = simulation.world();
  const dSpaceID space = simulation.space();
  auto* upper = new Box(world, space, {0, 100, 0}, 200, 0, 40, 20, 30);
  auto* lower = new CappedCylinder(world, space, {0, 0, 0}, 150, 0, 10, 60);
  upper->attachBall(nullptr, {-20, 110, 0});
  lower->rotate(50, {1, 0.3, 0});
  lower->attachHinge(upper, {30, 50, 0}, {0, 0.2, 2}, -5, 40);
  auto* actuator = new LinearActuator(world, space, {20, 90, 0}, {10, 10, 5}, 40, 120);
  actuator->connectStartTo(upper);
  actuator->connectEndTo(lower);
  actuator->setPressure(0.4);
  auto* ball = new Sphere(world, space, {200, -489, 0}, 50, 0, 11);
  auto* slider = new Box(world, space, {-200, 0, 0}, 80, 0, 10, 20, 40);
  slider->attachSlider(ball, {0.3, 1, 0.1});
  new Box(world, space, {400, 0, 0}, 60, 0, 10, 50, 90);
}

TEST(ChainStepper, TakesOtherSkeletonsContactsAndForcesLikeDWorldStep) {
  SimulationOptions options;
  options.plane = true;
  options.step_s = 1e-3;
  options.substeps = 1;
  options.stepper = StepperKind::ode;
  Simulation ode(options);
  options.stepper = StepperKind::chain;
  Simulation chain(options);
  for (Simulation* simulation : {&ode, &chain}) buildMixture(*simulation);
  dBodySetAngularVel(ode.world().bodies()[4]->id, 10, 20, -5);
  int most_contacts = 0;
  for (int i = 0; i < 400; ++i) {
    copyState(ode, chain);
    for (Simulation* simulation : {&ode, &chain}) {
      dBodyAddForce(simulation->world().bodies()[1]->id, 1e4, -2e4, 5e3);
      dBodyAddTorque(simulation->world().bodies()[0]->id, 1e5, 0, -3e5);
      simulation->step();
    }
    most_contacts = std::max(most_contacts, ode.contactCount());
    ASSERT_LT(velocityDifference(ode, chain), exactness) << i;
  }
  EXPECT_EQ(chain.stepper().name(), "chain");
  EXPECT_GT(most_contacts, 0);
}

/// A fixed body that rests to the last bit is not computed again until something acts on it.
TEST(ChainStepper, TakesWhatHappensToABodyAtRestLikeDWorldStep) {
  SimulationOptions options;
  options.stepper = StepperKind::ode;
  Simulation ode(options);
  options.stepper = StepperKind::chain;
  Simulation chain(options);
  for (Simulation* simulation : {&ode, &chain}) {
    for (const double x_mm : {0.0, 300.0}) (new Box(simulation->world(), simulation->space(), {x_mm, 0, 0}, 100, 0, 10, 20, 30))->fix();
    simulation->world().primitives()[1]->fix();  // twice
  }
  for (int step = 0; step < 200; ++step) {
    for (const Simulation* simulation : {&ode, &chain}) {
      const dBodyID body = simulation->world().bodies()[0]->id;
      dMass heavy;
      dMassSetSphereTotal(&heavy, 500, 20);
      if (step == 60) dBodyAddForce(body, 1e9, 0, -1e9);
      if (step >= 60 && step < 80) dBodyAddForce(simulation->world().bodies()[1]->id, 0, 1e9, 0);
      if (step == 100) dBodySetAngularVel(body, 0, 1e-3, 0);
      if (step == 140) dBodySetMass(body, &heavy);
      if (step == 180) dBodySetPosition(body, 0, 1e-3, 0);
    }
    ode.step();
    chain.step();
    EXPECT_LT(velocityDifference(ode, chain), 1e-9) << step;
  }
}

/// Joints with equal stops, and motors whose speed changes during the run.
TEST(ChainStepper, TakesEqualStopsAndChangedMotorsLikeDWorldStep) {
  SimulationOptions options;
  options.substeps = 1;
  options.step_s = 1e-3;
  options.stepper = StepperKind::ode;
  Simulation ode(options);
  options.stepper = StepperKind::chain;
  Simulation chain(options);
  std::vector<dJointID> motors;
  for (Simulation* simulation : {&ode, &chain})
    for (int i = 0; i < 3; ++i) {
      const double x_mm = 100.0 * i, limit_deg = i == 2 ? 90 : 0;
      auto* box = new Box(simulation->world(), simulation->space(), {x_mm, 0, 0}, 100, 0, 10, 60, 30);
      const dJointID hinge = box->attachHinge(nullptr, {x_mm, 30, 0}, {0, 0, 1}, -limit_deg, limit_deg)->id();
      dJointSetHingeParam(hinge, dParamFMax, 1e5);
      dJointSetHingeParam(hinge, dParamVel, 1);
      dBodySetAngularVel(simulation->world().bodies()[static_cast<std::size_t>(i)]->id, 0, 0, i == 0 ? 5 : -5);
      motors.push_back(hinge);
    }
  for (int step = 0; step < 200; ++step) {
    if (step == 100)
      for (const dJointID hinge : motors) dJointSetHingeParam(hinge, dParamVel, -3);
    copyState(ode, chain);
    ode.step();
    chain.step();
    ASSERT_LT(velocityDifference(ode, chain), exactness) << step;
  }
  EXPECT_EQ(chain.stepper().name(), "chain");
}

/// The same number of bodies as before, but different ones.
TEST(ChainStepper, TakesBodiesPutTogetherLaterLikeDWorldStep) {
  SimulationOptions options;
  options.plane = true;
  options.stepper = StepperKind::ode;
  Simulation ode(options);
  options.stepper = StepperKind::chain;
  Simulation chain(options);
  for (Simulation* simulation : {&ode, &chain}) {
    for (const double x_mm : {0.0, 40.0, 300.0}) new Box(simulation->world(), simulation->space(), {x_mm, -491, 0}, 100, 0, 30, 20, 30);
    simulation->step();
    simulation->world().primitives()[0]->compositeWithPrimitive(simulation->world().primitives()[1]);
    new Box(simulation->world(), simulation->space(), {10, -472, 5}, 300, 0, 30, 20, 30);
  }
  int most_contacts = 0;
  for (int step = 0; step < 50; ++step) {
    makeComparable(ode, chain);
    ode.step();
    chain.step();
    most_contacts = std::max(most_contacts, chain.contactCount());
    ASSERT_LT(velocityDifference(ode, chain), exactness) << step;
  }
  EXPECT_GT(most_contacts, 1);
}

TEST(ChainStepper, LeavesUniversalJointsToDWorldStepAndSaysSo) {
  SimulationOptions options;
  Simulation simulation(options);
  auto* bone = new Box(simulation.world(), simulation.space(), {0, 0, 0}, 100, 0, 10, 10, 10);
  bone->attachUniversal(nullptr, {0, 20, 0}, {1, 0, 0}, {0, 0, 1});
  simulation.step();
  EXPECT_EQ(simulation.stepper().name(), "ode");
  EXPECT_TRUE(contains(simulation.stepper().message(), "dWorldStep is used"));
}

TEST(ChainStepper, RefusesWhatItCannotTakeWhereItIsAskedFor) {
  SimulationOptions options;
  options.stepper = StepperKind::chain;
  Simulation simulation(options);
  auto* actuator = new LinearActuator(simulation.world(), simulation.space(), {0, 0, 0}, {0, 80, 0}, 40, 120);
  actuator->connectStartTo(nullptr);
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { simulation.step(); }), "an end of muscle_0 is not connected"));
}

TEST(ChainStepper, TakesWhatIsBuiltLater) {
  SimulationOptions options;
  Simulation simulation(options);
  auto* bone = new Box(simulation.world(), simulation.space(), {0, 0, 0}, 100, 0, 10, 10, 10);
  simulation.step();
  const double fallen = dBodyGetLinearVel(bone->body().id)[1];
  EXPECT_LT(fallen, 0);
  bone->fix();
  for (int i = 0; i < 5; ++i) simulation.step();
  EXPECT_GT(dBodyGetLinearVel(bone->body().id)[1], fallen);
}

TEST(ChainStepper, LeavesAStepToDWorldStepWhereItCannotSolveIt) {
  SimulationOptions options;
  options.substeps = 1;
  options.step_s = 1e-3;
  Simulation simulation(options);
  auto* bone = new Box(simulation.world(), simulation.space(), {0, 0, 0}, 100, 0, 10, 10, 10);
  simulation.step();
  EXPECT_EQ(simulation.stepper().unsolvedSteps(), 0);
  // A body that was not made through the simulation, in contact with one that was.
  const dBodyID stranger = dBodyCreate(simulation.world());
  dBodySetPosition(stranger, 0, 9, 0);
  const dGeomID geom = dCreateSphere(simulation.space(), 5);
  dGeomSetBody(geom, stranger);
  simulation.step();
  EXPECT_EQ(simulation.stepper().unsolvedSteps(), 1);
  EXPECT_NE(dBodyGetLinearVel(stranger)[1], 0);
  dGeomDestroy(geom);
  const double falling = dBodyGetLinearVel(bone->body().id)[1];
  simulation.step();
  EXPECT_EQ(simulation.stepper().unsolvedSteps(), 1);
  EXPECT_LT(dBodyGetLinearVel(bone->body().id)[1], falling);
}

TEST(ChainStepper, NamesTheBodyThatEscapesAndKeepsTheWorld) {
  const auto simulation = makeSimulation({.robot = "elbow"}, StepperKind::automatic);
  const dBodyID forearm = simulation->world().bodies()[0]->id;
  const Vector before = positionOf(forearm);
  dBodySetLinearVel(forearm, std::nan(""), 0, 0);
  EXPECT_TRUE(contains(messageOf<Diverged>([&] { simulation->step(); }), "forearm"));
  EXPECT_EQ(positionOf(forearm), before);
}

TEST(ChainStepper, KnowsTheGapsOfItsJoints) {
  const auto simulation = makeSimulation({}, StepperKind::automatic);
  for (int i = 0; i < 20; ++i) {
    simulation->step();
    EXPECT_NEAR(simulation->stepper().largestGap()->gap_mm, simulation->largestGap().gap_mm, 1e-9);
  }
}

}  // namespace
}  // namespace musclesim
