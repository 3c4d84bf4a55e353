#include "next_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "parallel.h"

namespace musclesim {

namespace {

constexpr double duration_s = 12, step_s = 0.01;

/// A schedule: the command of a muscle at a time.
struct Excitation {
  std::string name, why;
  std::function<double(double time_s, int muscle)> command;
};

double triangle(double time_s, double period_s) {
  const double phase = time_s / period_s - std::floor(time_s / period_s);
  return phase < 0.5 ? 4 * phase - 1 : 3 - 4 * phase;
}

double sign(int muscle) {
  return muscle % 2 == 0 ? 1 : -1;
}

/// Commands around 0.45; muscles with even and odd numbers move against each other unless the schedule is a co-contraction.
std::vector<Excitation> bank() {
  return {
      {"slow reversals", "loops that do not depend on speed stay, those that do vanish",
       [](double t, int m) { return 0.45 + sign(m) * 0.3 * triangle(t, 6); }},
      {"three speeds", "the same path at three speeds separates what depends on speed",
       [](double t, int m) {
         return 0.45 + sign(m) * 0.3 * triangle(t, t < 6 ? 6 : t < 9 ? 1.5 : 0.5);
       }},
      {"steps of two sizes", "a rate limit shows at large steps only, a lag at all",
       [](double t, int m) { return 0.45 + sign(m) * (t < 6 ? 0.08 : 0.35) * (std::fmod(t, 3) < 1.5 ? 1 : -1); }},
      {"co-contraction", "pressure changes while the pose hardly does", [](double t, int) { return 0.45 + 0.35 * triangle(t, 6); }},
      {"vent and hold", "what creeps or leaks goes on while the command rests",
       [](double t, int m) { return t < 1   ? 0.5
                                    : t < 6 ? (m % 2 == 0 ? 0.0 : 0.8)
                                            : (m % 2 == 0 ? 0.8 : 0.0); }},
      {"one muscle at a time", "what one muscle's command does to the others' signals",
       [](double t, int m) { return 0.4 + (static_cast<int>(t / 2) % 2 == m % 2 ? 0.3 * std::sin(std::numbers::pi * t) : 0.0); }},
  };
}

Recording scheduled(const Plant& plant, const Excitation& excitation) {
  Recording recording;
  recording.info = plant.recordings().front().info;
  recording.info.trial = excitation.name;
  for (int row = 0; row * step_s < duration_s; ++row) recording.time_s.push_back(row * step_s);
  for (int muscle = 0; muscle < plant.muscleCount(); ++muscle) {
    Signal signal{fmt::format("command_{}", muscle), {}};
    for (const double t : recording.time_s) signal.values.push_back(std::clamp(excitation.command(t, muscle), 0.0, 1.0));
    recording.signals.push_back(std::move(signal));
  }
  return recording;
}

/// RMS difference over all signals and rows in units of the floor; 0 if one diverges.
double difference(const Plant& plant, const Prediction& a, const Prediction& b) {
  if (a.diverged || b.diverged) return 0;
  double sum = 0;
  long count = 0;
  for (std::size_t s = 0; s < plant.signals().size(); ++s) {
    const double floor = plant.signals()[s].floor.value;
    for (std::size_t row = 0; row < a.values[s].size(); ++row) {
      const double d = (a.values[s][row] - b.values[s][row]) / floor;
      if (!std::isfinite(d)) continue;
      sum += d * d;
      ++count;
    }
  }
  return count ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

}  // namespace

Experiment nextExperiment(const Plant& plant, const std::vector<std::string>& labels, const std::vector<Model>& models, int job_count,
                          const OnSimulation& on_simulation) {
  Experiment best;
  if (models.size() < 2) return best;
  const std::vector<Excitation> excitations = bank();
  std::vector<Recording> recordings;
  for (const Excitation& excitation : excitations) recordings.push_back(scheduled(plant, excitation));
  std::vector<Prediction> predictions(excitations.size() * models.size());
  parallelFor(static_cast<int>(predictions.size()), job_count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    predictions[index] = plant.predictSchedule(recordings[index / models.size()], models[index % models.size()]);
    on_simulation();
  });
  for (std::size_t e = 0; e < excitations.size(); ++e) {
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < models.size(); ++a)
      for (std::size_t b = a + 1; b < models.size(); ++b)
        smallest = std::min(smallest, difference(plant, predictions[e * models.size() + a], predictions[e * models.size() + b]));
    if (smallest <= best.difference) continue;
    best.difference = smallest;
    best.separates = labels;
    best.why = fmt::format("{}: {}; the predictions that are most alike differ by {:.1f} times the noise", excitations[e].name,
                           excitations[e].why, smallest);
    best.time_s = recordings[e].time_s;
    best.commands.assign(best.time_s.size(), {});
    for (const Signal& signal : recordings[e].signals)
      for (std::size_t row = 0; row < best.commands.size(); ++row) best.commands[row].push_back(signal.values[row]);
  }
  return best;
}

}  // namespace musclesim
