#include "musclesim/robot/muscle.h"

#include <algorithm>
#include <cmath>

namespace musclesim {

Vector bezierPoint(const Vector& start, const Vector& start_control, const Vector& end_control, const Vector& end, double t) {
  auto between = [t](const Vector& from, const Vector& to) -> Vector { return (1 - t) * from + t * to; };
  const Vector middle = between(start_control, end_control);
  const Vector first = between(between(start, start_control), middle);
  const Vector second = between(middle, between(end_control, end));
  return between(first, second);
}

namespace {

double shortestLinkMm(dWorldID world) {
  return 2 * MuscleSettings(World::of(world).parameters()).bead_radius_mm;
}

int linkCount(dWorldID world, double minimum_length_mm) {
  return std::max(2, static_cast<int>(std::lround(std::clamp(minimum_length_mm / shortestLinkMm(world), 0.0, 1e4))));
}

bool isLine(dWorldID world, MuscleModel model) {
  return MuscleSettings(World::of(world).parameters(), model).line;
}

std::vector<Vector> pointsAlong(const Vector& start, const Vector& start_control, const Vector& end_control, const Vector& end, int count) {
  std::vector<Vector> points;
  for (int i = 0; i <= count; ++i) points.push_back(bezierPoint(start, start_control, end_control, end, static_cast<double>(i) / count));
  return points;
}

}  // namespace

Muscle::Muscle(dWorldID world, dSpaceID space, const Vector& start, const Vector& start_control, const Vector& end_control,
               const Vector& end, double minimum_length, double maximum_length, MuscleModel model)
    : Actuator(world, space, pointsAlong(start, start_control, end_control, end, linkCount(world, minimum_length)), minimum_length,
               isLine(world, model) ? minimum_length : linkCount(world, minimum_length) * shortestLinkMm(world), maximum_length, model) {}

}  // namespace musclesim
