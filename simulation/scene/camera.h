/// The camera of a scene.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace musclesim {

/// Looks at a centre from a point on a sphere around it; y is up.
struct Camera {
  Eigen::Vector3f center_mm{-150, 40, 0};
  float azimuth_deg = -60;   ///< about the vertical; 0 looks along -z, growing to the right
  float elevation_deg = 8;   ///< above the horizontal, -89 .. 89
  float distance_mm = 1100;  ///< 50 .. 20000

  static constexpr float field_of_view_deg = 45;  ///< vertical

  /// Rotates by a drag of the mouse, in pixels.
  void rotate(float right_px, float down_px);
  /// A factor above 1 moves nearer, below 1 farther.
  void zoom(float factor);
  /// Moves the centre in the plane of the picture.
  void pan(float right_px, float down_px, float picture_height_px);

  /// The place of a world point in a picture, in pixels from the upper left corner; none if the point is behind the eye.
  std::optional<Eigen::Vector2f> pixelOf(const Eigen::Vector3f& point_mm, float width_px, float height_px) const;

  /// The world point under a pixel, in the plane through `through_mm` parallel to the picture.
  Eigen::Vector3f pointUnder(const Eigen::Vector2f& pixel, const Eigen::Vector3f& through_mm, float width_px, float height_px) const;

  Eigen::Vector3f eyeMm() const;
  Eigen::Matrix4f view() const;
  Eigen::Matrix4f projection(float aspect_ratio) const;

  /// Whether a whole box is in a picture.
  bool shows(const Eigen::Vector3f& low_mm, const Eigen::Vector3f& high_mm, float width_px, float height_px) const;

  /// Moves so that a whole box is visible with a margin.
  static Camera framing(const Eigen::Vector3f& low_mm, const Eigen::Vector3f& high_mm);
};

}  // namespace musclesim
