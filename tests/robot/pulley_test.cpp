#include "musclesim/robot/pulley.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "musclesim/base/random.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/line_of_pull.h"
#include "musclesim/robot/linear_actuator.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {
namespace {

Pulley cylinder(double radius_mm, std::optional<Vector> side_mm = {}) {
  return {Vector::Zero(), Vector::UnitZ(), radius_mm, side_mm};
}

Vector randomVector(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// A point at least 1.05 radii from the axis or centre.
Vector randomPointOutside(RandomStream& random, const Pulley& pulley) {
  for (;;) {
    const Vector point = pulley.center_mm + randomVector(random, 2 * pulley.radius_mm);
    if (pulley.distanceMm(point) > 1.05 * pulley.radius_mm) return point;
  }
}

Pulley randomPulley(RandomStream& random, bool sphere) {
  const Vector axis = sphere ? Vector(Vector::Zero()) : Vector(randomVector(random, 1).normalized());
  return {randomVector(random, 50), axis, random.uniform(20, 60), {}};
}

/// Moves a point that lies inside to the surface.
Vector movedOut(const Pulley& pulley, const Vector& point) {
  const Vector from_center = point - pulley.center_mm, out = from_center - pulley.axis.dot(from_center) * pulley.axis;
  const double depth = pulley.radius_mm - out.norm();
  return depth > 0 ? Vector(point + depth * out.normalized()) : point;
}

/// Length of a polyline that is pulled tight: every inner node moves half the way to the middle of its neighbours and out of the pulley.
double tightenedLengthMm(const Pulley& pulley, std::vector<Vector> nodes) {
  for (int round = 0; round < 20000; ++round)
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) nodes[i] = movedOut(pulley, (nodes[i - 1] + nodes[i + 1]) / 2);
  double length_mm = 0;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) length_mm += (nodes[i + 1] - nodes[i]).norm();
  return length_mm;
}

/// A polyline over given corners.
std::vector<Vector> nodesAlong(const std::vector<Vector>& corners, int count_per_piece) {
  std::vector<Vector> nodes = {corners.front()};
  for (std::size_t i = 0; i + 1 < corners.size(); ++i)
    for (int k = 1; k <= count_per_piece; ++k) nodes.push_back(corners[i] + (corners[i + 1] - corners[i]) * k / count_per_piece);
  return nodes;
}

TEST(WayPast, IsTwoTangentsAndAnArcWhereTheSegmentCrosses) {
  // Both points 50 mm from the axis of a pulley with the radius 30 mm: tangents of 40 mm.
  const Vector a(-50, 0, 0), b(50, 1e-9, 0);
  const Way way = wayPast(cylinder(30), a, b);
  EXPECT_TRUE(way.wound);
  EXPECT_NEAR(way.length_mm, 80 + 30 * (std::numbers::pi - 2 * std::acos(0.6)), 1e-8);
  EXPECT_LT((way.start_direction - Vector(0.8, 0.6, 0)).norm(), 1e-9) << "over the upper side";
  EXPECT_LT((way.end_direction - Vector(0.8, -0.6, 0)).norm(), 1e-9);
}

TEST(WayPast, IsStraightWhereTheSegmentPasses) {
  const Vector a(-50, 31, 0), b(50, 31, 20);
  const Way way = wayPast(cylinder(30), a, b);
  EXPECT_FALSE(way.wound);
  EXPECT_EQ(way.length_mm, (b - a).norm());
  EXPECT_EQ(way.start_direction, (b - a).normalized());
  const Way beside = wayPast(cylinder(30), {40, 0, 0}, {90, 0, 0});
  EXPECT_FALSE(beside.wound) << "the line would cross the pulley, but not between the points";
}

TEST(WayPast, ClimbsACylinderAsOnItsUnrolledSurface) {
  const double flat_mm = wayPast(cylinder(30), {-50, 5, 0}, {50, 10, 0}).length_mm;
  const Way way = wayPast(cylinder(30), {-50, 5, -20}, {50, 10, 60});
  EXPECT_NEAR(way.length_mm, std::hypot(flat_mm, 80), 1e-12);
  EXPECT_NEAR(way.start_direction.norm(), 1, 1e-14);
  EXPECT_NEAR(way.start_direction.z(), 80 / way.length_mm, 1e-14);
  EXPECT_EQ(way.start_direction.z(), way.end_direction.z()) << "the slope is the same everywhere";
}

