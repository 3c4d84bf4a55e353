#include "load_frame.h"

#include <algorithm>
#include <cmath>

#include "../base/parallel.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"

namespace musclesim {

namespace {

constexpr int step_count = 10;

/// One muscle in the frame at one pressure.
class Frame {
 public:
  Frame(const FrameSpecimen& specimen, double pressure_ratio, const Parameters& parameters)
      : simulation_(optionsFor(specimen, parameters)), rig_(simulation_.build("rig")), pressure_ratio_(pressure_ratio) {
    if (!muscle().endJoint()) throw BadParameter("muscle.model", "line", "be chain in the load frame, which holds the muscle's last bead");
    simulation_.start("settled", {pressure_ratio});
    load_ = simulation_.world().primitives().front()->body().id;
    simulation_.parameters().requireAllKnown();
  }

  /// Changes the load and waits for rest.
  FramePoint hang(double load_kg, FrameWay way) {
    dMass mass;
    dMassSetSphereTotal(&mass, std::max(load_kg, least_load_kg) * g_per_kg, drawn_radius_mm);
    dBodySetMass(load_, &mass);
    const bool at_rest = waitForRest();
    return read(load_kg * gravity_m_per_s2, way, at_rest);
  }

  /// Moves the held end slowly to a length and waits for rest. The end is a body without weight, so heavy that the muscle hardly moves it:
  /// its momentum in the last step is the muscle's force on it.
  FramePoint hold(double length_mm, FrameWay way) {
    dMass mass;
    dMassSetSphereTotal(&mass, held_mass_g, drawn_radius_mm);
    dBodySetMass(load_, &mass);
    dBodySetGravityMode(load_, 0);
    const double from_mm = -dBodyGetPosition(load_)[1];
    constexpr double speed_mm_per_s = 150;
    const double duration_s = std::max(std::abs(length_mm - from_mm) / speed_mm_per_s, simulation_.stepS());
    const auto count = static_cast<int>(std::ceil(duration_s / simulation_.stepS()));
    for (int i = 0; i < count; ++i) stepHeld((from_mm - length_mm) / (count * simulation_.stepS()));
    constexpr int rest_count = 10;
    double force_N = 0;
    for (int i = 0; i < rest_count; ++i) force_N = stepHeld(0);
    return read(std::abs(force_N), way, true);
  }

  Actuator::LengthRange range() { return muscle().straightLengthRange(); }

 private:
  static constexpr double least_load_kg = 1e-3, drawn_radius_mm = 20;
  /// 1000 N give it a speed of 1e-5 mm/s in a step of 10 ms.
  static constexpr double held_mass_g = 1e12;

  /// One step with the held end at this speed, upwards. Returns the force on it in N, upwards.
  double stepHeld(double speed_mm_per_s) {
    dBodySetLinearVel(load_, 0, speed_mm_per_s, 0);
    simulation_.step();
    const double gained_mm_per_s = dBodyGetLinearVel(load_)[1] - speed_mm_per_s;
    return held_mass_g * gained_mm_per_s / simulation_.stepS() / simulation_.physics().force_per_N;
  }

  static SimulationOptions optionsFor(const FrameSpecimen& specimen, const Parameters& parameters) {
    SimulationOptions options;
    options.stepper = StepperKind::chain;
    options.substeps = 10;
    options.parameters = parameters;
    options.parameters.set("rig.minimum_length_mm", specimen.minimum_mm, "specimen");
    options.parameters.set("rig.maximum_length_mm", specimen.maximum_mm, "specimen");
    options.parameters.set("rig.load_kg", least_load_kg, "experiment");
    return options;
  }

  Actuator& muscle() { return *rig_.actuators().front(); }

  bool waitForRest() {
    constexpr double still_mm = 1e-4;
    constexpr int enough_steps = 15, most_steps = 600;
    double last_mm = muscle().lengthMm(), last_speed = 0;
    int still_steps = 0;
    for (int i = 0; i < most_steps && still_steps < enough_steps; ++i) {
      simulation_.step();
      const double speed = std::abs(dBodyGetLinearVel(load_)[1]);
      if (speed < last_speed) simulation_.stop();
      last_speed = speed < last_speed ? 0 : speed;
      still_steps = std::abs(muscle().lengthMm() - last_mm) < still_mm ? still_steps + 1 : 0;
      last_mm = muscle().lengthMm();
    }
    return still_steps == enough_steps;
  }

