#include "next_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "musclesim/error.h"
#include "parallel.h"

namespace musclesim {

namespace {

constexpr double duration_s = 12, step_s = 0.01;

/// A schedule: -1..1 for each muscle at a time, of the range that its command has in the recordings.
struct Excitation {
  std::string name, words;
  std::function<double(double time_s, int muscle)> shape;
};

double triangle(double time_s, double period_s) {
  const double phase = time_s / period_s - std::floor(time_s / period_s);
  return phase < 0.5 ? 4 * phase - 1 : 3 - 4 * phase;
}

double sign(int muscle) {
  return muscle % 2 == 0 ? 1 : -1;
}

/// Muscles with even and odd numbers move against each other unless the schedule is a co-contraction.
const std::vector<Excitation>& bank() {
  static const std::vector<Excitation> excitations = {
      {"slow reversals", "triangles of six seconds", [](double t, int m) { return sign(m) * triangle(t, 6); }},
      {"three speeds", "the same path in 6, 1.5 and 0.5 s",
       [](double t, int m) {
         return sign(m) * triangle(t, t < 6 ? 6 : t < 9 ? 1.5 : 0.5);
       }},
      {"steps of two sizes", "small ones, then large ones",
       [](double t, int m) { return sign(m) * (t < 6 ? 0.25 : 1) * (std::fmod(t, 3) < 1.5 ? 1 : -1); }},
      {"co-contraction", "all muscles filled and emptied together, slowly", [](double t, int) { return triangle(t, 6); }},
      {"vent and hold", "one side emptied for five seconds, then the other",
       [](double t, int m) { return t < 1   ? 0.0
                                    : t < 6 ? (m % 2 == 0 ? -1.0 : 1.0)
                                            : (m % 2 == 0 ? 1.0 : -1.0); }},
      {"one muscle at a time", "every second muscle for two seconds, then the others",
       [](double t, int m) { return static_cast<int>(t / 2) % 2 == m % 2 ? std::sin(std::numbers::pi * t) : 0.0; }},
  };
  return excitations;
}

struct CommandRange {
  double low = 1, high = 0;
};

/// The range of a muscle's command over all recordings: where the plant is known to go.
CommandRange rangeOf(const std::vector<Recording>& recordings, int muscle) {
  CommandRange range;
  for (const Recording& recording : recordings)
    for (const double u : recording.find(fmt::format("command_{}", muscle))->values) {
      range.low = std::min(range.low, u);
      range.high = std::max(range.high, u);
    }
  return range;
}

Recording scheduled(const std::vector<Recording>& recordings, const Excitation& excitation, double amplitude) {
  Recording recording;
  recording.info = recordings.front().info;
  recording.info.trial = excitation.name;
  for (int row = 0; row * step_s < duration_s; ++row) recording.time_s.push_back(row * step_s);
  for (int muscle = 0; muscle < recordings.front().muscleCount(); ++muscle) {
    const CommandRange range = rangeOf(recordings, muscle);
    Signal signal{fmt::format("command_{}", muscle), {}};
    for (const double t : recording.time_s)
      signal.values.push_back((range.low + range.high) / 2 + amplitude * (range.high - range.low) / 2 * excitation.shape(t, muscle));
    recording.signals.push_back(std::move(signal));
  }
  return recording;
}

/// How far two predictions differ.
struct Difference {
  double overall = 0;  ///< RMS over all signals and rows in units of the floor; 0 if one diverges
  std::string signal;  ///< that differs most
  double in_signal = 0;
};

Difference difference(const Plant& plant, const Prediction& a, const Prediction& b) {
  Difference result;
  if (a.diverged || b.diverged) return result;
  double sum = 0;
  long count = 0;
  for (std::size_t s = 0; s < plant.signals().size(); ++s) {
    const double floor = plant.signals()[s].floor.value;
    double own_sum = 0;
    long own_count = 0;
    for (std::size_t row = 0; row < a.values[s].size(); ++row) {
      const double d = (a.values[s][row] - b.values[s][row]) / floor;
      if (!std::isfinite(d)) continue;
      own_sum += d * d;
      ++own_count;
    }
    sum += own_sum;
    count += own_count;
    if (const double own = own_count ? std::sqrt(own_sum / static_cast<double>(own_count)) : 0; own > result.in_signal) {
      result.in_signal = own;
      result.signal = plant.signals()[s].name;
    }
  }
  result.overall = count ? std::sqrt(sum / static_cast<double>(count)) : 0;
  return result;
}

/// Whether a predicted signal stays where the plant has been, give or take a quarter of the range that it had there: beyond may be a stop.
bool staysInReach(const Plant& plant, const Prediction& prediction) {
  constexpr double further = 0.25;
  for (std::size_t s = 0; s < plant.signals().size(); ++s) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < plant.recordings().size(); ++i)
      for (const double y : plant.measured(static_cast<int>(i), static_cast<int>(s)))
        if (std::isfinite(y)) low = std::min(low, y), high = std::max(high, y);
    const double room = further * (high - low) + 4 * plant.signals()[s].floor.value;
    for (const double y : prediction.values[s])
      if (!(y > low - room && y < high + room)) return false;
  }
  return true;
}

