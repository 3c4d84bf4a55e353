#include "import/mass_properties.h"

#include <gtest/gtest.h>

#include <array>

namespace musclesim {
namespace {

/// Whether a point lies in a shape, in the shape's frame.
bool isInside(const SourceShape& shape, const Eigen::Vector3d& p) {
  const Eigen::Vector3d& s = shape.size_m;
  const double across = p.head<2>().norm();
  switch (shape.kind) {
    case SourceShape::Kind::box:
      return (p.cwiseAbs() - s / 2).maxCoeff() <= 0;
    case SourceShape::Kind::sphere:
      return p.norm() <= s.x();
    case SourceShape::Kind::cylinder:
      return across <= s.x() && std::abs(p.z()) <= s.y() / 2;
    case SourceShape::Kind::capsule:
      return std::hypot(across, std::max(0.0, std::abs(p.z()) - s.y() / 2)) <= s.x();
    case SourceShape::Kind::ellipsoid:
      return p.cwiseQuotient(s).norm() <= 1;
  }
  return false;
}

TEST(MassProperties, SolidsAgreeWithASumOverCells) {
  using Kind = SourceShape::Kind;
  for (const Kind kind : {Kind::box, Kind::sphere, Kind::capsule, Kind::cylinder, Kind::ellipsoid}) {
    SourceShape shape{.kind = kind, .size_m = {0.3, 0.5, 0.2}};
    constexpr int cells = 120;
    constexpr double half_m = 0.6, edge_m = 2 * half_m / cells, cell_m3 = edge_m * edge_m * edge_m;
    double volume = 0;
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    for (int i = 0; i < cells * cells * cells; ++i) {
      const Eigen::Vector3d index(i % cells, i / cells % cells, i / cells / cells);
      const Eigen::Vector3d p = (index.array() + 0.5) * edge_m - half_m;
      if (!isInside(shape, p)) continue;
      volume += cell_m3;
      squares += cell_m3 * p.cwiseProduct(p);
    }
    EXPECT_NEAR(volumeM3(shape) / volume, 1, 0.02) << static_cast<int>(kind);
    const MassProperties mass = solid(shape, 2);
    const Eigen::Vector3d moments = (Eigen::Vector3d::Constant(squares.sum()) - squares) * 2 / volume;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(mass.inertia_kg_m2(i, i) / moments(i), 1, 0.02) << static_cast<int>(kind) << " " << i;
  }
}

TEST(MassProperties, TwoHalvesOfABoxAreTheBox) {
  SourceShape half{.kind = SourceShape::Kind::box, .size_m = {0.2, 0.4, 0.1}};
  MassProperties sum;
  for (const double side : {-1.0, 1.0}) {
    half.pose.translation() = Eigen::Vector3d(1 + side * 0.1, 2, 3);
    sum.add(solid(half, 1.5));
  }
  const MassProperties whole = solid({.kind = SourceShape::Kind::box, .size_m = {0.4, 0.4, 0.1}}, 3);
  EXPECT_NEAR((sum.center_m - Eigen::Vector3d(1, 2, 3)).norm(), 0, 1e-12);
  EXPECT_NEAR((sum.inertia_kg_m2 - whole.inertia_kg_m2).norm(), 0, 1e-12);
}

TEST(MassProperties, TurnsWithItsFrame) {
  const MassProperties box = solid({.kind = SourceShape::Kind::box, .size_m = {0.4, 0.3, 0.1}}, 3);
  Pose quarter = Pose::Identity();
  quarter.linear() = Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const MassProperties turned = box.seenFrom(quarter);
  EXPECT_NEAR(turned.inertia_kg_m2(0, 0), box.inertia_kg_m2(1, 1), 1e-12);
  EXPECT_NEAR(turned.inertia_kg_m2(2, 2), box.inertia_kg_m2(2, 2), 1e-12);
}

TEST(MassProperties, EquivalentBoxHasTheInertia) {
  Eigen::Matrix3d inertia;
  inertia << 0.03, 0.002, -0.001, 0.002, 0.04, 0.003, -0.001, 0.003, 0.05;
  const MassProperties mass{2, {0.1, 0.2, 0.3}, inertia};
  const auto box = equivalentBox(mass);
  ASSERT_TRUE(box);
  EXPECT_NEAR((solid(*box, 2).inertia_kg_m2 - inertia).norm(), 0, 1e-12);
  EXPECT_NEAR((solid(*box, 2).center_m - mass.center_m).norm(), 0, 1e-12);
}

TEST(MassProperties, SaysHowMuchInertiaIsMissing) {
  EXPECT_EQ(missingInertia(Eigen::Vector3d(1, 2, 3).asDiagonal()), 0);
  EXPECT_NEAR(missingInertia(Eigen::Vector3d(1, 5, 2).asDiagonal()), 2, 1e-12);
}

}  // namespace
}  // namespace musclesim
