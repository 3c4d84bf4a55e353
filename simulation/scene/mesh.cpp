#include "mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace musclesim {

namespace {

using V = Eigen::Vector3f;
constexpr std::uint32_t round_count = 16, tube_round_count = 12, pieces_per_point = 2;  // few, for software rendering

float angle(std::uint32_t part, std::uint32_t of) {
  return 2 * std::numbers::pi_v<float> * static_cast<float>(part) / static_cast<float>(of);
}

/// Joins rings of `around` + 1 vertices each (the last vertex repeats the first) to a surface. Rings follow each other along the axis; the
/// vertices of each run counter-clockwise.
void joinRings(Mesh& mesh, std::uint32_t ring_count, std::uint32_t around) {
  for (std::uint32_t ring = 0; ring + 1 < ring_count; ++ring) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = ring * (around + 1) + i, b = a + around + 1;
      for (const std::uint32_t index : {a, a + 1, b, b, a + 1, b + 1}) mesh.indices.push_back(index);
    }
  }
}

void addFace(Mesh& mesh, const V& center, const V& u, const V& v) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const V normal = u.cross(v).normalized();
  for (const V& corner : {V(center - u - v), V(center + u - v), V(center + u + v), V(center - u + v)})
    mesh.vertices.push_back({corner, normal});
  for (const std::uint32_t index : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(first + index);
}

}  // namespace

Mesh boxMesh() {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {0.5F, -0.5F}) {
      const V center = V::Unit(axis) * side;
      addFace(mesh, center, V::Unit((axis + 1) % 3) * 0.5F, V::Unit((axis + 2) % 3) * side);
    }
  }
  return mesh;
}

Mesh sphereMesh(std::uint32_t ring_count) {
  Mesh mesh;
  for (std::uint32_t ring = 0; ring <= ring_count; ++ring) {
    const float polar = angle(ring, 2 * ring_count);
    for (std::uint32_t i = 0; i <= 2 * ring_count; ++i) {
      const float a = angle(i, 2 * ring_count);
      const V n(std::sin(polar) * std::cos(a), std::sin(polar) * std::sin(a), -std::cos(polar));
      mesh.vertices.push_back({n, n});
    }
  }
  joinRings(mesh, ring_count + 1, 2 * ring_count);
  return mesh;
}

Mesh turnedMesh(const std::vector<Eigen::Vector2f>& profile) {
  Mesh mesh;
  for (std::size_t piece = 0; piece + 1 < profile.size(); ++piece) {
    const Eigen::Vector2f along = profile[piece + 1] - profile[piece], out_of(along.y(), -along.x());
    Mesh ring;
    for (const auto& point : {profile[piece], profile[piece + 1]}) {
      for (std::uint32_t i = 0; i <= round_count; ++i) {
        const V out(std::cos(angle(i, round_count)), std::sin(angle(i, round_count)), 0);
        ring.vertices.push_back({point.x() * out + point.y() * V::UnitZ(), (out_of.x() * out + out_of.y() * V::UnitZ()).normalized()});
      }
    }
    joinRings(ring, 2, round_count);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), ring.vertices.begin(), ring.vertices.end());
    for (const std::uint32_t index : ring.indices) mesh.indices.push_back(first + index);
  }
  return mesh;
}

Mesh squareMesh() {
  Mesh mesh;
  addFace(mesh, V::Zero(), V::UnitZ(), V::UnitX());
  return mesh;
}

std::vector<V> smoothCurve(const std::vector<V>& points) {
  if (points.size() < 3) return points;
  // Repeat the end points three times, so that the curve begins and ends there.
  std::vector<V> p = points;
  p.insert(p.begin(), 2, points.front());
  p.insert(p.end(), 2, points.back());
  std::vector<V> curve;
  for (std::size_t i = 0; i + 3 < p.size(); ++i) {
    for (std::uint32_t k = 0; k < pieces_per_point; ++k) {
      const float t = static_cast<float>(k) / pieces_per_point, s = 1 - t;
      const float w0 = s * s * s, w1 = 3 * t * t * t - 6 * t * t + 4, w2 = 3 * s * s * s - 6 * s * s + 4, w3 = t * t * t;
      curve.push_back((w0 * p[i] + w1 * p[i + 1] + w2 * p[i + 2] + w3 * p[i + 3]) / 6);
    }
  }
  curve.push_back(points.back());
  return curve;
}

Mesh tubeMesh(const std::vector<V>& curve, float radius) {
  std::vector<V> points;
  for (const V& point : curve)
    if (points.empty() || (point - points.back()).norm() > 1e-3F * radius) points.push_back(point);
  Mesh mesh;
  if (points.size() < 2) return mesh;
  V along = (points[1] - points[0]).normalized(), side = along.unitOrthogonal();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const V next = (points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1]).stableNormalized();
    // Move the ring along the curve without twist.
    side = Eigen::Quaternionf::FromTwoVectors(along, next) * side;
    along = next;
    const V other = along.cross(side);
    for (std::uint32_t k = 0; k <= tube_round_count; ++k) {
      const float a = angle(k, tube_round_count);
      const V out = std::cos(a) * side + std::sin(a) * other;
      mesh.vertices.push_back({points[i] + radius * out, out});
    }
  }
  joinRings(mesh, static_cast<std::uint32_t>(points.size()), tube_round_count);
  return mesh;
}

}  // namespace musclesim
