/// Steppers move all bodies of a world by one internal step.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <string>

namespace musclesim {

enum class StepperKind { automatic, chain, ode, quick };

/// "auto", "chain", "ode" or "quick". Throws BadParameter for any other name.
StepperKind stepperFromName(const std::string& name);

class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Moves the bodies by h_s seconds under the forces accumulated so far, the joints and the contacts.
  virtual void step(double h_s) = 0;
  virtual std::string name() const = 0;
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
