/// The path of a massless muscle: straight lines from its start over its via points to its end.
#pragma once

#include <ode/ode.h>

#include <string>
#include <vector>

#include "musclesim/robot/state.h"

namespace musclesim {

class Primitive;
struct MuscleSettings;
struct PhysicsSettings;

/// A taut thread from a start over via points to an end. Every point is fixed to a body or to the environment.
///
///     l = sum |x_i+1 - x_i|,   force on point i: f (d_i - d_i-1),   d_i = (x_i+1 - x_i) / |x_i+1 - x_i|
/// x points in mm, d directions, f the force of the thread. The forces on all points sum to zero.
class LineOfPull {
 public:
  enum class End { start, end };

  LineOfPull(const Vector& start_mm, const Vector& end_mm);

  /// Fixes an end to a primitive's body (null: the environment). Throws BadParameter if it is already connected.
  void connect(End end, Primitive* primitive, const std::string& muscle_name);
  void addViaPoint(Primitive* primitive, const Vector& point_mm);
  /// Keeps the points on a body in place when its centre of mass has been moved by a vector in its frame, mm.
  void recentre(dBodyID body, const Vector& by_mm);
  /// Whether both ends are connected; if not, the thread carries no force.
  bool isConnected() const { return points_.front().connected && points_.back().connected; }

  double lengthMm() const;
  /// Start, via points and end in the world frame.
  std::vector<Vector> pointsMm() const;

  /// Adds the forces of the thread to the bodies, which must not have moved since the last lengthMm(). The thread's force in N is the
  /// tension plus friction and a stop:
  ///     F + F_f tanh(v / v_0) + k max(0, l - l_max),   dry friction; F_f v / v_1 in place of the second term, viscous friction
  /// v = dl/dt, F_f the friction of a slider (in a chain all sliders are in series and carry the same force), v_0 = 100 mm/s, v_1 the speed
  /// at which dry and viscous friction are equal, k = 10 N/mm. A thread with a loose end carries no force.
  void pull(double tension_N, double maximum_length_mm, const MuscleSettings& settings, const PhysicsSettings& physics) const;

  /// Effect of a unit force on a body: dl/dx summed over all points on it, as force and torque about its centre of mass in the world frame.
  struct Push {
    dBodyID body;
    Vector force, torque;
  };
  /// One entry per point that is fixed to a body.
  std::vector<Push> pushes() const;
  /// k max(0, l - l_max), the force of the stop in N.
  static double stopN(double length_mm, double maximum_length_mm);
  /// stiffnessNPerMm: d(force)/dl at the longest length in N/mm, including the stop's spring. dampingNsPerMm: d(force)/d(speed) at rest, in
  /// N s/mm of true time.
  static double stiffnessNPerMm(double of_tension_N_per_mm);
  static double dampingNsPerMm(const MuscleSettings& settings);

 private:
  struct Point {
    dBodyID body = nullptr;  ///< null: the environment
    Vector place;            ///< position in the body's frame, from its centre of mass, or in the world frame, mm
    bool connected = false;
  };
  /// A point in the world frame.
  struct Located {
    Vector arm;  ///< from its body's centre of mass, mm
    Vector position;
    Vector gradient;  ///< d l / d x
  };
  static Point pointOn(Primitive* primitive, const Vector& point_mm);
  /// Updates located_ and length_mm_ from the bodies' present poses; speed() and pull() use them.
  void locate() const;
  /// dl/dt in world units; positive while the thread gets longer.
  double speed() const;
  double totalForceN(double tension_N, double maximum_length_mm, const MuscleSettings& settings, const PhysicsSettings& physics) const;

  std::vector<Point> points_;
  mutable std::vector<Located> located_;
  mutable double length_mm_ = 0;
};

}  // namespace musclesim
