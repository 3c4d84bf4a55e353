/// A user's actuator as a linear spring between a fixed point and a mass.
///     T = 2 pi sqrt(m / k)
/// m the load and the lower bead, k the spring's stiffness.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "musclesim/base/units.h"
#include "musclesim/robot/linear_actuator.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {
namespace {

constexpr double stiffness_N_per_mm = 0.5, relaxed_mm = 120, load_g = 1000, bead_g = 10;

class Spring : public LinearActuator {
 public:
  using LinearActuator::LinearActuator;
  double calculateForce(double, double length_mm) const override { return stiffness_N_per_mm * (length_mm - relaxed_mm); }
};

struct Oscillation {
  double period_error_ratio, middle_mm;
};

Oscillation oscillate(double step_s) {
  SimulationOptions options;
  options.step_s = step_s;
  options.substeps = 1;
  options.parameters.set("muscle.slider_friction_N", 0.0, "test");
  Simulation simulation(options);
  const double length_mm = 145;
  auto* load = new Sphere(simulation.world(), nullptr, {0, -length_mm, 0}, load_g, 0, 20);
  auto* spring = new Spring(simulation.world(), simulation.space(), Vector(0, 0, 0), Vector(0, -length_mm, 0), 50, 300);
  spring->connectStartTo(nullptr);
  spring->connectEndTo(load);
  const double moving_kg = (load_g + bead_g) / g_per_kg;
  const double middle_mm = relaxed_mm + moving_kg * gravity_m_per_s2 / stiffness_N_per_mm;
  const double period_s = 2 * std::numbers::pi * std::sqrt(moving_kg / (stiffness_N_per_mm * mm_per_m));

  double last = length_mm - middle_mm, first_crossing_s = 0, crossing_s = 0, shortest = length_mm, longest = length_mm;
  for (int crossing_count = 0; crossing_count < 11;) {
    simulation.step();
    const double now = spring->lengthMm() - middle_mm;
    shortest = std::min(shortest, spring->lengthMm());
    longest = std::max(longest, spring->lengthMm());
    if (last < 0 && now >= 0) {
      crossing_s = simulation.time_s() - step_s * now / (now - last);
      if (crossing_count++ == 0) first_crossing_s = crossing_s;
    }
    last = now;
  }
  return {std::abs((crossing_s - first_crossing_s) / 10 / period_s - 1), (shortest + longest) / 2 - middle_mm};
}

TEST(Spring, OscillatesWithThePeriodOfTheClosedFormAboutItsEquilibrium) {
  const Oscillation fine = oscillate(5e-4);
  EXPECT_LT(fine.period_error_ratio, 1e-5);
  EXPECT_NEAR(fine.middle_mm, 0, 0.02);
}

TEST(Spring, HalfTheStepGivesAtMostHalfTheError) {
  const double coarse = oscillate(4e-3).period_error_ratio, medium = oscillate(2e-3).period_error_ratio,
               fine = oscillate(1e-3).period_error_ratio;
  EXPECT_GT(coarse / medium, 2);
  EXPECT_GT(medium / fine, 2);
}

}  // namespace
}  // namespace musclesim