TEST(WayPast, LiesInThePlaneOfASpheresCentre) {
  const Pulley sphere = {{0, 0, 10}, Vector::Zero(), 30, {}};
  const Way over_sphere = wayPast(sphere, {-50, 5, 10}, {50, 10, 10}), over_cylinder = wayPast(cylinder(30), {-50, 5, 0}, {50, 10, 0});
  EXPECT_NEAR(over_sphere.length_mm, over_cylinder.length_mm, 1e-12);
  EXPECT_LT((over_sphere.start_direction - over_cylinder.start_direction).norm(), 1e-14);
  EXPECT_NEAR(wayPast(sphere, {-50, 0, 10}, {50, 0, 10}).length_mm, 80 + 30 * (std::numbers::pi - 2 * std::acos(0.6)), 1e-12)
      << "any plane, where the centre lies between the points";
}

TEST(WayPast, IsTheShortestWayOutside) {
  RandomStream random(5, "pulley test");
  int wound_count = 0;
  for (int i = 0; i < 40; ++i) {
    const Pulley pulley = randomPulley(random, i % 2 == 1);
    const Vector a = randomPointOutside(random, pulley), b = randomPointOutside(random, pulley);
    const Way way = wayPast(pulley, a, b);
    wound_count += way.wound ? 1 : 0;
    // The polyline's chords lie a little inside.
    EXPECT_NEAR(way.length_mm, tightenedLengthMm(pulley, nodesAlong({a, b}, 60)), 1e-3 * way.length_mm) << i;
  }
  EXPECT_GE(wound_count, 12);
}

TEST(WayPast, IsTheShortestWayOnTheSideOfTheSidePoint) {
  RandomStream random(6, "pulley test");
  int around_count = 0;
  for (int i = 0; i < 16; ++i) {
    Pulley pulley = randomPulley(random, false);
    const Vector a = randomPointOutside(random, pulley), b = randomPointOutside(random, pulley);
    // Beyond the pulley as seen from the segment.
    const Vector middle = (a + b) / 2 - pulley.center_mm;
    const Vector out = (middle - pulley.axis.dot(middle) * pulley.axis).normalized();
    pulley.side_mm = pulley.center_mm - 2 * pulley.radius_mm * out;
    const Way way = wayPast(pulley, a, b);
    if (!way.wound) continue;
    ++around_count;
    const Vector height = pulley.axis * pulley.axis.dot(middle);
    EXPECT_NEAR(way.length_mm, tightenedLengthMm(pulley, nodesAlong({a, *pulley.side_mm + height, b}, 40)), 2e-3 * way.length_mm) << i;
    EXPECT_GT(way.length_mm, straightWay(a, b).length_mm);
  }
  EXPECT_GE(around_count, 12);
}

TEST(WayPast, GoesAroundToTheSidePointWhereTheSegmentPassesOnTheOtherSide) {
  const Vector a(-50, 40, 0), b(50, 40, 0);
  EXPECT_FALSE(wayPast(cylinder(30, Vector(0, 60, 0)), a, b).wound) << "the segment passes on the side of the point";
  const Way below = wayPast(cylinder(30, Vector(0, -60, 0)), a, b);
  EXPECT_TRUE(below.wound);
  EXPECT_LT(below.start_direction.y(), 0);
  // Both points at the angle atan2(50, 40) from the upper middle.
  const double arc = 2 * std::numbers::pi - 2 * std::atan2(50, 40) - 2 * std::acos(30 / std::hypot(50, 40));
  EXPECT_NEAR(below.length_mm, 2 * std::sqrt(50 * 50 + 40 * 40 - 900) + 30 * arc, 1e-12);
}

