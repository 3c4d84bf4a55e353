#include "simulation/display/grab.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace musclesim {
namespace {

using V = Eigen::Vector3f;

Eigen::Matrix4f standingAt(const V& place, const Eigen::Matrix3f& turn = Eigen::Matrix3f::Identity()) {
  Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();
  pose.topLeftCorner<3, 3>() = turn;
  pose.topRightCorner<3, 1>() = place;
  return pose;
}

/// A box, a lying capsule and a drum, side by side, and a target behind the box.
Snapshot scene() {
  const Eigen::Matrix3f lying = Eigen::AngleAxisf(static_cast<float>(EIGEN_PI) / 2, V::UnitY()).toRotationMatrix();
  Snapshot snapshot;
  snapshot.parts = {{Shape::Kind::box, {40, 20, 60}, standingAt({0, 0, 0}), {}, 5},
                    {Shape::Kind::capped_cylinder, {10, 100, 0}, standingAt({200, 0, 0}, lying), {}, 6},
                    {Shape::Kind::sphere, {25, 0, 0}, standingAt({0, 200, 0}), {}, 7},
                    {Shape::Kind::cylinder, {30, 30, 0}, standingAt({0, -200, 0}), {}, -1}};
  snapshot.target = DrawnTarget{{0, 0, -300}, false};
  return snapshot;
}

std::optional<Grab> ahead(float x, float y) {
  return grabAt(scene(), {x, y, 1000}, {x, y, 0});
}

TEST(Grab, TakesWhatTheRayMeetsFirst) {
  const auto box = ahead(5, -3);
  ASSERT_TRUE(box);
  EXPECT_EQ(box->primitive, 5);
  EXPECT_LT((box->seen_mm - V(5, -3, 30)).norm(), 0.3F) << "its front";
  EXPECT_LT((box->point_mm - V(5, -3, 30)).norm(), 0.3F);
  const auto capsule = ahead(255, 0);
  ASSERT_TRUE(capsule) << "its cap";
  EXPECT_EQ(capsule->primitive, 6);
  EXPECT_LT((capsule->point_mm - V(-std::sqrt(75.0F), 0, 55)).norm(), 0.5F) << "in its own frame";
  EXPECT_EQ(ahead(0, 220)->primitive, 7);
}

TEST(Grab, TakesTheTargetWhereNothingHidesIt) {
  const auto target = grabAt(scene(), {0, 25, 1000}, {0, 25, 0});
  ASSERT_TRUE(target);
  EXPECT_EQ(target->primitive, -1);
  EXPECT_EQ(target->point_mm, V(0, 0, -300));
}

TEST(Grab, TakesNothingBeside) {
  EXPECT_FALSE(ahead(262, 0));
  EXPECT_FALSE(ahead(0, 226));
  EXPECT_FALSE(ahead(0, -200)) << "a pulley is no bone";
}

}  // namespace
}  // namespace musclesim
