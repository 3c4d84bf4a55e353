/// Compares steps of the chain stepper with steps of dWorldStep from the same state.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "../../robot/ode_vector.h"
#include "../../simulation/chain/chain_stepper.h"
#include "musclesim/base/random.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// All bodies of a simulation: bones, then beads.
inline std::vector<dBodyID> allBodies(const Simulation& simulation) {
  std::vector<dBodyID> bodies;
  for (const auto& body : simulation.world().bodies()) bodies.push_back(body->id);
  for (const auto& actuator : simulation.world().actuators())
    for (const Link& link : actuator->links())
      for (const dBodyID bead : link.bead) bodies.push_back(bead);
  return bodies;
}

/// Sorts the geometries by their bodies. ODE's space puts moved geometries in front, and of several contacts between two bodies only the
/// first one found counts, so both worlds must search in the same order.
inline void sortGeometries(const Simulation& simulation) {
  dSpaceCollide(simulation.space(), nullptr, [](void*, dGeomID first, dGeomID second) {
    if (dGeomIsSpace(first) || dGeomIsSpace(second)) dSpaceCollide2(first, second, nullptr, [](void*, dGeomID, dGeomID) {});
  });
  for (const dBodyID body : allBodies(simulation)) {
    const Vector x = positionOf(body);
    dBodySetPosition(body, x.x(), x.y(), x.z());
  }
}

/// Copies poses and velocities of all bodies from one simulation to another of the same robot.
inline void copyState(const Simulation& from, const Simulation& to) {
  const auto source = allBodies(from), target = allBodies(to);
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Vector x = positionOf(source[i]), v = fromOde(dBodyGetLinearVel(source[i])), w = fromOde(dBodyGetAngularVel(source[i]));
    dBodySetPosition(target[i], x.x(), x.y(), x.z());
    dBodySetQuaternion(target[i], dBodyGetQuaternion(source[i]));
    dBodySetLinearVel(target[i], v.x(), v.y(), v.z());
    dBodySetAngularVel(target[i], w.x(), w.y(), w.z());
  }
}

/// Gives both simulations the state of `from`. `from` gets its own state again too, because setting it applies ODE's normalisation, and the
/// contact point of two overlapping boxes may depend on the last bit.
inline void makeComparable(const Simulation& from, const Simulation& to) {
  sortGeometries(from);
  sortGeometries(to);
  copyState(from, to);
  copyState(from, from);
}

/// max |v - v'| / max |v| over all bodies, or the same of angular velocities if that is larger. At rest max |v| is itself a rounding
/// error, so the velocity that a body gains by falling for one step (at a bead's radius, for angular velocities) is its least value.
inline double velocityDifference(const Simulation& expected, const Simulation& actual) {
  const auto a = allBodies(expected), b = allBodies(actual);
  const double fall = expected.physics().gravity_mm_per_s2 * expected.internalStepS();
  constexpr double radius_mm = 7.5;
  double linear = 0, angular = 0, fastest = fall, fastest_spin = fall / radius_mm;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector v = fromOde(dBodyGetLinearVel(a[i])), w = fromOde(dBodyGetAngularVel(a[i]));
    linear = std::max(linear, (v - fromOde(dBodyGetLinearVel(b[i]))).cwiseAbs().maxCoeff());
    angular = std::max(angular, (w - fromOde(dBodyGetAngularVel(b[i]))).cwiseAbs().maxCoeff());
    fastest = std::max(fastest, v.cwiseAbs().maxCoeff());
    fastest_spin = std::max(fastest_spin, w.cwiseAbs().maxCoeff());
  }
  return std::max(linear / fastest, angular / fastest_spin);
}

inline double fastestBody(const Simulation& simulation) {
  double fastest = 0;
  for (const dBodyID body : allBodies(simulation)) fastest = std::max(fastest, fromOde(dBodyGetLinearVel(body)).norm());
  return fastest;
}

struct ComparisonCase {
  std::string robot = "arm";
  PhysicsKind physics = PhysicsKind::original;
  int muscle_count = 0;  ///< number of the arm's muscles; 0: the default
  int steps = 1000;
  double hold_s = 1.0;  ///< period of new random pressures; 0: constant pressures
  std::string initial_state = "built";
  double rest_s = 0;  ///< the chain stepper holds the first pressures for this time beforehand
  std::uint64_t seed = 1;
};

struct Comparison {
  double worst = 0;  ///< largest relative difference of velocities
  double mean_log10 = 0;
  int contacts = 0;  ///< largest number of contacts in a step
  double fastest_mm_per_s = 0;
  ChainStatistics chain;
};

inline std::unique_ptr<Simulation> makeSimulation(const ComparisonCase& c, StepperKind stepper) {
  SimulationOptions options;
  options.physics = c.physics;
  options.stepper = stepper;
  options.step_s = c.physics == PhysicsKind::original ? 0.01 : 8e-4;  // one internal step
  options.seed = c.seed;
  if (c.muscle_count > 0) options.parameters.setFromText("arm.muscle_count=" + std::to_string(c.muscle_count), "test");
  auto simulation = std::make_unique<Simulation>(std::move(options));
  simulation->build(c.robot);
  return simulation;
}

/// Follows dWorldStep's trajectory; both steppers do every step from the same state.
inline Comparison compareSteps(const ComparisonCase& c) {
  const auto ode = makeSimulation(c, StepperKind::ode), chain = makeSimulation(c, StepperKind::chain);
  RandomStream random(c.seed, "comparison");
  Action command(static_cast<std::size_t>(ode->robot().actuatorCount()), 0.0);
  auto draw = [&] {
    for (double& pressure : command) pressure = random.uniform();
  };
  draw();
  ode->start(c.initial_state, command);
  if (c.rest_s > 0) {
    chain->start(c.initial_state, command);
    chain->advance(c.rest_s);
    copyState(*chain, *ode);
  }
  Comparison result;
  const long hold = c.hold_s > 0 ? std::max(1L, std::lround(c.hold_s / ode->stepS())) : c.steps + 1;
  for (int i = 0; i < c.steps; ++i) {
    if (i > 0 && i % hold == 0) draw();
    ode->robot().step(command);
    chain->robot().step(command);
    makeComparable(*ode, *chain);
    ode->step();
    chain->step();
    const double difference = velocityDifference(*ode, *chain);
    result.worst = std::max(result.worst, difference);
    result.mean_log10 += std::log10(difference + 1e-17) / c.steps;
    result.fastest_mm_per_s = std::max(result.fastest_mm_per_s, fastestBody(*ode));
    result.contacts = std::max(result.contacts, ode->contactCount());
  }
  result.chain = dynamic_cast<const ChainStepper&>(chain->stepper()).statistics();
  return result;
}

}  // namespace musclesim
