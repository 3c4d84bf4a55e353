#include "camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "musclesim/base/units.h"

namespace musclesim {

namespace {

constexpr float degrees_per_pixel = 0.4F, steepest_deg = 89;
constexpr float nearest_mm = 50, farthest_mm = 20000;
constexpr auto rad = static_cast<float>(rad_per_deg);

}  // namespace

void Camera::rotate(float right_px, float down_px) {
  azimuth_deg = std::remainder(azimuth_deg - degrees_per_pixel * right_px, 360.0F);
  elevation_deg = std::clamp(elevation_deg + degrees_per_pixel * down_px, -steepest_deg, steepest_deg);
}

void Camera::zoom(float factor) {
  distance_mm = std::clamp(distance_mm / factor, nearest_mm, farthest_mm);
}

void Camera::pan(float right_px, float down_px, float picture_height_px) {
  const float mm_per_px = 2 * distance_mm * std::tan(field_of_view_deg / 2 * rad) / picture_height_px;
  const Eigen::Matrix4f axes = view();
  center_mm += mm_per_px * (down_px * axes.block<1, 3>(1, 0) - right_px * axes.block<1, 3>(0, 0)).transpose();
}

std::optional<Eigen::Vector2f> Camera::pixelOf(const Eigen::Vector3f& point_mm, float width_px, float height_px) const {
  const Eigen::Vector4f clip = projection(width_px / height_px) * view() * point_mm.homogeneous();
  if (clip.w() <= 0) return std::nullopt;
  return Eigen::Vector2f((clip.x() / clip.w() + 1) / 2 * width_px, (1 - clip.y() / clip.w()) / 2 * height_px);
}

Eigen::Vector3f Camera::pointUnder(const Eigen::Vector2f& pixel, const Eigen::Vector3f& through_mm, float width_px, float height_px) const {
  const Eigen::Matrix4f axes = view();
  const float depth_mm = -(axes * through_mm.homogeneous()).z();
  const float half_mm = depth_mm * std::tan(field_of_view_deg / 2 * rad), mm_per_px = 2 * half_mm / height_px;
  const Eigen::Vector3f seen((pixel.x() - width_px / 2) * mm_per_px, (height_px / 2 - pixel.y()) * mm_per_px, -depth_mm);
  return eyeMm() + axes.topLeftCorner<3, 3>().transpose() * seen;
}

Eigen::Vector3f Camera::eyeMm() const {
  const float a = azimuth_deg * rad, e = elevation_deg * rad;
  return center_mm + distance_mm * Eigen::Vector3f(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a));
}

Eigen::Matrix4f Camera::view() const {
  const Eigen::Vector3f eye = eyeMm();
  const Eigen::Vector3f back = (eye - center_mm).normalized();
  const Eigen::Vector3f right = Eigen::Vector3f::UnitY().cross(back).normalized();
  Eigen::Matrix4f view = Eigen::Matrix4f::Identity();
  view.block<1, 3>(0, 0) = right.transpose();
  view.block<1, 3>(1, 0) = back.cross(right).transpose();
  view.block<1, 3>(2, 0) = back.transpose();
  view.topRightCorner<3, 1>() = -view.topLeftCorner<3, 3>() * eye;
  return view;
}

Eigen::Matrix4f Camera::projection(float aspect_ratio) const {
  const float f = 1 / std::tan(field_of_view_deg / 2 * rad);
  const float z_near = distance_mm / 50, z_far = distance_mm * 10 + 5000;
  Eigen::Matrix4f p = Eigen::Matrix4f::Zero();
  p(0, 0) = f / aspect_ratio;
  p(1, 1) = f;
  p(2, 2) = (z_far + z_near) / (z_near - z_far);
  p(2, 3) = 2 * z_far * z_near / (z_near - z_far);
  p(3, 2) = -1;
  return p;
}

bool Camera::shows(const Eigen::Vector3f& low_mm, const Eigen::Vector3f& high_mm, float width_px, float height_px) const {
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f point(corner & 1 ? low_mm.x() : high_mm.x(), corner & 2 ? low_mm.y() : high_mm.y(),
                                corner & 4 ? low_mm.z() : high_mm.z());
    const auto at = pixelOf(point, width_px, height_px);
    if (!at || at->x() < 0 || at->y() < 0 || at->x() > width_px || at->y() > height_px) return false;
  }
  return true;
}

Camera Camera::framing(const Eigen::Vector3f& low_mm, const Eigen::Vector3f& high_mm) {
  constexpr float room_ratio = 1.15F;
  Camera camera;
  camera.center_mm = (low_mm + high_mm) / 2;
  camera.distance_mm = room_ratio * (high_mm - low_mm).norm() / 2 / std::sin(field_of_view_deg / 2 * rad);
  return camera;
}

}  // namespace musclesim
