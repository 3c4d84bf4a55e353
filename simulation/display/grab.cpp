#include "grab.h"

#include <algorithm>

#include "simulation/scene/scene.h"

namespace musclesim {

namespace {

using V = Eigen::Vector3f;

/// Distance of a point from the surface of a part, in the part's frame; negative inside.
float distanceMm(const DrawnPart& part, const V& point) {
  const float radius = part.size_mm.x(), half_length = part.size_mm.y() / 2;
  switch (part.kind) {
    case Shape::Kind::sphere:
      return point.norm() - radius;
    case Shape::Kind::box: {
      const V outside = point.cwiseAbs() - part.size_mm / 2;
      return outside.cwiseMax(0).norm() + std::min(0.0F, outside.maxCoeff());
    }
    case Shape::Kind::capped_cylinder:
      return (point - V(0, 0, std::clamp(point.z(), -half_length, half_length))).norm() - radius;
    case Shape::Kind::cylinder: {
      const Eigen::Vector2f outside(point.head<2>().norm() - radius, std::abs(point.z()) - half_length);
      return outside.cwiseMax(0).norm() + std::min(0.0F, outside.maxCoeff());
    }
  }
  return 0;
}

V inFrameOf(const DrawnPart& part, const V& point) {
  return part.pose.topLeftCorner<3, 3>().transpose() * (point - part.pose.topRightCorner<3, 1>());
}

}  // namespace

/// Walks along the ray: nothing is nearer than the smallest distance, so that far it may go.
std::optional<Grab> grabAt(const Snapshot& snapshot, const V& eye_mm, const V& through_mm) {
  constexpr float touching_mm = 0.2F, farthest_mm = 20000;
  constexpr int most_steps = 400;
  const V along = (through_mm - eye_mm).normalized();
  float gone_mm = 0;
  for (int step = 0; step < most_steps && gone_mm < farthest_mm; ++step) {
    const V here = eye_mm + gone_mm * along;
    float nearest_mm = farthest_mm;
    if (snapshot.target) nearest_mm = (here - snapshot.target->point_mm).norm() - target_radius_mm;
    if (nearest_mm < touching_mm) return Grab{-1, snapshot.target->point_mm, snapshot.target->point_mm};
    for (const DrawnPart& part : snapshot.parts) {
      if (part.primitive < 0) continue;
      const V point = inFrameOf(part, here);
      const float distance_mm = distanceMm(part, point);
      if (distance_mm < touching_mm) return Grab{part.primitive, point, here};
      nearest_mm = std::min(nearest_mm, distance_mm);
    }
    gone_mm += nearest_mm;
  }
  return std::nullopt;
}

}  // namespace musclesim
