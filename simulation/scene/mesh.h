/// Surfaces of triangles with smooth normals.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace musclesim {

struct Vertex {
  Eigen::Vector3f position, normal;
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three per triangle, counter-clockwise seen from outside
};

/// Edges of 1 along x, y, z about the origin.
Mesh boxMesh();
/// Radius 1 about the origin; twice as many edges around as rings.
Mesh sphereMesh(std::uint32_t ring_count);
/// Turned about z: straight pieces between points (radius, z), z never falling; edges stay sharp.
Mesh turnedMesh(const std::vector<Eigen::Vector2f>& profile);
/// From -1 to 1 in x and z, at y = 0, facing up.
Mesh squareMesh();

/// A smooth curve led by points: a uniform cubic B-spline that begins and ends at the first and the last point.
std::vector<Eigen::Vector3f> smoothCurve(const std::vector<Eigen::Vector3f>& points);
/// A hose along a curve, without ends. Points that coincide are skipped.
Mesh tubeMesh(const std::vector<Eigen::Vector3f>& curve, float radius);

}  // namespace musclesim
