/// Steppers move all bodies of a world by one internal step.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/error.h"
#include "musclesim/robot/state.h"

namespace musclesim {

class Actuator;
class Joint;

enum class StepperKind { automatic, chain, ode, quick };

/// "auto", "chain", "ode" or "quick". Throws BadParameter for any other name.
StepperKind stepperFromName(const std::string& name);

/// Thrown when a body leaves the bounds of BodyBounds.
class BodyOutOfBounds : public Error {
 public:
  BodyOutOfBounds(dBodyID body, const std::string& what) : Error(what), body_(body) {}
  dBodyID body() const { return body_; }

 private:
  dBodyID body_;
};

/// Bounds on a body's position and velocity, along each axis.
struct BodyBounds {
  double farthest_mm, fastest_mm_per_s;
  /// Throws BodyOutOfBounds if the body is out of bounds or a number is not finite.
  void require(dBodyID body, const Vector& position_mm, const Vector& velocity_mm_per_s) const {
    const bool within = (position_mm.array().abs() <= farthest_mm).all() && (velocity_mm_per_s.array().abs() <= fastest_mm_per_s).all();
    if (!within) refuse(body, position_mm, velocity_mm_per_s);
  }

 private:
  [[noreturn]] void refuse(dBodyID body, const Vector& position_mm, const Vector& velocity_mm_per_s) const;
};

/// A joint and its constraint error: the distance between its anchors on the two bodies.
struct TornJoint {
  double gap_mm = 0;
  const Joint* joint = nullptr;
};

using Actuators = std::vector<Actuator*>;

class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Prepares for the robot as it is now; step() calls this if necessary. Throws BadParameter for a robot that this stepper cannot handle.
  virtual void prepare() {}
  /// Passes the tensions, hinge stops and bead inertias of the actuators for a step of h_s to ODE. A stepper that reads the actuators
  /// itself overrides this.
  virtual void applyForces(const Actuators& actuators, double h_s);
  /// Moves the bodies by h_s seconds under the forces accumulated so far, the joints and the contacts.
  virtual void step(double h_s) = 0;
  virtual std::string name() const = 0;
  /// Message for the user about the choice of stepper; empty if there is none.
  virtual std::string message() const { return {}; }
  /// Number of steps that dWorldStep did because this stepper's solver did not converge.
  virtual long unsolvedSteps() const { return 0; }
  /// Whether the last step already checked that no body left the bounds.
  virtual bool hasCheckedBounds() const { return false; }
  /// The joint with the largest constraint error after the last step, if this stepper knows it without reading ODE.
  virtual std::optional<TornJoint> largestGap() const { return std::nullopt; }
};

/// ODE's dWorldStep: exact, but its cost grows with the cube of the number of constraints.
class OdeStepper final : public Stepper {
 public:
  explicit OdeStepper(dWorldID world) : world_(world) {}
  void step(double h_s) override;
  std::string name() const override { return "ode"; }

 private:
  dWorldID world_;
};

/// ODE's dWorldQuickStep: iterative, fast and inexact (muscles contract too far, constraint errors reach millimetres).
class QuickStepper final : public Stepper {
 public:
  /// Each step does `iteration_count` sweeps. ODE's random generator, seeded with `seed`, decides the order of rows.
  QuickStepper(dWorldID world, int iteration_count, unsigned long seed);
  void step(double h_s) override;
  std::string name() const override { return "quick"; }

 private:
  dWorldID world_;
  unsigned long random_state_;
};

}  // namespace musclesim