TEST(WayPast, ChoosesTheArcOnTheSideOfTheSidePoint) {
  const Vector a(-50, 5, 0), b(50, 5, 0);
  EXPECT_GT(wayPast(cylinder(30), a, b).start_direction.y(), 0) << "the shorter way without a side point";
  EXPECT_GT(wayPast(cylinder(30, Vector(0, 40, 0)), a, b).start_direction.y(), 0);
  EXPECT_LT(wayPast(cylinder(30, Vector(0, -40, 0)), a, b).start_direction.y(), 0);
  // Where the segment crosses the axis, the side point decides alone.
  EXPECT_GT(wayPast(cylinder(30, Vector(0, 40, 0)), {-50, 0, 0}, {50, 0, 0}).start_direction.y(), 0);
  EXPECT_LT(wayPast(cylinder(30, Vector(0, -40, 0)), {-50, 0, 0}, {50, 0, 0}).start_direction.y(), 0);
  const Pulley sphere = {Vector::Zero(), Vector::Zero(), 30, Vector(0, 0, 40)};
  EXPECT_GT(wayPast(sphere, {-50, 0, 0}, {50, 0, 0}).start_direction.z(), 0);
}

TEST(WayPast, HasItsDirectionsAsGradient) {
  RandomStream random(7, "pulley test");
  constexpr double h_mm = 1e-3;
  for (int i = 0; i < 40; ++i) {
    Pulley pulley = randomPulley(random, i % 2 == 1);
    if (i % 4 >= 2) pulley.side_mm = pulley.center_mm + 100 * randomVector(random, 1);
    const Vector a = randomPointOutside(random, pulley), b = randomPointOutside(random, pulley);
    const Way way = wayPast(pulley, a, b);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector d = h_mm * Vector::Unit(axis);
      EXPECT_NEAR((wayPast(pulley, a + d, b).length_mm - wayPast(pulley, a - d, b).length_mm) / (2 * h_mm), -way.start_direction[axis],
                  1e-7);
      EXPECT_NEAR((wayPast(pulley, a, b + d).length_mm - wayPast(pulley, a, b - d).length_mm) / (2 * h_mm), way.end_direction[axis], 1e-7);
    }
  }
}

TEST(WayPast, LiftsOffWithoutAJump) {
  for (const double depth_mm : {1e-3, 1e-6, 1e-9}) {
    const Vector a(-50, 30 - depth_mm, 0), b(50, 30 - depth_mm, 30);
    const Way way = wayPast(cylinder(30), a, b), straight = straightWay(a, b);
    EXPECT_TRUE(way.wound);
    EXPECT_NEAR(way.length_mm, straight.length_mm, depth_mm);
    EXPECT_LT((way.start_direction - straight.start_direction).norm(), depth_mm);
  }
}

TEST(WayPast, IsStraightFromPointsInside) {
  for (const Vector& inside : {Vector(0, 0, 0), Vector(10, 0, 0), Vector(29.99, 0, 5)})
    for (const auto& side : {std::optional<Vector>(), std::optional<Vector>(Vector(0, 40, 0))}) {
      const Way way = wayPast(cylinder(30, side), inside, {50, 10, 0});
      EXPECT_FALSE(way.wound);
      EXPECT_EQ(way.length_mm, (Vector(50, 10, 0) - inside).norm());
      EXPECT_TRUE(wayPast({Vector::Zero(), Vector::Zero(), 30, side}, inside, inside).start_direction.allFinite());
    }
}

TEST(WayPast, BeginsOnTheSurfaceWhereItsPointDoes) {
  for (const double error_mm : {-1e-6, 0.0, 1e-6}) {
    const Way way = wayPast(cylinder(30), {0, 30 + error_mm, 0}, {50, 0, 0});
    EXPECT_TRUE(way.wound);
    EXPECT_NEAR(way.length_mm, 30 * (std::numbers::pi / 2 - std::acos(0.6)) + 40, 1e-2)
        << "the square root of the depth is a tangent's length";
    EXPECT_NEAR(way.start_direction.x(), 1, 1e-3);
  }
}

