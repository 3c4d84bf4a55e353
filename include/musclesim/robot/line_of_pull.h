/// The straight path of a massless muscle, through via points if it has any.
#pragma once

#include <ode/ode.h>

#include <string>
#include <vector>

#include "musclesim/robot/state.h"

namespace musclesim {

class Primitive;
struct MuscleSettings;
struct PhysicsSettings;

/// A taut thread from a start over via points to an end; every point is fixed to a body or to the environment.
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

  double lengthMm() const;
  /// Start, via points, end in the world's frame.
  std::vector<Vector> pointsMm() const;

  /// Adds the forces of the thread to the bodies, which have not moved since lengthMm() was asked for. It pulls with tension and what
  /// resists beside it, in N:
  ///     F + F_f tanh(v / v_0) + k max(0, l - l_max),   dry friction; F_f v / v_1 in place of the second term, viscous friction
  /// v = dl/dt, F_f a slider's friction (in a chain all sliders are in series and carry the same force), v_0 = 100 mm/s, v_1 the speed at
  /// which both are equal, k = 10 N/mm. A thread with a loose end carries nothing.
  void pull(double tension_N, double maximum_length_mm, const MuscleSettings& settings, const PhysicsSettings& physics) const;

  /// What a force of 1 does to a body: dl/dx of all points on it, as force and torque about its centre of mass in the world's frame.
  struct Push {
    dBodyID body;
    Vector force, torque;
  };
  /// One per point that is fixed to a body.
  std::vector<Push> pushes() const;
  /// d(force)/dl at the longest length in N/mm, the stop's spring included, and d(force)/d(speed) at rest in N s/mm of true time.
  static double stiffnessNPerMm(double of_tension_N_per_mm);
  static double dampingNsPerMm(const MuscleSettings& settings);

 private:
  struct Point {
    dBodyID body = nullptr;  ///< null: the environment
    Vector place;            ///< in the body's frame, from its centre of mass, or in the world, mm
    bool connected = false;
  };
  /// A point in the world's frame.
  struct Located {
    Vector arm;  ///< from its body's centre of mass, mm
    Vector position;
    Vector gradient;  ///< d l / d x
  };
  static Point pointOn(Primitive* primitive, const Vector& point_mm);
  /// Works out what follows from the bodies' present poses; what is below uses it.
  void locate() const;
  /// dl/dt in world units, positive when it gets longer.
  double speed() const;
  double totalForceN(double tension_N, double maximum_length_mm, const MuscleSettings& settings, const PhysicsSettings& physics) const;

  std::vector<Point> points_;
  mutable std::vector<Located> located_;
  mutable double length_mm_ = 0;
};

}  // namespace musclesim
