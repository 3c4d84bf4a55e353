/// Standard recordings for studies of effects: their commands and the assumed noise of the sensors.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "musclesim/effect/catalogue.h"
#include "musclesim/simulation/replay.h"

namespace musclesim::study {

/// Commands over time for all muscles of a robot, 100 rows per second.
inline Recording recordingOf(const std::string& robot, double duration_s, const std::function<Action(double)>& command) {
  constexpr double interval_s = 0.01;
  Recording recording;
  recording.info.robot = robot;
  for (std::size_t i = 0; i < command(0).size(); ++i) recording.signals.push_back({"command_" + std::to_string(i), {}});
  for (long row = 0; row <= std::lround(duration_s / interval_s); ++row) {
    const double time_s = static_cast<double>(row) * interval_s;
    recording.time_s.push_back(time_s);
    const Action action = command(time_s);
    for (std::size_t i = 0; i < action.size(); ++i) recording.signals[i].values.push_back(action[i]);
  }
  return recording;
}

inline double wave(double frequency_Hz, double time_s) {
  return std::sin(2 * std::numbers::pi * frequency_Hz * time_s);
}

/// A triangle wave between 0 and 1 with the given period, starting at 0.
inline double triangle(double period_s, double time_s) {
  const double phase = time_s / period_s - std::floor(time_s / period_s);
  return phase < 0.5 ? 2 * phase : 2 - 2 * phase;
}

/// Slow triangle, steps, fast wave: 2 s each. Between -1 and 1.
inline double standardShape(double t) {
  if (t < 2) return 2 * triangle(2, t + 0.5) - 1;
  if (t < 4) return std::fmod(t, 1) < 0.5 ? 0.8 : -0.8;
  return 0.3 * wave(2, t);
}

inline Recording standardRig(double middle = 0.45) {
  return recordingOf("rig", 6, [=](double t) { return Action{middle + 0.2 * standardShape(t)}; });
}

/// Flexor and extensor in opposition, with growing co-contraction.
inline Recording standardElbow() {
  return recordingOf("elbow", 6, [](double t) {
    const double both = 0.3 + 0.02 * t, difference = 0.05 * standardShape(t);
    return Action{both + difference, both - difference};
  });
}

/// Standard deviation of a sensor's noise, by the measured quantity.
inline double noiseOf(const std::string& signal) {
  if (signal.starts_with("pressure_")) return 0.003;
  if (signal.starts_with("force_")) return 0.5;
  if (signal.starts_with("hand_")) return 0.3;
  return 0.08;  // mm or deg
}

inline Recording simulate(const Recording& commands, const std::vector<ActiveEffect>& effects) {
  ReplayOptions options;
  options.effects = effects;
  return replayRecording(commands, options).simulated;
}

/// The effect with the strength used in figures and tables: the upper end of the usual range, or a little more if that would not be
/// visible.
inline ActiveEffect shownEffect(const EffectInfo& info, const std::string& component) {
  if (info.id == "channel_swap") return {info.id, component, {}};
  if (info.id == "command_quantisation") return {info.id, component, {{"bits", 4.0}}};
  if (info.id == "command_dead_band") return {info.id, component, {{"threshold", 0.35}}};
  if (info.id == "flow_limit") return {info.id, component, {{"fill_rate_per_s", 1.0}, {"vent_rate_per_s", 0.6}}};
  if (info.id == "leak") return {info.id, component, {{"leak_per_s", 2.0}}};
  if (info.id == "viscous_loss") return {info.id, component, {{"damping_Ns_per_m", 150.0}}};
  if (info.id == "series_elasticity") return {info.id, component, {{"stiffness_N_per_mm", 1.0}}};
  if (info.id == "joint_coulomb_friction") return {info.id, component, {{"torque_Nm", 0.05}}};
  if (info.id == "slide_friction") return {info.id, component, {{"force_N", 3.0}}};
  if (info.id == "force_drift") return {info.id, component, {{"rate_per_min", -2.0}}};
  if (info.id == "force_law") return {info.id, component, {{"law", "chou-hannaford"}}};
  if (info.id == "joint_stop_offset") return {info.id, component, {{"offset_deg", -60.0}}};
  if (info.id == "contact") return {info.id, component, {{"stiffness_Nm_per_deg", 0.3}, {"plane_deg", 5.0}}};
  if (info.id == "base_tilt") return {info.id, component, {{"tilt_z_deg", 8.0}}};
  if (info.id == "external_force") return {info.id, component, {{"force_x_N", 0.5}}};
  if (info.id == "payload") return {info.id, component, {{"mass_kg", 0.3}}};
  if (info.id == "creep") return {info.id, component, {{"amount", 0.2}, {"time_constant_s", 1.0}}};
  if (info.id == "sensor_dropout") return {info.id, component, {{"fraction", 0.3}, {"mean_gap_samples", 8.0}}};
  std::vector<double> values;
  for (const EffectParameter& p : info.parameters) values.push_back(p.shape ? p.neutral : p.usual_high);
  return activeEffect(info, component, values);
}

}  // namespace musclesim::study
