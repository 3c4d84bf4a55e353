/// The path of a massless muscle: a taut thread from its start over via points and pulleys to its end.
#pragma once

#include <ode/ode.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/robot/pulley.h"
#include "musclesim/robot/state.h"

namespace musclesim {

class Primitive;
struct MuscleSettings;
struct PhysicsSettings;

/// A taut thread from a start over via points to an end, past at most one pulley between two of them. Points and pulleys are fixed to
/// bodies or to the environment.
///
///     l = sum l_i - l_t,   force on point i: f (d_i - e_i-1),   force and torque on pulley i: the opposite of those on both of its points
/// l_i length of the way from point i to point i + 1 (Way), d_i and e_i its directions at point i and at point i + 1 (equal if it is
/// straight), l_t the tendon, an inextensible cable in series, f the force of the thread. All forces sum to zero, and so do all torques:
/// the way between two points does not change if both and their pulley move as one. So a pulley's forces are those at its two tangent
/// points.
class LineOfPull {
 public:
  enum class End { start, end };

  LineOfPull(const Vector& start_mm, const Vector& end_mm);

  /// Fixes an end to a primitive's body (null: the environment). Throws BadParameter if it is already connected.
  void connect(End end, Primitive* primitive, const std::string& muscle_name);
  void addViaPoint(Primitive* primitive, const Vector& point_mm);
  /// Between the point added last and the next one. The axis need not have unit length. Throws BadParameter unless all numbers are finite,
  /// the radius is positive, the side point lies outside, and there is no pulley since the point added last.
  void addPulley(Primitive* primitive, Pulley pulley, const std::string& muscle_name);
  /// Throws BadParameter unless it is finite and at least 0.
  void setTendonMm(double tendon_mm, const std::string& muscle_name);
  double tendonMm() const { return tendon_mm_; }
  /// Throws BadParameter for a point inside of the pulley next to it.
  void requirePointsOutside(const std::string& muscle_name) const;
  /// Whether both ends are connected; if not, the thread carries no force.
  bool isConnected() const { return points_.front().connected && points_.back().connected; }

  /// Says that a body's centre of mass has moved to another point of the body, given from the old one in the body's frame.
  void moveCenter(dBodyID body, const Vector& shift_mm);

  /// Length of the muscle: that of the path without the tendon.
  double lengthMm() const;
  /// Start, via points and end in the world frame, with points on each pulley where the thread lies on it.
  std::vector<Vector> pointsMm() const;

  struct Point {
    dBodyID body = nullptr;  ///< null: the environment
    Vector place;            ///< position in the body's frame, from its centre of mass, or in the world frame, mm
    bool connected = false;
  };
  /// A pulley in the frame of a body (null: the environment), from its centre of mass.
  struct MountedPulley {
    dBodyID body;
    Pulley pulley;
  };
  /// Start, via points and end.
  const std::vector<Point>& points() const { return points_; }
  /// The pulley between each point and the next one; none where the way is straight.
  const std::vector<std::optional<MountedPulley>>& mountedPulleys() const { return pulleys_; }

  /// The pulleys in the world frame, for drawing.
  std::vector<Pulley> pulleys() const;

  /// Adds the forces of the thread to the bodies, which must not have moved since the last lengthMm(). The thread's force in N is the
  /// tension plus friction and a stop:
  ///     F + F_f tanh(v / v_0) + k max(0, l - l_max),   dry friction; F_f v / v_1 in place of the second term, viscous friction
  /// v = dl/dt, F_f the friction of a slider (in a chain all sliders are in series and carry the same force), v_0 = 100 mm/s, v_1 the speed
  /// at which dry and viscous friction are equal, k = 10 N/mm. A thread with a loose end carries no force.
  void pull(double tension_N, double maximum_length_mm, const MuscleSettings& settings, const PhysicsSettings& physics) const;

  /// Effect of a unit force on a body: dl/dx of a point or a pulley on it, as force and torque about its centre of mass in the world frame.
  struct Push {
    dBodyID body;
    Vector force, torque;
  };
  /// One entry per point that is fixed to a body, and one per pulley that is fixed to a body and carries the thread.
  std::vector<Push> pushes() const;
  /// F_f tanh(v / v_0) or F_f v / v_1, the friction in N at a speed in mm/s of true time.
  static double frictionN(double speed_mm_per_s, const MuscleSettings& settings);
  /// k max(0, l - l_max), the force of the stop in N.
  static double stopN(double length_mm, double maximum_length_mm);
  /// stiffnessNPerMm: d(force)/dl at the longest length in N/mm, including the stop's spring. dampingNsPerMm: d(force)/d(speed) at rest, in
  /// N s/mm of true time.
  static double stiffnessNPerMm(double of_tension_N_per_mm);
  static double dampingNsPerMm(const MuscleSettings& settings);

 private:
  /// Where a body was when the thread was located last; a pose that is not a number is unlike any other.
  struct Pose {
    dBodyID body;
    std::array<dReal, 3> position_mm;
    std::array<dReal, 4> quaternion;
  };
  static Point pointOn(Primitive* primitive, const Vector& point_mm);
  static Vector worldPosition(const Point& point);
  static Pulley inWorld(const MountedPulley& mounted);
  /// Updates pushes_ and length_mm_ from the bodies' present poses; speed() and pull() use them. If no body has moved they stay.
  void locate() const;
  /// Whether a body has moved since this was asked last.
  bool haveBodiesMoved() const;
  /// To be called after a change of the points or pulleys.
  void forgetPoses();
  void addPush(dBodyID body, const Vector& position, const Vector& gradient) const;
  /// dl/dt in world units; positive while the thread gets longer.
  double speed() const;
  double totalForceN(double tension_N, double maximum_length_mm, const MuscleSettings& settings, const PhysicsSettings& physics) const;

  std::vector<Point> points_;
  std::vector<std::optional<MountedPulley>> pulleys_;  ///< between each point and the next
  double tendon_mm_ = 0;
  mutable std::vector<Pose> poses_;  ///< of all bodies of the points and pulleys
  mutable bool is_located_ = false;
  mutable std::vector<Push> pushes_;
  mutable double length_mm_ = 0;
};

}  // namespace musclesim
