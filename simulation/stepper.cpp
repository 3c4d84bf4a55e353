#include "musclesim/simulation/stepper.h"

#include <fmt/format.h>

#include <mutex>

#include "../robot/actuator_step.h"

namespace musclesim {

void BodyBounds::refuse(dBodyID body, const Vector& position_mm, const Vector& velocity_mm_per_s) const {
  const double distance_mm = position_mm.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  if (!(distance_mm <= farthest_mm)) throw BodyOutOfBounds(body, fmt::format("it is {:.3g} mm away from the origin", distance_mm));
  throw BodyOutOfBounds(body, fmt::format("it moves at {:.3g} mm/s", velocity_mm_per_s.cwiseAbs().maxCoeff<Eigen::PropagateNaN>()));
}

void Stepper::applyForces(const Actuators& actuators, double h_s) {
  for (const auto& actuator : actuators) {
    musclesim::applyForces(*actuator);
    applyBeadInertia(*actuator, h_s);
  }
}

StepperKind stepperFromName(const std::string& name) {
  if (name == "auto") return StepperKind::automatic;
  if (name == "chain") return StepperKind::chain;
  if (name == "ode") return StepperKind::ode;
  if (name == "quick") return StepperKind::quick;
  throw BadParameter("stepper", name, "be one of auto, chain, ode, quick");
}

void OdeStepper::step(double h_s) {
  if (!dWorldStep(world_, h_s)) throw OdeFault("dWorldStep ran out of memory");
}

QuickStepper::QuickStepper(dWorldID world, int iteration_count, unsigned long seed) : world_(world), random_state_(seed) {
  dWorldSetQuickStepNumIterations(world_, iteration_count);
}

void QuickStepper::step(double h_s) {
  // All threads share ODE's random generator. Restoring its state before every step, and one step at a time, keeps simulations in different
  // threads independent.
  static std::mutex generator;
  const std::lock_guard<std::mutex> lock(generator);
  dRandSetSeed(random_state_);
  if (!dWorldQuickStep(world_, h_s)) throw OdeFault("dWorldQuickStep ran out of memory");
  random_state_ = dRandGetSeed();
}

}  // namespace musclesim