  FramePoint read(double force_N, FrameWay way, bool at_rest) {
    FramePoint point;
    point.pressure_ratio = pressure_ratio_;
    point.length_mm = muscle().lengthMm();
    point.force_N = force_N;
    point.law_N = muscle().calculateForce(pressure_ratio_, point.length_mm);
    point.way = way;
    point.at_rest = at_rest;
    point.link_count = static_cast<int>(muscle().links().size());
    for (const Link& link : muscle().links()) {
      constexpr double touching_mm = 0.05;
      const dJointID slider = link.slider->id();
      const double position_mm = dJointGetSliderPosition(slider);
      point.long_stop_count += position_mm < dJointGetSliderParam(slider, dParamLoStop) + touching_mm;
      point.short_stop_count += position_mm > dJointGetSliderParam(slider, dParamHiStop) - touching_mm;
    }
    return point;
  }

  Simulation simulation_;
  Robot& rig_;
  double pressure_ratio_;
  dBodyID load_ = nullptr;
};

/// Calls `measure(frame, i, way)` for i = 0 .. 10 and back to 0 at each pressure, on all cores.
template <class Measure>
std::vector<FramePoint> thereAndBack(const FrameSpecimen& specimen, const Parameters& parameters, const std::vector<double>& pressures,
                                     const Measure& measure) {
  std::vector<std::vector<FramePoint>> points(pressures.size());
  parallelFor(static_cast<int>(pressures.size()), 0, [&](int index) {
    const auto k = static_cast<std::size_t>(index);
    Frame frame(specimen, pressures[k], parameters);
    for (int i = 0; i <= step_count; ++i) points[k].push_back(measure(frame, i, FrameWay::loading));
    for (int i = step_count - 1; i >= 0; --i) points[k].push_back(measure(frame, i, FrameWay::unloading));
  });
  std::vector<FramePoint> all;
  for (const auto& at_pressure : points) all.insert(all.end(), at_pressure.begin(), at_pressure.end());
  return all;
}

}  // namespace

const std::vector<FrameSpecimen>& frameSpecimens() {
  static const std::vector<FrameSpecimen> specimens = {{"short", 60, 200}, {"medium", 75, 300}, {"long", 60, 350}};
  return specimens;
}

std::vector<double> framePressures() {
  constexpr int code_step = 32, code_largest = 255;
  std::vector<double> pressures;
  for (int code = 0; code < code_largest; code += code_step) pressures.push_back(static_cast<double>(code) / code_largest);
  pressures.push_back(1);
  return pressures;
}

std::vector<double> frameLoadsKg() {
  constexpr double heaviest_kg = 8.7;
  std::vector<double> loads_kg;
  for (int i = 0; i <= step_count; ++i) loads_kg.push_back(heaviest_kg * i / step_count);
  return loads_kg;
}

std::vector<FramePoint> loadSteps(const FrameSpecimen& specimen, const Parameters& parameters, const std::vector<double>& pressures) {
  const auto loads_kg = frameLoadsKg();
  return thereAndBack(specimen, parameters, pressures,
                      [&](Frame& frame, int i, FrameWay way) { return frame.hang(loads_kg[static_cast<std::size_t>(i)], way); });
}

std::vector<FramePoint> lengthSteps(const FrameSpecimen& specimen, const Parameters& parameters, const std::vector<double>& pressures) {
  return thereAndBack(specimen, parameters, pressures, [](Frame& frame, int i, FrameWay way) {
    constexpr double margin_ratio = 0.02;  // keeps clear of the stops at both ends
    const auto range = frame.range();
    const double share = margin_ratio + (1 - 2 * margin_ratio) * i / step_count;
    return frame.hold(range.shortest_mm + share * (range.longest_mm - range.shortest_mm), way);
  });
}

double frameError(const std::vector<FramePoint>& points) {
  double off = 0, total = 0;
  for (const auto& point : points) {
    off += (point.force_N - point.law_N) * (point.force_N - point.law_N);
    total += point.force_N * point.force_N;
  }
  return total > 0 ? off / total : 0;
}

}  // namespace musclesim
