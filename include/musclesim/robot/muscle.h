/// A pneumatic artificial muscle: a chain of links along a Bezier curve.
#pragma once

#include <string>

#include "musclesim/robot/actuator.h"
#include "musclesim/robot/primitive.h"

namespace musclesim {

/// Point on the cubic Bezier curve with the four control points at t in 0..1, by de Casteljau's construction.
Vector bezierPoint(const Vector& start, const Vector& start_control, const Vector& end_control, const Vector& end, double t);

/// The number of links is round(minimum_length / (2 bead radii)), at least 2. The minimum length becomes the number of links times a bead's
/// diameter; a line muscle keeps the given one. Link i runs between the curve's points at t = i / n and (i + 1) / n, n the number of links.
/// Source: Braun 2007, Section 3.1.
class Muscle : public Actuator {
 public:
  /// Points in mm, world frame; lengths in mm. Throws BadParameter if the curve's chain is shorter than `minimum_length` or longer than
  /// `maximum_length`, or if a link is shorter than its two beads.
  Muscle(dWorldID world, dSpaceID space, const Vector& start, const Vector& start_control, const Vector& end_control, const Vector& end,
         double minimum_length, double maximum_length, MuscleModel model = MuscleModel::by_parameter);
};

/// A straight muscle by named fields, for Robot::addMuscle.
struct MuscleOptions {
  Attachment from = {}, to = {};
  struct Lengths {
    double minimum, maximum;
  } length_mm = {0, 0};
  std::string name = {};  ///< default: muscle_<number>
};

}  // namespace musclesim
