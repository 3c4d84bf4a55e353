#include "simulation/scene/mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace musclesim {
namespace {

using V = Eigen::Vector3f;

/// Six times the volume inside a closed surface; positive if all triangles are counter-clockwise as seen from outside.
float enclosed(const Mesh& mesh) {
  float sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const V &a = mesh.vertices[mesh.indices[i]].position, &b = mesh.vertices[mesh.indices[i + 1]].position,
            &c = mesh.vertices[mesh.indices[i + 2]].position;
    sum += a.dot(b.cross(c));
  }
  return sum / 6;
}

void expectNormalsOutwards(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vertex &a = mesh.vertices[mesh.indices[i]], &b = mesh.vertices[mesh.indices[i + 1]], &c = mesh.vertices[mesh.indices[i + 2]];
    const V face = (b.position - a.position).cross(c.position - a.position);
    if (face.norm() < 1e-8F) continue;  // at the poles
    for (const Vertex& vertex : {a, b, c}) {
      EXPECT_NEAR(vertex.normal.norm(), 1, 1e-4);
      EXPECT_GT(vertex.normal.dot(face), 0);
    }
  }
}

TEST(Mesh, BoxEnclosesItsVolume) {
  EXPECT_NEAR(enclosed(boxMesh()), 1, 1e-5);
  expectNormalsOutwards(boxMesh());
}

TEST(Mesh, SphereEnclosesNearlyItsVolume) {
  EXPECT_NEAR(enclosed(sphereMesh(16)) / (4.0 / 3 * std::numbers::pi), 1, 0.03);
  expectNormalsOutwards(sphereMesh(16));
}

TEST(Mesh, TurnedBodyFacesOutwardsAndEnclosesNearlyItsVolume) {
  const Mesh cone = turnedMesh({{0, 0}, {1, 0}, {0, 1}});
  expectNormalsOutwards(cone);
  EXPECT_NEAR(enclosed(cone) / (std::numbers::pi / 3), 1, 0.04);
}

TEST(Mesh, TubeKeepsItsRadiusAroundBends) {
  const std::vector<V> curve = smoothCurve({{0, 0, 0}, {0, 20, 0}, {10, 35, 0}, {30, 40, 5}, {60, 40, 20}});
  const Mesh tube = tubeMesh(curve, 3);
  expectNormalsOutwards(tube);
  for (const Vertex& vertex : tube.vertices) {
    float nearest = 1e9F;
    for (const V& point : curve) nearest = std::min(nearest, (vertex.position - point).norm());
    EXPECT_NEAR(nearest, 3, 0.05);
  }
}

TEST(Mesh, TubeOfNoLengthIsEmpty) {
  EXPECT_TRUE(tubeMesh({{1, 2, 3}, {1, 2, 3}}, 5).indices.empty());
}

TEST(SmoothCurve, BeginsAndEndsAtItsPointsAndStaysOnALine) {
  const std::vector<V> curve = smoothCurve({{0, 0, 0}, {0, 10, 0}, {0, 15, 0}, {0, 40, 0}});
  EXPECT_LT(curve.front().norm(), 1e-5);
  EXPECT_LT((curve.back() - V(0, 40, 0)).norm(), 1e-5);
  float before = -1;
  for (const V& point : curve) {
    EXPECT_NEAR(point.x(), 0, 1e-5);
    EXPECT_GT(point.y(), before);
    before = point.y();
  }
}

}  // namespace
}  // namespace musclesim
