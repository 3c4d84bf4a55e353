/// Rows of one joint, exactly as ODE's dWorldStep makes them.
///
/// A row requires J1 (v1, w1) + J2 (v2, w2) + cfm l = c of the two bodies' velocities after the step; l is the force along the row. Rows
/// 0..4 of a slider or a hinge always hold. Row 5, along the joint's own axis, exists only with a motor (dry friction) or at a stop, and
/// its force is bounded.
#pragma once

#include <ode/ode.h>

#include "body_state.h"
#include "musclesim/robot/joint.h"

namespace musclesim::chain {

/// Motor and stops of a slider along its axis or of a hinge about its axis, in ODE's units.
struct AxisLimits {
  double low_stop = -dInfinity, high_stop = dInfinity;
  double motor_force = 0;     ///< largest force that the motor uses to hold motor_velocity
  double motor_velocity = 0;  ///< rad/s or mm/s
  double fudge_ratio = 1;     ///< share of the motor's force used when it pulls away from a stop
  double bounce_ratio = 0;
  double motor_softness = 0;  ///< ODE's CFM of the row without a stop
  double stop_softness = 0;   ///< ODE's CFM at a stop
  double stop_reduction = 0;  ///< ODE's ERP at a stop when the joint was registered
};

/// What the bounded row represents in this step.
enum class AxisContact : signed char { none, motor, low_stop, high_stop, locked };

/// A joint as the stepper stores it: its bodies as indices (-1: the environment), its reference pose and its parameters.
struct JointModel {
  const Joint* joint = nullptr;
  Joint::Kind kind = Joint::Kind::ball;
  int body[2] = {-1, -1};
  JointReference reference;
  Vector separation =
      Vector::Zero();  ///< position of the second body relative to the first when the joint was made, in the first's frame, mm
  AxisLimits limits;
  double reduction = 0;  ///< ODE's ERP of the position rows when the joint was registered
  double softness = 0;   ///< ODE's CFM of the position rows

  /// readLimits() reads the stops and the motor's force from ODE, readMotor() only the force. Both may have changed since the last step.
  void readLimits();
  void readMotor();
  /// Reads everything that ODE stores about the axis of a slider or hinge, including the limits.
  void readAxis();
  /// Number of position rows: 3 for a ball, 5 for slider and hinge, 6 for a fixed joint.
  int positionRowCount() const;
};

/// Registers a joint whose bodies are in `bodies`. Reads all parameters from ODE.
JointModel registerJoint(const Joint& joint, const BodyState& bodies);

/// Share of a position error that is corrected in a step of the present length.
struct ErrorReduction {
  double registered;  ///< ODE's ERP of the world when the joints were registered
  double per_step;    ///< ERP that replaces it in this step
  /// A joint with an ERP of its own keeps that value.
  double of(double own) const { return own == registered ? per_step : own; }
  bool operator==(const ErrorReduction&) const = default;
};

struct JointRows {
  int row_count = 0;                        ///< 3, 5 or 6; further rows are unused
  double jacobian[2][6][6] = {};            ///< [body][row][v, w]
  double velocity[6] = {};                  ///< c, mm/s or rad/s
  double softness[6] = {};                  ///< cfm, s/g or s/(g mm^2)
  AxisContact contact = AxisContact::none;  ///< what row 5 represents, for sliders and hinges
  double lower = 0, upper = 0;              ///< bounds of row 5's force
  double constant_force = 0;                ///< additional force along row 5 from a motor that presses into a stop
};

/// Makes the joint's rows for the present state. `rows` must be new or come from an earlier call for a joint of the same kind.
void makeRows(const JointModel& joint, const BodyState& bodies, double h_s, const ErrorReduction& reduction, JointRows& rows);

/// Constraint error of the joint in mm: like Joint::constraintErrorMm(), but from the stepper's own state.
double gapOf(const JointModel& joint, const BodyState& bodies);

}  // namespace musclesim::chain
