/// A made-up diagnosis of an elbow whose right muscle is slow, with curves, for tests of the report.
#pragma once

#include <cmath>
#include <string>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// Readings of one signal: a wave that the model without effects is ahead of.
inline Trace sampleTrace(const std::string& signal, int row_count, double size, bool has_after) {
  Trace trace{"fast.csv", signal, {}, {}, {}, {}};
  const auto wave = [&](double t) { return size * (3 + std::sin(2 * t)); };
  for (int row = 0; row < row_count; ++row) {
    const double t = 10.0 * row / (row_count - 1), noise = 0.01 * size * std::sin(37.0 * row * row);
    trace.time_s.push_back(t);
    trace.measured.push_back(wave(t) + noise);
    trace.before.push_back(wave(t + 0.1));
    if (has_after) trace.after.push_back(wave(t + 0.002));
  }
  return trace;
}

inline void addSampleSignal(Diagnosis& d, const std::string& signal, int row_count, double size) {
  d.before.per_signal[signal] = {0.14 * size, 0.007 * size};
  d.after.per_signal[signal] = {0.0075 * size, 0.007 * size};
  d.traces.push_back(sampleTrace(signal, row_count, size, true));
}

/// The answer "effects found" with two causes in one muscle and a third one at the hand.
inline Diagnosis sampleDiagnosis() {
  Diagnosis d;
  d.robot = "elbow";
  d.verdict = Verdict::effects_found;
  d.recordings = {"/data/day 1/slow.csv", "/data/day 1/fast.csv"};
  d.held_out = "fast.csv, held out from fitting and choosing";
  d.where = {{"pressure", "muscle_1", "", 0.7},
             {"command", "muscle_1", "", 0.3},
             {"force", "all", "", 0, true},
             {"body", "all", "", 0, true},
             {"sensor", "all", "", 0, true}};
  d.where_method = "the measured pressures differ from the commands";
  d.effects = {
      {"transport_delay", "muscle_1", 0.97, {{"delay_s", {0.025, 0.023, 0.027}}}, 40, 20},
      {"valve_lag",
       "muscle_1",
       0.98,
       {{"fill_time_constant_s", {0.04, 0.038, 0.042}}, {"vent_time_constant_s", {0.07, 0.066, 0.074}}, {"next_lag_ratio", {0, 0, 0}}},
       70,
       45},
      {"payload", "hand", 0.9, {{"mass_kg", {0.2, 0.19, 0.21}}}, 12, 10},
      {"leak", "muscle_0", 0.02, {{"leak_per_s", {3, -231303, 100000}}}, 5}};
  d.chosen = {"valve_lag@muscle_1", "transport_delay@muscle_1", "payload@hand"};
  d.explanations = {{d.chosen, 0.88}, {{"valve_lag@muscle_1", "transport_delay@muscle_1"}, 0.09}};
  d.none_of_these = 0.01;
  d.removal = {{"valve_lag@muscle_1", 30}, {"transport_delay@muscle_1", 12}, {"payload@hand", 3}};
  d.before.normalised = 400;
  d.after.normalised = 0.2;
  d.reduction_percent = 97;
  d.reduction_low_percent = 94;
  d.reduction_high_percent = 98.5;
  d.unexplained_percent = 3;
  d.nominal_refit_percent = 30;
  d.negative_control_percent = 5;
  d.refitted = {"elbow.forearm_kg"};
  d.phases = {{"filling", 12, 1.1}, {"venting", 18, 1.2}, {"holding", 3, 1}};
  d.not_excited = {"command_dead_band@all"};
  d.screenings = {{"valve_lag@muscle_1", 0.5}, {"leak@muscle_0", 0.1}};
  d.drawing.lines = {{"", {{0, 0}, {0, -250}}, 30}, {"muscle_0", {{-40, 0}, {-40, -200}}, 20}, {"muscle_1", {{40, 0}, {40, -200}}, 20}};
  d.drawing.points = {{"hand", {0, -250}}};
  d.tuned = {{"elbow.forearm_inertia_kgm2", "kg m2", 0.0123, {0.0131, 0.0128, 0.0134}, {0.0127, 0.0124, 0.0131}}};
  d.simulation_count = 1200;
  for (const char* signal : {"angle_elbow_deg", "length_0_mm", "length_1_mm"}) addSampleSignal(d, signal, 1001, 10);
  for (const char* signal : {"pressure_0", "pressure_1"}) addSampleSignal(d, signal, 1001, 0.1);
  return d;
}

}  // namespace musclesim
