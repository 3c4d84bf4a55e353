/// The load frame at rest: the length at which the muscle stops, and the length that the force law predicts.
///
/// Link i = 0 .. n - 1 from the top carries the load and the beads below its slider, weight w_i. At rest each of its links obeys
///     |F(p, l) - w_i| <= friction              between its stops,
///     F(p, l) - w_i <= friction                at its long stop,
///     F(p, l) - w_i >= -friction               at its short stop,
/// l is the length of the whole chain. All sliders pull with the same F, so without friction the upper links move to their long stops, the
/// lower links to their short stops, and one link in between balances. With k links at their long stops the length is
///     F(p, l) = w_k,   l_k <= l <= l_k+1,   l_k = (k l_max + (n - k) l_min) / n,
/// or l = l_k if F(p, l_k) lies between w_k and w_k-1. There is only one solution, because F grows and w falls with l.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "equilibrium.h"
#include "musclesim/base/units.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

inline const std::vector<double>& staticPressures() {
  static const std::vector<double> pressures = {0, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1};
  return pressures;
}

inline const std::vector<double>& staticLoadsKg() {
  static const std::vector<double> loads_kg = {0.5, 1, 2, 3.5, 5, 6.5};
  return loads_kg;
}

struct StaticRig {
  double pressure_ratio, load_kg, slider_friction_N;
  bool from_longer;  ///< whether the chain starts longer or shorter than its rest lengths

  struct Link {
    double weight_N;  ///< w_i
    bool at_long_stop, at_short_stop;
  };
  struct Result {
    double length_mm, tension_N;
    std::vector<Link> links;
    bool at_rest;
    int long_stop_count, short_stop_count;
  };

  static constexpr double minimum_mm = 120, maximum_mm = 300;
  static constexpr int link_count = 8;
  static constexpr double bead_weight_N = 0.010 * gravity_m_per_s2;

  double loadN() const { return load_kg * gravity_m_per_s2; }
  static double chainN() { return 2 * link_count * bead_weight_N; }
  double weightN(int link) const { return loadN() + bead_weight_N * (2 * (link_count - link) - 1); }
  BraunForceLaw law() const { return {minimum_mm, maximum_mm}; }

  /// Length between the stops at which the muscle pulls with a given force.
  double lengthForMm(double force_N) const {
    return rootBetween([&](double l) { return law().tensionN(pressure_ratio, l) - force_N; }, minimum_mm, maximum_mm);
  }
  /// Rest length if half of the chain's weight acted at its lower end.
  double simpleLengthMm() const { return lengthForMm(loadN() + chainN() / 2); }
  /// Rest length without friction, computed link by link.
  double frictionlessLengthMm() const {
    return rootBetween(
        [&](double l) {
          const int long_count = static_cast<int>((l - minimum_mm) / (maximum_mm - minimum_mm) * link_count);
          return law().tensionN(pressure_ratio, l) - weightN(std::min(long_count, link_count - 1));
        },
        minimum_mm, maximum_mm);
  }

  /// Releases the rig a little outside its range of rest lengths and waits until it rests. Without friction it would swing forever, so all
  /// velocities are set to 0 whenever the kinetic energy has passed a maximum.
  Result settle() const {
    SimulationOptions options;
    options.substeps = 3;
    options.parameters.set("rig.load_kg", load_kg, "test");
    options.parameters.set("muscle.slider_friction_N", slider_friction_N, "test");
    if (slider_friction_N == 0) options.parameters.set("muscle.hinge_friction_Nm", 0.0, "test");
    Simulation simulation(options);
    Robot& robot = simulation.build("rig");
    Actuator& muscle = *robot.actuators()[0];
    constexpr double outside_mm = 2;
    const double edge_mm = from_longer ? lengthForMm(loadN() + chainN() + slider_friction_N) + outside_mm
                                       : lengthForMm(loadN() - slider_friction_N) - outside_mm;
    const Vector bottom(0, -std::clamp(edge_mm, minimum_mm + 0.5, maximum_mm - 0.5), 0);
    simulation.world().primitives()[0]->place(bottom, Eigen::Matrix3d::Identity());
    muscle.placeStraight(Vector::Zero(), bottom);
    robot.step({pressure_ratio});

    constexpr double still_mm = 1e-4;
    constexpr int enough_steps = 20, most_steps = 500;
    double last_mm = muscle.lengthMm(), last_energy = 0;
    int still_steps = 0;
    for (int i = 0; i < most_steps && still_steps < enough_steps; ++i) {
      simulation.step();
      if (slider_friction_N == 0) {
        const double energy = kineticEnergy(simulation);
        if (energy < last_energy) simulation.stop();
        last_energy = energy < last_energy ? 0 : energy;
      }
      still_steps = std::abs(muscle.lengthMm() - last_mm) < still_mm ? still_steps + 1 : 0;
      last_mm = muscle.lengthMm();
    }

    Result result = {last_mm, law().tensionN(pressure_ratio, last_mm), {}, still_steps == enough_steps, 0, 0};
    for (int i = 0; i < link_count; ++i) {
      constexpr double touching_mm = 0.01;
      const dJointID slider = muscle.links()[static_cast<std::size_t>(i)].slider->id();
      const double position_mm = dJointGetSliderPosition(slider);
      const bool at_long = position_mm < dJointGetSliderParam(slider, dParamLoStop) + touching_mm;
      const bool at_short = position_mm > dJointGetSliderParam(slider, dParamHiStop) - touching_mm;
      result.links.push_back({weightN(i), at_long, at_short});
      result.long_stop_count += at_long;
      result.short_stop_count += at_short;
    }
    return result;
  }

 private:
  static double kineticEnergy(const Simulation& simulation) {
    double sum = 0;
    auto add = [&](dBodyID body) {
      dMass mass;
      dBodyGetMass(body, &mass);
      const dReal* v = dBodyGetLinearVel(body);
      sum += mass.mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    };
    for (const auto& body : simulation.world().bodies()) add(body->id);
    for (const auto& actuator : simulation.world().actuators())
      for (const auto& link : actuator->links())
        for (const dBodyID bead : link.bead) add(bead);
    return sum;
  }
};

}  // namespace musclesim