/// The largest of a few shares of the commands' ranges with which the schedule stays in reach; the smallest if none does.
double safeAmplitude(const Plant& plant, const Excitation& excitation, const Model& model, Fidelity fidelity,
                     const OnSimulation& on_simulation) {
  constexpr double smaller = 0.7, smallest = 0.2;
  double amplitude = 1;
  for (; amplitude * smaller > smallest; amplitude *= smaller) {
    on_simulation();
    const Prediction prediction = plant.predictSchedule(scheduled(plant.recordings(), excitation, amplitude), model, fidelity);
    if (!prediction.diverged && staysInReach(plant, prediction)) break;
  }
  return amplitude;
}

}  // namespace

Experiment nextExperiment(const Plant& plant, const std::vector<std::string>& labels, const std::vector<Model>& models, Fidelity fidelity,
                          int job_count, const OnSimulation& on_simulation) {
  Experiment best;
  if (models.size() < 2) return best;
  const std::vector<Excitation>& excitations = bank();
  std::vector<double> amplitudes(excitations.size());
  std::vector<Recording> recordings(excitations.size());
  parallelFor(static_cast<int>(excitations.size()), job_count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    amplitudes[index] = safeAmplitude(plant, excitations[index], models.front(), fidelity, on_simulation);
    recordings[index] = scheduled(plant.recordings(), excitations[index], amplitudes[index]);
  });
  std::vector<Prediction> predictions(excitations.size() * models.size());
  parallelFor(static_cast<int>(predictions.size()), job_count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    predictions[index] = plant.predictSchedule(recordings[index / models.size()], models[index % models.size()], fidelity);
    on_simulation();
  });
  for (std::size_t e = 0; e < excitations.size(); ++e) {
    Difference smallest;
    smallest.overall = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < models.size(); ++a)
      for (std::size_t b = a + 1; b < models.size(); ++b)
        smallest = std::ranges::min(smallest, difference(plant, predictions[e * models.size() + a], predictions[e * models.size() + b]), {},
                                    &Difference::overall);
    if (smallest.overall <= best.difference) continue;
    best.difference = smallest.overall;
    best.schedule = excitations[e].name;
    best.amplitude = amplitudes[e];
    best.separates = labels;
    best.why = fmt::format("{} ({}); the predictions that are most alike differ by {:.1f} times the noise there, most in {} ({:.1f})",
                           excitations[e].name, excitations[e].words, smallest.overall, smallest.signal, smallest.in_signal);
    best.time_s = recordings[e].time_s;
    best.commands.assign(best.time_s.size(), {});
    for (const Signal& signal : recordings[e].signals)
      for (std::size_t row = 0; row < best.commands.size(); ++row) best.commands[row].push_back(signal.values[row]);
  }
  return best;
}

Recording experimentSchedule(const std::string& name, double amplitude, const std::vector<Recording>& recordings) {
  const auto found = std::ranges::find(bank(), name, &Excitation::name);
  if (found == bank().end()) throw BadParameter("schedule", name, "be one that a diagnosis proposed");
  return scheduled(recordings, *found, amplitude);
}

}  // namespace musclesim
