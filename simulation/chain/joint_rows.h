/// Rows of one joint, exactly as ODE's dWorldStep makes them.
///
/// A row demands  J1 (v1, w1) + J2 (v2, w2) + cfm l = c  of the two bodies' velocities after the step, l being the force along the row.
/// Rows 0..4 of a slider or a hinge always hold. Row 5, the joint's own axis, is there only with a motor (dry friction) or at a stop,
/// and its force is bounded.
#pragma once

#include <ode/ode.h>

#include "body_state.h"
#include "musclesim/robot/joint.h"

namespace musclesim::chain {

/// Motor and stops about or along the axis of a slider or a hinge, in ODE's units.
struct AxisLimits {
  double low_stop = -dInfinity, high_stop = dInfinity;
  double motor_force = 0;     ///< largest force of the motor that keeps the joint at motor_velocity
  double motor_velocity = 0;  ///< rad/s or mm/s
  double fudge_ratio = 1;     ///< share of the motor's force where it pulls away from a stop
  double bounce_ratio = 0;
  double motor_softness = 0;  ///< ODE's CFM of the row without a stop
  double stop_softness = 0;   ///< ODE's CFM at a stop
  double stop_reduction = 0;  ///< ODE's ERP at a stop as it was registered
};

/// What holds for the bounded row in this step.
enum class AxisContact : signed char { none, motor, low_stop, high_stop, locked };

/// A joint as the stepper sees it: bodies by number (-1: the environment), reference pose, parameters.
struct JointModel {
  const Joint* joint = nullptr;
  Joint::Kind kind = Joint::Kind::ball;
  int body[2] = {-1, -1};
  JointReference reference;
  Vector separation = Vector::Zero();  ///< second body seen from the first when the joint was made, in the first's frame, mm
  AxisLimits limits;
  double reduction = 0;  ///< ODE's ERP of the position rows as it was registered
  double softness = 0;   ///< ODE's CFM of the position rows

  /// Reads stops and the motor's force from ODE, or that force alone; they may have been changed since the last step.
  void readLimits();
  void readMotor();
  /// The same with all else that ODE keeps of a slider's or hinge's axis.
  void readAxis();
  /// Number of position rows: 3 for a ball, 5 for slider and hinge, 6 for a fixed joint.
  int positionRowCount() const;
};

/// Registers a joint whose bodies have numbers. Reads all parameters from ODE.
JointModel registerJoint(const Joint& joint, const BodyState& bodies);

/// Shares of position errors corrected in a step of the present length.
struct ErrorReduction {
  double registered;  ///< ODE's ERP of the world when the joints were registered
  double per_step;    ///< what takes its place in this step
  /// A joint that was given an ERP of its own keeps it.
  double of(double own) const { return own == registered ? per_step : own; }
  bool operator==(const ErrorReduction&) const = default;
};

struct JointRows {
  int row_count = 0;                        ///< 3, 5 or 6; rows beyond hold nothing
  double jacobian[2][6][6] = {};            ///< [body][row][v, w]
  double velocity[6] = {};                  ///< c, mm/s or rad/s
  double softness[6] = {};                  ///< cfm, s/g or s/(g mm^2)
  AxisContact contact = AxisContact::none;  ///< what row 5 is, for sliders and hinges
  double lower = 0, upper = 0;              ///< bounds of row 5's force
  double constant_force = 0;                ///< acts along row 5 besides: a motor that presses into a stop
};

/// Rows of the joint in the present state. `rows` must have been made for a joint of the same kind before, or be new.
void makeRows(const JointModel& joint, const BodyState& bodies, double h_s, const ErrorReduction& reduction, JointRows& rows);

/// Distance in mm by which the joint is torn, as Joint::gapMm() but from the stepper's own state.
double gapOf(const JointModel& joint, const BodyState& bodies);

}  // namespace musclesim::chain
