/// Triangle meshes with smooth normals.
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

/// A box with edges of length 1, centred at the origin.
Mesh boxMesh();
/// A sphere of radius 1 about the origin, with twice as many edges around as rings.
Mesh sphereMesh(std::uint32_t ring_count);
/// A surface of revolution about z: straight pieces between points (radius, z) with z never decreasing; edges stay sharp.
Mesh turnedMesh(const std::vector<Eigen::Vector2f>& profile);
/// A square from -1 to 1 in x and z, at y = 0, facing up.
Mesh squareMesh();

/// A smooth curve with the given control points: a uniform cubic B-spline that begins at the first point and ends at the last.
std::vector<Eigen::Vector3f> smoothCurve(const std::vector<Eigen::Vector3f>& points);
/// A tube along a curve, with open ends. Points that coincide are skipped.
Mesh tubeMesh(const std::vector<Eigen::Vector3f>& curve, float radius);

}  // namespace musclesim
