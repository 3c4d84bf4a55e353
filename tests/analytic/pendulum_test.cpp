/// A physical pendulum: a rod on a hinge to the environment.
///     T = 2 pi sqrt(I / (m g d)) (1 + phi_0^2 / 16),   phi(t) = phi_0 cos(2 pi t / T)   for small amplitudes phi_0
/// I moment of inertia about the hinge, d distance of the centre of mass from it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "musclesim/base/units.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {
namespace {

constexpr double amplitude_rad = 0.01;
constexpr double distance_mm = 150, rod_g = 200;

struct Swing {
  double period_error_ratio;  ///< relative, over five periods
  double angle_error_rad;     ///< largest over the first period
  double energy_error_ratio;  ///< largest over five periods, relative to the energy of the swing
};

Swing swing(PhysicsKind kind, double step_s) {
  SimulationOptions options;
  options.physics = kind;
  options.step_s = step_s;
  options.substeps = 1;
  Simulation simulation(options);
  auto* rod = new CappedCylinder(simulation.world(), nullptr, {0, -distance_mm, 0}, rod_g, 0, 10, 200);
  rod->rotate(90, {1, 0, 0});
  const Joint* hinge = rod->attachHinge(nullptr, {0, 0, 0}, {0, 0, 1});
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(amplitude_rad, Vector::UnitZ()).toRotationMatrix();
  rod->place(turn * rod->getPosition(), turn * rod->getRotation());

  dMass mass;
  dBodyGetMass(rod->body().id, &mass);
  const double inertia_g_mm2 = mass.I[0] + rod_g * distance_mm * distance_mm;  // about the body's x axis; its z axis is the rod's
  const double gravity = simulation.physics().gravity_mm_per_s2;
  const double period_s =
      2 * std::numbers::pi * std::sqrt(inertia_g_mm2 / (rod_g * gravity * distance_mm)) * (1 + amplitude_rad * amplitude_rad / 16);
  const double force_scale = simulation.physics().force_per_N / world_force_per_N;
  const double swing_J = rod_g * gravity * distance_mm * (1 - std::cos(amplitude_rad)) / (world_force_per_N * mm_per_m);
  EXPECT_NEAR(gravity, gravity_m_per_s2 * mm_per_m * force_scale, 1e-9);

  Swing result = {0, 0, 0};
  const double start_J = simulation.mechanicalEnergyJ();
  double last_rad = amplitude_rad, first_crossing_s = 0;
  for (int crossing_count = 0; crossing_count < 6;) {
    simulation.step();
    const double angle_rad = hinge->angleDeg() * rad_per_deg;
    if (simulation.time_s() < period_s)
      result.angle_error_rad = std::max(
          result.angle_error_rad, std::abs(angle_rad - amplitude_rad * std::cos(2 * std::numbers::pi * simulation.time_s() / period_s)));
    result.energy_error_ratio = std::max(result.energy_error_ratio, std::abs(simulation.mechanicalEnergyJ() - start_J) / swing_J);
    if (last_rad < 0 && angle_rad >= 0) {
      const double crossing_s = simulation.time_s() - step_s * angle_rad / (angle_rad - last_rad);
      if (crossing_count++ == 0) first_crossing_s = crossing_s;
      result.period_error_ratio = std::abs((crossing_s - first_crossing_s) / 5 / period_s - 1);
    }
    last_rad = angle_rad;
  }
  return result;
}

TEST(Pendulum, SwingsWithThePeriodOfTheClosedForm) {
  EXPECT_LT(swing(PhysicsKind::si, 1e-3).period_error_ratio, 2e-5);
  EXPECT_LT(swing(PhysicsKind::scaled, 1e-3).period_error_ratio, 2e-5);
  EXPECT_LT(swing(PhysicsKind::original, 0.01).period_error_ratio, 2e-5) << "sqrt(1000) times slower, at a tenth of the step";
}

TEST(Pendulum, HalfTheStepGivesHalfTheErrors) {
  const Swing coarse = swing(PhysicsKind::si, 4e-3), medium = swing(PhysicsKind::si, 2e-3), fine = swing(PhysicsKind::si, 1e-3);
  for (const auto& [more, less] : {std::pair{coarse, medium}, {medium, fine}}) {
    EXPECT_NEAR(more.angle_error_rad / less.angle_error_rad, 2, 0.2);
    EXPECT_NEAR(more.energy_error_ratio / less.energy_error_ratio, 2, 0.2);
    EXPECT_GT(more.period_error_ratio / less.period_error_ratio, 2) << "the period's error even falls with the square of the step";
  }
  EXPECT_LT(fine.angle_error_rad, 0.01 * amplitude_rad);
  EXPECT_LT(fine.energy_error_ratio, 0.005);
}

}  // namespace
}  // namespace musclesim
