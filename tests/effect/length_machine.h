/// A testing machine that prescribes the length of the rig's muscle.
#pragma once

#include "musclesim/robot/muscle.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

class LengthMachine {
 public:
  explicit LengthMachine(std::vector<ActiveEffect> effects, double pressure_ratio = 0.5, double length_mm = 220)
      : simulation_(optionsWith(std::move(effects))), robot_(simulation_.build("rig")) {
    simulation_.effects().settlePressures({pressure_ratio});
    setLength(length_mm);
    simulation_.effects().begin();
    look();
  }

  /// Tension of the force law without effects.
  double lawN(double pressure_ratio, double length_mm) const { return muscle().calculateForce(pressure_ratio, length_mm); }
  double lengthMm() const { return muscle().lengthMm(); }
  void setPressure(double ratio) {
    muscle().setPressure(ratio);
    look();
  }
  /// Sets the length and returns the tension, without advancing time.
  double tensionAt(double length_mm) {
    setLength(length_mm);
    return look();
  }
  /// Holds the present length for a step of h_s.
  double hold(double h_s) {
    step(h_s);
    return look();
  }
  /// Moves to a length at a constant rate in steps of h_s and calls `each(length_mm, tension_N)` after each step.
  template <class Function>
  void moveTo(double length_mm, double rate_mm_per_s, double h_s, const Function& each) {
    const double begin_mm = lengthMm();
    const auto count = static_cast<int>(std::lround(std::abs(length_mm - begin_mm) / rate_mm_per_s / h_s));
    for (int i = 1; i <= count; ++i) {
      step(h_s);
      setLength(begin_mm + (length_mm - begin_mm) * i / count);
      each(lengthMm(), look());
    }
  }
  void moveTo(double length_mm, double rate_mm_per_s, double h_s) {
    moveTo(length_mm, rate_mm_per_s, h_s, [](double, double) {});
  }

 private:
  static SimulationOptions optionsWith(std::vector<ActiveEffect> effects) {
    SimulationOptions options;
    options.effects = std::move(effects);
    return options;
  }
  Actuator& muscle() const { return *robot_.actuators()[0]; }
  void setLength(double length_mm) { muscle().placeStraight({0, 0, 0}, {0, -length_mm, 0}); }
  void stages(double h_s) {
    MuscleValues& values = simulation_.world().values();
    simulation_.effects().command(values, h_s);
    simulation_.effects().pressure(values, h_s);
    simulation_.effects().force(values, h_s);
  }
  void step(double h_s) {
    stages(h_s);
    simulation_.effects().track(h_s);
    simulation_.world().clock().countInternalStep(h_s);
  }
  double look() {
    stages(0);
    return muscle().tensionN();
  }

  Simulation simulation_;
  Robot& robot_;
};

}  // namespace musclesim