TEST(WayPast, IsDrawnOnTheSurface) {
  RandomStream random(8, "pulley test");
  for (int i = 0; i < 20; ++i) {
    const Pulley pulley = randomPulley(random, i % 2 == 1);
    const Vector a = randomPointOutside(random, pulley), b = randomPointOutside(random, pulley);
    const Way way = wayPast(pulley, a, b);
    const std::vector<Vector> points = pointsOnPulleyMm(pulley, a, b);
    ASSERT_EQ(points.empty(), !way.wound);
    if (!way.wound) continue;
    ASSERT_GE(points.size(), 2u);
    double drawn_mm = (points.front() - a).norm() + (b - points.back()).norm();
    for (const Vector& point : points) EXPECT_NEAR(pulley.distanceMm(point), pulley.radius_mm, 1e-9);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) drawn_mm += (points[k + 1] - points[k]).norm();
    EXPECT_NEAR(drawn_mm, way.length_mm, 0.003 * way.length_mm);
    EXPECT_LE(drawn_mm, way.length_mm);
    EXPECT_LT(((points.front() - a).normalized() - way.start_direction).norm(), 1e-9) << "the drawn way begins along the tangent";
    EXPECT_LT(((b - points.back()).normalized() - way.end_direction).norm(), 1e-9);
  }
}

/// A cable under constant tension.
class Cable : public LinearActuator {
 public:
  using LinearActuator::LinearActuator;
  double calculateForce(double, double) const override { return tension_N; }
  static constexpr double tension_N = 5;
};

/// Largest change of kinetic and potential energy of a pendulum and a cable that a constant tension pulls over a pulley, relative to the
/// largest kinetic energy. The pulley is on the pendulum, off its axis, or on the environment.
double energyErrorRatio(bool on_pendulum, double step_s) {
  SimulationOptions options;
  options.parameters.setFromText("muscle.model=line", "test");
  options.parameters.setFromText("muscle.slider_friction_N=0", "test");
  options.step_s = step_s;
  options.substeps = 1;
  Simulation simulation(std::move(options));
  auto* rod = new Box(simulation.world(), nullptr, {0, -150, 0}, 2000, 0, 20, 300, 20);
  rod->attachHinge(nullptr, {0, 0, 0}, {0, 0, 1});
  const Vector start = on_pendulum ? Vector(260, -60, 0) : Vector(200, -80, 0),
               end = on_pendulum ? Vector(260, -300, 20) : Vector(0, -250, 20);
  auto* cable = new Cable(simulation.world(), simulation.space(), start, end, 10, 1000);
  cable->connectStartTo(nullptr);
  cable->connectEndTo(on_pendulum ? nullptr : rod);
  on_pendulum ? cable->addPulley(rod, {0, -200, 0}, {0, 0, 1}, 25, Vector(-40, -200, 0))
              : cable->addPulley(nullptr, {60, -120, 0}, {0, 0, 1}, 25, Vector(60, -80, 0));
  const auto energyJ = [&] { return simulation.mechanicalEnergyJ() + Cable::tension_N * cable->lengthMm() / mm_per_m; };
  const double start_J = energyJ(), start_mechanical_J = simulation.mechanicalEnergyJ();
  double error_J = 0, gain_J = 0;
  bool wound = false;
  while (simulation.time_s() < 2) {
    simulation.step();
    error_J = std::max(error_J, std::abs(energyJ() - start_J));
    gain_J = std::max(gain_J, std::abs(simulation.mechanicalEnergyJ() - start_mechanical_J));
    wound = wound || cable->line()->pointsMm().size() > 2;
  }
  EXPECT_TRUE(wound);
  return error_J / gain_J;
}

TEST(CableOverPulley, ConservesTheEnergyOfAPendulum) {
  for (const bool on_pendulum : {false, true}) {
    const double coarse = energyErrorRatio(on_pendulum, 2e-3), fine = energyErrorRatio(on_pendulum, 5e-4);
    EXPECT_LT(fine, 0.002) << on_pendulum;
    EXPECT_LT(fine, 0.4 * coarse) << "the error is that of the step";
  }
}

}  // namespace
}  // namespace musclesim
