#include "mass_properties.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace musclesim {

namespace {

constexpr double pi = std::numbers::pi;

/// What a point mass at `offset_m` adds to the inertia about the origin.
Eigen::Matrix3d steiner(double mass_kg, const Eigen::Vector3d& offset_m) {
  return mass_kg * (offset_m.squaredNorm() * Eigen::Matrix3d::Identity() - offset_m * offset_m.transpose());
}

/// Moments of a body of mass 1 whose mean squared extents along the axes are given.
Eigen::Vector3d momentsOf(const Eigen::Vector3d& squares_m2) {
  return Eigen::Vector3d::Constant(squares_m2.sum()) - squares_m2;
}

/// A cylinder with half spheres at its ends: the half spheres' centres of mass lie 3/8 r beyond the cylinder's ends.
Eigen::Vector3d capsuleMoments(double radius_m, double length_m) {
  const double r = radius_m, l = length_m;
  const double caps = 4 * r / (4 * r + 3 * l), cylinder = 1 - caps;
  const double across = cylinder * (r * r / 4 + l * l / 12) + caps * (2 * r * r / 5 + l * l / 4 + 3 * r * l / 8);
  return {across, across, cylinder * r * r / 2 + caps * 2 * r * r / 5};
}

/// Principal moments of a solid of mass 1, m^2.
Eigen::Vector3d unitMoments(const SourceShape& shape) {
  const Eigen::Vector3d s = shape.size_m, squares = s.cwiseProduct(s);
  switch (shape.kind) {
    case SourceShape::Kind::box:
      return momentsOf(squares / 12);
    case SourceShape::Kind::sphere:
      return Eigen::Vector3d::Constant(0.4 * squares.x());
    case SourceShape::Kind::capsule:
      return capsuleMoments(s.x(), s.y());
    case SourceShape::Kind::cylinder:
      return momentsOf({squares.x() / 4, squares.x() / 4, squares.y() / 12});
    case SourceShape::Kind::ellipsoid:
      return momentsOf(squares / 5);
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace

MassProperties MassProperties::seenFrom(const Pose& pose) const {
  return {mass_kg, pose * center_m, pose.linear() * inertia_kg_m2 * pose.linear().transpose()};
}

void MassProperties::add(const MassProperties& other) {
  const double sum_kg = mass_kg + other.mass_kg;
  if (!(sum_kg > 0)) return;
  const Eigen::Vector3d center = (mass_kg * center_m + other.mass_kg * other.center_m) / sum_kg;
  inertia_kg_m2 += other.inertia_kg_m2 + steiner(mass_kg, center_m - center) + steiner(other.mass_kg, other.center_m - center);
  mass_kg = sum_kg;
  center_m = center;
}

MassProperties MassProperties::scaled(double factor) const {
  return {factor * mass_kg, center_m, factor * inertia_kg_m2};
}

PrincipalInertia principalInertia(const Eigen::Matrix3d& inertia_kg_m2) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia_kg_m2);
  PrincipalInertia principal{solver.eigenvalues(), solver.eigenvectors()};
  if (principal.axes.determinant() < 0) principal.axes.col(2) *= -1;
  return principal;
}

double volumeM3(const SourceShape& shape) {
  const Eigen::Vector3d& s = shape.size_m;
  switch (shape.kind) {
    case SourceShape::Kind::box:
      return s.prod();
    case SourceShape::Kind::sphere:
      return 4.0 / 3.0 * pi * std::pow(s.x(), 3);
    case SourceShape::Kind::capsule:
      return pi * s.x() * s.x() * s.y() + 4.0 / 3.0 * pi * std::pow(s.x(), 3);
    case SourceShape::Kind::cylinder:
      return pi * s.x() * s.x() * s.y();
    case SourceShape::Kind::ellipsoid:
      return 4.0 / 3.0 * pi * s.prod();
  }
  return 0;
}

MassProperties solid(const SourceShape& shape, double mass_kg) {
  const MassProperties centered{mass_kg, Eigen::Vector3d::Zero(), (mass_kg * unitMoments(shape)).asDiagonal()};
  return centered.seenFrom(shape.pose);
}

double missingInertia(const Eigen::Matrix3d& inertia_kg_m2) {
  const Eigen::Vector3d moments = principalInertia(inertia_kg_m2).moments_kg_m2;
  constexpr double rounding_ratio = 1e-9;  // of the greatest moment: thin rods lie exactly at the bound
  const double missing = moments(2) - moments(1) - moments(0);
  return missing > rounding_ratio * std::abs(moments(2)) ? missing : 0;
}

std::optional<SourceShape> equivalentBox(const MassProperties& mass) {
  if (!(mass.mass_kg > 0)) return std::nullopt;
  const PrincipalInertia principal = principalInertia(mass.inertia_kg_m2);
  const Eigen::Vector3d moments = principal.moments_kg_m2 / mass.mass_kg;
  const Eigen::Vector3d squares = 6 * (Eigen::Vector3d::Constant(moments.sum()) - 2 * moments);
  SourceShape box;
  box.kind = SourceShape::Kind::box;
  if (!(squares.maxCoeff() > 0)) return std::nullopt;
  // A plate without thickness is drawn as a thin one.
  constexpr double thinnest_ratio = 1e-3;
  box.size_m = squares.cwiseMax(0).cwiseSqrt();
  box.size_m = box.size_m.cwiseMax(thinnest_ratio * box.size_m.maxCoeff());
  box.pose.linear() = principal.axes;
  box.pose.translation() = mass.center_m;
  return box;
}

}  // namespace musclesim
