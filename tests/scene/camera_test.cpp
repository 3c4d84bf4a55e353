#include "simulation/scene/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace musclesim {
namespace {

/// Image coordinates of a point: x to the right and y up, -1 .. 1 inside the picture.
Eigen::Vector2f seen(const Camera& camera, const Eigen::Vector3f& point) {
  const Eigen::Vector4f clip = camera.projection(1) * camera.view() * point.homogeneous();
  return clip.head<2>() / clip.w();
}

TEST(Camera, LooksAtItsCentreWithYUp) {
  const Camera camera{{10, 20, 30}, 40, 15, 500};
  EXPECT_LT(seen(camera, camera.center_mm).norm(), 1e-4);
  EXPECT_GT(seen(camera, camera.center_mm + Eigen::Vector3f(0, 50, 0)).y(), 0.05);
  EXPECT_NEAR(seen(camera, camera.center_mm + Eigen::Vector3f(0, 50, 0)).x(), 0, 1e-4);
  EXPECT_NEAR((camera.eyeMm() - camera.center_mm).norm(), 500, 1e-2);
}

TEST(Camera, PointUnderAPixelIsSeenThere) {
  const Camera camera{{10, 20, 30}, 40, 15, 500};
  const Eigen::Vector3f through(60, -20, 10);
  const Eigen::Vector2f pixel(500, 120);
  const Eigen::Vector3f point = camera.pointUnder(pixel, through, 640, 480);
  EXPECT_LT((*camera.pixelOf(point, 640, 480) - pixel).norm(), 1e-2);
  EXPECT_NEAR((point - through).dot((camera.eyeMm() - camera.center_mm).normalized()), 0, 1e-2) << "in the plane through the other point";
}

TEST(Camera, AzimuthZeroLooksAlongMinusZ) {
  const Camera camera{{0, 0, 0}, 0, 0, 100};
  EXPECT_LT((camera.eyeMm() - Eigen::Vector3f(0, 0, 100)).norm(), 1e-3);
  EXPECT_GT(seen(camera, {10, 0, 0}).x(), 0.1);
}

TEST(Camera, DraggingToTheRightTurnsTheSceneToTheRight) {
  Camera camera{{0, 0, 0}, 0, 0, 1000};
  const Eigen::Vector3f near_point(0, 0, 100);
  camera.rotate(50, 0);
  EXPECT_GT(seen(camera, near_point).x(), 0.01);
}

TEST(Camera, ElevationAndDistanceStayInRange) {
  Camera camera;
  camera.rotate(0, 1e6F);
  EXPECT_FLOAT_EQ(camera.elevation_deg, 89);
  camera.zoom(1e9F);
  EXPECT_FLOAT_EQ(camera.distance_mm, 50);
  camera.zoom(1e-9F);
  EXPECT_FLOAT_EQ(camera.distance_mm, 20000);
}

TEST(Camera, PanMovesTheSceneWithTheMouse) {
  Camera camera{{0, 0, 0}, 30, 20, 1000};
  camera.pan(100, 50, 500);  // of a picture of 500 x 500 pixels: 0.4 to the right, 0.2 down
  const Eigen::Vector2f place = seen(camera, {0, 0, 0});
  EXPECT_NEAR(place.x(), 0.4, 1e-3);
  EXPECT_NEAR(place.y(), -0.2, 1e-3);
}

TEST(Camera, FramingShowsAllCorners) {
  const Eigen::Vector3f low(-10, -300, -20), high(40, 100, 200);
  const Camera camera = Camera::framing(low, high);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f point(corner & 1 ? low.x() : high.x(), corner & 2 ? low.y() : high.y(), corner & 4 ? low.z() : high.z());
    EXPECT_LT(seen(camera, point).cwiseAbs().maxCoeff(), 1);
  }
}

}  // namespace
}  // namespace musclesim
