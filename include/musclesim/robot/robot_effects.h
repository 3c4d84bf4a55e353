/// What effects change about a robot, as the robot sees it.
#pragma once

#include "musclesim/robot/state.h"

namespace musclesim {

class Primitive;

/// The end of a muscle, in the order in which a muscle is built.
enum class MuscleEnd { start, end };

/// Force and torque about the centre of mass.
struct BodyLoad {
  Vector force_N = Vector::Zero(), torque_Nmm = Vector::Zero();
};

/// The simulation connects an implementation (EffectChain) to the world before it builds the robot.
class RobotEffects {
 public:
  virtual ~RobotEffects() = default;

  /// Displacement of an end of a muscle from its place, mm. `lever`: unit vector along the end's lever arm. Asked while the robot is built.
  virtual Vector mountOffsetMm(int muscle, MuscleEnd end, const Vector& lever) const = 0;
  /// Makes pressures and tensions of the commands as they are now. No state moves on.
  virtual void update() = 0;
  /// Makes readings of the true state.
  virtual void read(State& state) = 0;

  // For robots at rest.
  /// Tension of a muscle that has had this length and the present pressure for ever, N.
  virtual double restingTensionN(int muscle, double length_mm) = 0;
  /// Loads on the body of a primitive that does not move.
  virtual BodyLoad restingLoad(const Primitive& primitive) = 0;
};

}  // namespace musclesim
