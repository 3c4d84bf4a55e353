// Look-alikes: fits data made with one effect by another effect. For every pair of the catalogue's list there is one recording that cannot
// tell the two apart and one that can. The number is the largest RMSE of any measured signal over its noise after the best fit of the
// look-alike; below 1 the difference is hidden in the noise. Usage: effect_pairs [--document docs/reference/effects.md]
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "effect_recordings.h"
#include "musclesim/base/error.h"
#include "study.h"

using namespace musclesim;
using study::recordingOf;
using study::wave;

namespace {

struct Setup {
  Recording commands;
  std::vector<std::string> signals;  ///< measured
  std::string words;
};

/// An effect with the parameters that a fit may change and their start values.
struct Candidate {
  ActiveEffect effect;
  std::vector<std::string> free = {};
  std::vector<double> start = {}, step = {};
};

struct Pair {
  ActiveEffect truth;
  Candidate look_alike;
  Setup hidden, telling;
};

double misfit(const Recording& a, const Recording& b, const std::vector<std::string>& signals) {
  double largest = 0;
  for (const SignalError& error : compareSignals(a, b))
    if (std::find(signals.begin(), signals.end(), error.name) != signals.end())
      largest = std::max(largest, error.rmse / study::noiseOf(error.name));
  return largest;
}

/// Compass search, starting from the best of several values of the first parameter: tries a step along each parameter and halves the steps
/// when none helps.
double bestFit(const Setup& setup, const Recording& data, const Candidate& candidate) {
  auto trial = [&](const std::vector<double>& values) {
    ActiveEffect effect = candidate.effect;
    for (std::size_t i = 0; i < values.size(); ++i) effect.parameters[candidate.free[i]] = values[i];
    try {
      return misfit(study::simulate(setup.commands, {effect}), data, setup.signals);
    } catch (const BadParameter&) {
      return 1e9;  // out of range
    }
  };
  std::vector<double> best = candidate.start, step = candidate.step;
  double best_value = trial(best);
  for (const double steps : {-1.3, -1.0, -0.66, -0.33, 1.0, 2.0, 4.0}) {
    std::vector<double> other = candidate.start;
    other[0] += steps * step[0];
    if (const double value = trial(other); value < best_value) {
      best_value = value;
      best = other;
    }
  }
  constexpr int halvings = 9;
  for (int halving = 0; halving < halvings;) {
    bool better = false;
    for (std::size_t i = 0; i < best.size(); ++i)
      for (const double sign : {1.0, -1.0}) {
        std::vector<double> next = best;
        next[i] += sign * step[i];
        const double value = trial(next);
        if (value >= best_value) continue;
        best = next;
        best_value = value;
        better = true;
      }
    if (better) continue;
    ++halving;
    for (double& s : step) s /= 2;
  }
  return best_value;
}

/// A slow wave with a gentle start, so that it excites no vibrations.
Recording elbowWave(double amplitude, double both = 0.4) {
  constexpr double frequency_Hz = 0.2, rise_s = 1.5;
  return recordingOf("elbow", 10, [=](double t) {
    const double now = amplitude * (1 - std::exp(-t * t / (rise_s * rise_s))) * wave(frequency_Hz, t);
    return Action{both + now, both - now};
  });
}

/// The same with viscous instead of dry friction in the chains: dry friction would tell a delay from damping even in slow motion.
Recording smoothElbowWave() {
  Recording recording = elbowWave(0.02);
  recording.info.robot_parameters["muscle.joint_friction"] = "viscous";
  return recording;
}

Recording coContraction() {
  return recordingOf("elbow", 6, [](double t) {
    const double both = 0.15 + 0.1 * t, difference = 0.06 * wave(0.7, t);
    return Action{both + difference, both - difference};
  });
}

Recording rigHolds() {
  return recordingOf("rig", 4, [](double) { return Action{0.5}; });
}

Recording rigSteps() {
  return recordingOf("rig", 5, [](double t) { return Action{std::fmod(t, 1) < 0.5 ? 0.35 : 0.65}; });
}

std::vector<Pair> pairs() {
  const std::vector<std::string> angle = {"angle_elbow_deg"},
                                 all = {"pressure_0",  "pressure_1",      "force_0_N", "force_1_N", "length_0_mm",
                                        "length_1_mm", "angle_elbow_deg", "hand_x_mm", "hand_y_mm"},
                                 pressure_angle = {"pressure_0", "pressure_1", "angle_elbow_deg"};
  const Setup smooth_wave{smoothElbowWave(), angle, "elbow, wave of 0.02 at 0.2 Hz, angle; viscous friction in the muscles"};
  const Setup small_wave{elbowWave(0.02), angle, "elbow, wave of 0.02 at 0.2 Hz, angle"};
  const Setup rich{study::standardElbow(), all, "elbow, standard recording, all signals"};
  const Setup rich_angle{study::standardElbow(), angle, "elbow, standard recording, angle"};
  const Setup rich_pressure{study::standardElbow(), pressure_angle, "elbow, standard recording, pressure and angle"};
  const ActiveEffect lag{"valve_lag", "all", {{"fill_time_constant_s", 0.03}, {"vent_time_constant_s", 0.03}}};
  const Candidate viscous{{"viscous_loss", "all", {}}, {"damping_Ns_per_m"}, {6}, {4}};
  const Candidate oil{{"joint_viscous_friction", "all", {}}, {"damping_Nms_per_rad"}, {0.012}, {0.008}};
  const Candidate thick_oil{{"joint_viscous_friction", "all", {}}, {"damping_Nms_per_rad"}, {0.08}, {0.05}};
  const ActiveEffect viscous_truth{"viscous_loss", "all", {{"damping_Ns_per_m", 40.0}}};
  const Candidate late_angle{{"sensor_delay", "signal_angle_elbow", {}}, {"delay_s"}, {0.03}, {0.02}};
  const Candidate pressure_gain{{"pressure_calibration", "all", {}}, {"gain"}, {1.0}, {0.05}};
  const Candidate antagonist_creep{{"creep", "muscle_1", {}}, {"amount", "time_constant_s"}, {0.03, 1}, {0.02, 0.5}};
  const Candidate dry{{"joint_coulomb_friction", "all", {}}, {"torque_Nm"}, {0.05}, {0.04}};
  const Candidate start{{"attachment_offset", "muscle_0", {}}, {"offset_mm"}, {5}, {10}};
  const Candidate weak{{"force_gain", "all", {}}, {"gain"}, {0.9}, {0.1}};
  const Candidate push{{"external_force", "hand", {}}, {"force_x_N"}, {0.3}, {0.3}};
  const Candidate bias{{"sensor_bias", "signal_angle_elbow", {}}, {"offset"}, {1}, {2}};
  const ActiveEffect tilt{"base_tilt", "base", {{"tilt_z_deg", 4.0}}};
  const Setup still{elbowWave(0), angle, "elbow, held still, angle"};
  return {
      {lag, viscous, smooth_wave, rich},
      {lag, oil, smooth_wave, rich},
      {viscous_truth, thick_oil, smooth_wave, rich},
      {{"transport_delay", "all", {{"delay_s", 0.05}}}, late_angle, rich_angle, rich_pressure},
      {{"force_gain", "all", {{"gain", 0.9}}}, pressure_gain, small_wave, rich_pressure},
      {{"leak", "muscle_0", {{"leak_per_s", 0.3}}}, antagonist_creep, still, rich_pressure},
      {{"braid_hysteresis", "all", {{"relative_width", 0.03}, {"presliding_mm", 0.05}}},
       dry,
       {elbowWave(0.02), pressure_angle, "elbow, wave of 0.02 at 0.2 Hz, pressure and angle"},
       {coContraction(), pressure_angle, "elbow, co-contraction 0.15 .. 0.75, pressure and angle"}},
      {{"length_offset", "muscle_0", {{"offset_mm", 1.0}}},
       start,
       {elbowWave(0.003), pressure_angle, "elbow, wave of 0.003 at 0.2 Hz, pressure and angle"},
       rich},
      {{"payload", "hand", {{"mass_kg", 0.2}}},
       weak,
       {rigHolds(), {"length_0_mm"}, "rig, held still, length"},
       {rigSteps(), {"length_0_mm", "force_0_N"}, "rig, steps, length and force"}},
      {tilt, push, small_wave, rich},
      {tilt, bias, still, rich},
      {{"external_force", "hand", {{"force_x_N", 0.5}}}, bias, still, rich},
  };
}

std::string nameOf(const ActiveEffect& effect) {
  return fmt::format("`{}`", effect.id);
}

}  // namespace

int main(int count, char** arguments) {
  std::string table =
      "| data made with | explained by | cannot be told apart in | left, in units of noise | can be told apart in | left, in units of "
      "noise |\n"
      "|---|---|---|---|---|---|\n";
  for (const Pair& pair : pairs()) {
    std::string row = fmt::format("| {} | {} |", nameOf(pair.truth), nameOf(pair.look_alike.effect));
    for (const Setup* setup : {&pair.hidden, &pair.telling}) {
      const Recording data = study::simulate(setup->commands, {pair.truth});
      const double clean = misfit(study::simulate(setup->commands, {}), data, setup->signals);
      row += fmt::format(" {} | {:.2f} (without any effect {:.1f}) |", setup->words, bestFit(*setup, data, pair.look_alike), clean);
    }
    std::fprintf(stderr, "%s\n", row.c_str());
    table += row + "\n";
  }
  if (count == 3 && std::strcmp(arguments[1], "--document") == 0)
    writeSection(arguments[2], "look-alikes", "effect_pairs", table);
  else
    fmt::print("{}", table);
}
