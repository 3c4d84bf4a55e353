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

/// A body left the bounds that a physical system keeps to.
class BodyOutOfBounds : public Error {
 public:
  BodyOutOfBounds(dBodyID body, const std::string& what) : Error(what), body_(body) {}
  dBodyID body() const { return body_; }

 private:
  dBodyID body_;
};

/// How far from the origin and how fast a body may be, along each axis.
struct BodyBounds {
  double farthest_mm, fastest_mm_per_s;
  /// Throws BodyOutOfBounds; numbers that are not finite are out of bounds.
  void require(dBodyID body, const Vector& position_mm, const Vector& velocity_mm_per_s) const {
    const bool within = (position_mm.array().abs() <= farthest_mm).all() && (velocity_mm_per_s.array().abs() <= fastest_mm_per_s).all();
    if (!within) refuse(body, position_mm, velocity_mm_per_s);
  }

 private:
  [[noreturn]] void refuse(dBodyID body, const Vector& position_mm, const Vector& velocity_mm_per_s) const;
};

/// A joint and the distance by which it is torn.
struct TornJoint {
  double gap_mm = 0;
  const Joint* joint = nullptr;
};

using Actuators = std::vector<Actuator*>;

class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Makes ready for the robot as it is built by now; step() does so too where it is needed. Throws BadParameter for a robot that this
  /// stepper cannot take.
  virtual void prepare() {}
  /// Hands the actuators' tensions, hinge stops and the inertia of beads in a step of h_s to ODE. Steppers that ask the actuators
  /// themselves leave this out.
  virtual void applyForces(const Actuators& actuators, double h_s);
  /// Moves the bodies by h_s seconds under the forces accumulated so far, the joints and the contacts.
  virtual void step(double h_s) = 0;
  virtual std::string name() const = 0;
  /// What the user should know about the choice of stepper; empty: nothing.
  virtual std::string message() const { return {}; }
  /// Steps that this stepper left to dWorldStep because its own solver did not end.
  virtual long unsolvedSteps() const { return 0; }
  /// Whether the last step has itself made sure that no body left the bounds.
  virtual bool hasCheckedBounds() const { return false; }
  /// The joint torn furthest after the last step, if this stepper knows it without asking ODE.
  virtual std::optional<TornJoint> largestGap() const { return std::nullopt; }
};

/// ODE's dWorldStep: exact, cost grows with the cube of the number of constraints.
class OdeStepper final : public Stepper {
 public:
  explicit OdeStepper(dWorldID world) : world_(world) {}
  void step(double h_s) override;
  std::string name() const override { return "ode"; }

 private:
  dWorldID world_;
};

/// ODE's dWorldQuickStep: iterative, fast and inexact (muscles contract too far, joints open by millimetres).
class QuickStepper final : public Stepper {
 public:
  /// `iteration_count` sweeps per step; the order of rows is drawn from ODE's generator, which is seeded here.
  QuickStepper(dWorldID world, int iteration_count, unsigned long seed);
  void step(double h_s) override;
  std::string name() const override { return "quick"; }

 private:
  dWorldID world_;
  unsigned long random_state_;
};

}  // namespace musclesim
