#include "next_experiment.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "../../base/parallel.h"
#include "../fit/comparison.h"
#include "../model/parity.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/simulation.h"
#include "schedule.h"

namespace musclesim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nats_per_misfit = 24;  ///< of all recordings together, per mean log misfit
constexpr double scatter = 4;           ///< noise sigmas by which readings scatter
constexpr double worth_it = 0.05;       ///< least share of its largest possible worth that a schedule must have to be proposed
constexpr double apart = 0.5;           ///< least difference, in noise sigmas, of rivals that a schedule is said to separate

/// An interval of a signal's values; initially empty.
struct Span {
  double low = infinity, high = -infinity;
  void include(double value) { low = std::min(low, value), high = std::max(high, value); }
  bool holds(double value) const { return value >= low && value <= high; }
};
using Spans = std::map<std::string, Span>;

/// The range of an angle or a length between its stops, and its value as built.
struct Travel {
  Span stops;
  double built;
};

std::map<std::string, Travel> travelsOf(Simulation& model) {
  std::map<std::string, Travel> travels;
  for (const Robot::Angle& angle : model.robot().angles()) {
    const auto [low, high] = angle.joint->stopsDeg(angle.axis);
    travels["angle_" + angle.name + "_deg"] = {{low, high}, angle.joint->angleDeg(angle.axis)};
  }
  for (std::size_t i = 0; i < model.world().actuators().size(); ++i) {
    const Actuator& actuator = *model.world().actuators()[i];
    travels[fmt::format("length_{}_mm", i)] = {{actuator.minimumLengthMm(), actuator.maximumLengthMm()}, actuator.lengthMm()};
  }
  return travels;
}

/// Allowed intervals of positions. Measured positions may exceed their recorded range by a quarter of it. All keep a thirtieth of their
/// travel from the stops, except where they have been recorded or are as built; there they may exceed that by a hundredth, since a part
/// that rests on a stop is pressed into it.
Spans roomsOf(const Plant& plant) {
  constexpr double farther = 0.25, margin = 1.0 / 30, pressed_in = 0.01;
  Spans been, rooms;
  for (std::size_t s = 0; s < plant.signals().size(); ++s) {
    const ComparedSignal& signal = plant.signals()[s];
    if (!isMotion(signal.name)) continue;
    Span& span = been[signal.name];
    for (std::size_t i = 0; i < plant.recordings().size(); ++i)
      for (const double y : plant.measured(static_cast<int>(i), static_cast<int>(s)))
        if (std::isfinite(y)) span.include(y - scatter * signal.sigma.value), span.include(y + scatter * signal.sigma.value);
    const double more = farther * (span.high - span.low);
    rooms[signal.name] = {span.low - more, span.high + more};
  }
  for (const auto& [name, travel] : travelsOf(plant.model())) {
    const double whole = travel.stops.high - travel.stops.low;
    if (!std::isfinite(whole)) continue;
    been[name].include(travel.built);
    Span& room = rooms.try_emplace(name, Span{-infinity, infinity}).first->second;
    room.low = std::max(room.low, std::min(travel.stops.low + margin * whole, been[name].low - pressed_in * whole));
    room.high = std::min(room.high, std::max(travel.stops.high - margin * whole, been[name].high + pressed_in * whole));
  }
  return rooms;
}

bool keepsWithin(const Spans& rooms, const Recording& predicted) {
  return std::ranges::all_of(rooms, [&](const auto& room) {
    const Signal* signal = predicted.find(room.first);
    return !signal || std::ranges::all_of(signal->values, [&](double value) { return room.second.holds(value); });
  });
}

/// A schedule with the predictions of the rivals.
struct TriedSchedule {
  ScheduleChoice choice;
  Recording commands;
  std::vector<Recording> predicted;  ///< one per rival; fewer if one of them would move too far
  std::optional<Recording> nominal;  ///< without effects; empty if the model diverges
};

/// The schedule at the largest of a few amplitudes at which all rivals stay within the allowed intervals.
TriedSchedule triedOut(const Plant& plant, ScheduleChoice choice, const std::vector<Rival>& rivals, const Spans& rooms, Fidelity fidelity,
                       const OnSimulation& on_simulation) {
  constexpr double smaller = 0.7, smallest = 0.2;
  TriedSchedule trial;
  for (; choice.amplitude > smallest && trial.predicted.size() < rivals.size(); choice.amplitude *= smaller) {
    trial = {choice, scheduled(choice, plant.recordings()), {}, {}};
    for (const Rival& rival : rivals) {
      std::optional<Recording> predicted = plant.predictSchedule(trial.commands, rival.model, fidelity);
      on_simulation();
      if (!predicted || !keepsWithin(rooms, *predicted)) break;
      trial.predicted.push_back(std::move(*predicted));
    }
  }
  if (trial.predicted.size() == rivals.size()) trial.nominal = plant.predictSchedule(trial.commands, Model{}, fidelity);
  return trial;
}

/// The readings under a schedule and their block averages in units of their sigmas: signal after signal, readings first.
class InSigmas {
 public:
  InSigmas(const Plant& plant, const Recording& commands)
      : plant_(plant),
        row_count_(static_cast<Eigen::Index>(commands.time_s.size())),
        block_count_(row_count_ / static_cast<Eigen::Index>(averaging_rows)),
        signal_count_(static_cast<Eigen::Index>(plant.signals().size())) {
    for (std::size_t s = 0; s < plant.signals().size(); ++s) {
      double sigma = 1;
      for (std::size_t i = 0; i < plant.recordings().size() && plant.signals()[s].sigma.source != NoiseSigma::Source::repeats; ++i)
        sigma = std::min(sigma, averagedShareOfSigma(plant.measured(static_cast<int>(i), static_cast<int>(s))));
      averaged_sigmas_.push_back(sigma);
    }
  }

  /// a - b
  Eigen::VectorXd difference(const Recording& a, const Recording& b) const {
    Eigen::VectorXd result(signal_count_ * perSignal());
    for (Eigen::Index s = 0; s < signal_count_; ++s) {
      const ComparedSignal& signal = plant_.signals()[static_cast<std::size_t>(s)];
      auto readings = result.segment(s * perSignal(), row_count_);
      readings = (valuesOf(a, signal) - valuesOf(b, signal)) / signal.sigma.value;
      for (Eigen::Index k = 0; k < block_count_; ++k)
        result[s * perSignal() + row_count_ + k] = meanOfBlock(result, s * perSignal(), k) / averaged_sigmas_[static_cast<std::size_t>(s)];
    }
    return result;
  }
  /// Scales every part so that mean square 1 becomes length 1.
  Eigen::VectorXd perPart(const Eigen::VectorXd& difference) const {
    Eigen::VectorXd result = difference;
    for (Eigen::Index s = 0; s < signal_count_; ++s) {
      result.segment(s * perSignal(), row_count_) /= std::sqrt(static_cast<double>(row_count_));
      result.segment(s * perSignal() + row_count_, block_count_) /= std::sqrt(static_cast<double>(block_count_));
    }
    return result;
  }
  double meanSquare(const Eigen::VectorXd& difference, Eigen::Index signal) const {
    return difference.segment(signal * perSignal(), row_count_).squaredNorm() / static_cast<double>(row_count_);
  }
  /// Mean over signals and averages of ln(RMS / sigma), where sigma combines the noise and the share of the gap that the right cause may
  /// leave because its law differs from ours.
  double logMisfit(const Eigen::VectorXd& difference, const Eigen::VectorXd& gap) const {
    const double mismatch = tolerances.front().share_of_gap;
    double sum = 0;
    for (Eigen::Index s = 0; s < signal_count_; ++s) {
      auto add = [&](Eigen::Index first, Eigen::Index count) {
        sum += 0.5 * std::log1p(difference.segment(first, count).squaredNorm() /
                                (static_cast<double>(count) + mismatch * mismatch * gap.segment(first, count).squaredNorm()));
      };
      add(s * perSignal(), row_count_);
      add(s * perSignal() + row_count_, block_count_);
    }
    return sum / static_cast<double>(2 * signal_count_);
  }

 private:
  Eigen::Index perSignal() const { return row_count_ + block_count_; }
  Eigen::Map<const Eigen::VectorXd> valuesOf(const Recording& recording, const ComparedSignal& signal) const {
    return {recording.find(signal.name)->values.data(), row_count_};
  }

  const Plant& plant_;
  Eigen::Index row_count_, block_count_, signal_count_;
  std::vector<double> averaged_sigmas_;  ///< in units of sigma, as in Comparison
};

/// Derivatives of the readings under a schedule with respect to each rival's parameters; without columns if not computed.
using Slopes = std::vector<Eigen::MatrixXd>;

Slopes slopesOf(const Plant& plant, const TriedSchedule& trial, const std::vector<Rival>& rivals, Fidelity fidelity, int job_count,
                const OnSimulation& on_simulation) {
  const InSigmas in_sigmas(plant, trial.commands);
  Slopes slopes(rivals.size());
  parallelFor(static_cast<int>(rivals.size()), job_count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const Rival& rival = rivals[index];
    const Recording& predicted = trial.predicted[index];
    slopes[index].resize(in_sigmas.difference(predicted, predicted).size(), static_cast<Eigen::Index>(rival.beside.size()));
    parallelFor(static_cast<int>(rival.beside.size()), job_count, [&](int k) {
      const auto moved = plant.predictSchedule(trial.commands, rival.beside[static_cast<std::size_t>(k)], fidelity);
      on_simulation();
      slopes[index].col(k) = in_sigmas.difference(moved ? *moved : predicted, predicted);
    });
  });
  return slopes;
}

/// The part of a difference that remains after the rival has been refitted to its recordings and that difference together.
Eigen::VectorXd leftBy(const Rival& rival, const Eigen::MatrixXd& slopes, const InSigmas& in_sigmas, const Eigen::VectorXd& difference) {
  if (slopes.cols() == 0) return difference;
  Eigen::MatrixXd both(rival.slopes.rows() + slopes.rows(), slopes.cols());
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) both.col(k) << rival.slopes.col(k), in_sigmas.perPart(slopes.col(k));
  Eigen::VectorXd aim(both.rows());
  aim << Eigen::VectorXd::Zero(rival.slopes.rows()), in_sigmas.perPart(difference);
  Eigen::MatrixXd normal = both.transpose() * both;
  normal.diagonal().array() += 1e-9 * (1 + normal.diagonal().maxCoeff());
  return difference - slopes * normal.ldlt().solve(both.transpose() * aim);
}

/// Difference between a rival's prediction and that of the most probable one.
struct Difference {
  double overall = infinity;  ///< RMS over all signals and rows in units of sigma
  std::string signal;         ///< the signal that differs most
  double in_signal = 0;
};

Difference differenceOf(const Plant& plant, const InSigmas& in_sigmas, const Eigen::VectorXd& difference) {
  double sum = 0, largest = 0;
  std::size_t most = 0;
  for (std::size_t s = 0; s < plant.signals().size(); ++s) {
    const double mean_square = in_sigmas.meanSquare(difference, static_cast<Eigen::Index>(s));
    sum += mean_square;
    if (mean_square > largest) largest = mean_square, most = s;
  }
  return {std::sqrt(sum / static_cast<double>(plant.signals().size())), plant.signals()[most].name, std::sqrt(largest)};
}

/// What a recording of a schedule would tell. `told`: its worth; `largest`: the worth of a schedule that tells all rivals apart for
/// certain; `from_likeliest`: by rival, the difference from the most probable one, which itself has 0.
struct Worth {
  double told = 0, largest = 0;
  std::vector<Difference> from_likeliest;
};

Worth worthOf(const Plant& plant, const TriedSchedule& trial, const std::vector<Rival>& rivals, const Slopes& slopes) {
  const double per_log_misfit = nats_per_misfit / (static_cast<double>(plant.split().fit.size()) + 1);
  const InSigmas in_sigmas(plant, trial.commands);
  const Recording& likeliest = trial.predicted.front();
  const Eigen::VectorXd gap = in_sigmas.difference(likeliest, trial.nominal ? *trial.nominal : likeliest);
  double all = 0;
  for (const Rival& rival : rivals) all += rival.probability;
  Worth worth{0, 0, std::vector<Difference>(rivals.size())};
  worth.from_likeliest.front() = {0, "", 0};
  for (std::size_t a = 0; a < rivals.size(); ++a)
    for (std::size_t b = a + 1; b < rivals.size(); ++b) {
      const Eigen::VectorXd between = in_sigmas.difference(trial.predicted[a], trial.predicted[b]);
      for (const std::size_t refitted : {a, b}) {
        const Eigen::VectorXd left = slopes.empty() ? between : leftBy(rivals[refitted], slopes[refitted], in_sigmas, between);
        const double told = -std::expm1(-per_log_misfit * in_sigmas.logMisfit(left, gap));
        const double likely = rivals[a].probability / all * rivals[b].probability / all;
        worth.told += likely * told;
        worth.largest += likely;
        if (a > 0) continue;
        const Difference difference = differenceOf(plant, in_sigmas, left);
        if (difference.overall < worth.from_likeliest[b].overall) worth.from_likeliest[b] = difference;
      }
    }
  return worth;
}

/// States which rivals the schedule separates from the most probable one, or the best separated one if there are none.
Experiment experimentOf(const TriedSchedule& trial, const std::vector<Rival>& rivals, const Worth& worth) {
  const double farthest = std::ranges::max(worth.from_likeliest, {}, &Difference::overall).overall;
  Experiment result;
  result.schedule = trial.choice.name;
  result.amplitude = trial.choice.amplitude;
  result.level = trial.choice.level;
  result.separates = {rivals.front().label};
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < rivals.size(); ++i) {
    if (worth.from_likeliest[i].overall < std::min(apart, farthest)) continue;
    result.separates.push_back(rivals[i].label);
    if (nearest == 0 || worth.from_likeliest[i].overall < worth.from_likeliest[nearest].overall) nearest = i;
  }
  const Difference& difference = worth.from_likeliest[nearest];
  result.difference = difference.overall;
  result.why =
      fmt::format("{}; the two of these that are most alike, fitted anew, differ by {:.1f} times the noise there, most in {} ({:.1f})",
                  scheduleWords(trial.choice), difference.overall, difference.signal, difference.in_signal);
  result.time_s = trial.commands.time_s;
  result.commands.resize(result.time_s.size());
  for (const Signal& signal : trial.commands.signals)
    for (std::size_t row = 0; row < result.commands.size(); ++row) result.commands[row].push_back(signal.values[row]);
  return result;
}

}  // namespace

Experiment nextExperiment(const Plant& plant, const std::vector<Rival>& rivals, Fidelity fidelity, int job_count,
                          const OnSimulation& on_simulation) {
  constexpr std::size_t refined_count = 6;
  if (rivals.size() < 2) return {};
  const std::vector<ScheduleChoice> bank = scheduleBank();
  const Spans rooms = roomsOf(plant);
  std::vector<TriedSchedule> trials(bank.size());
  parallelFor(static_cast<int>(bank.size()), job_count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    trials[index] = triedOut(plant, bank[index], rivals, rooms, fidelity, on_simulation);
  });
  std::erase_if(trials, [&](const TriedSchedule& trial) { return trial.predicted.size() < rivals.size(); });
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < trials.size(); ++i) order.emplace_back(-worthOf(plant, trials[i], rivals, {}).told, i);
  std::ranges::sort(order);
  Experiment best;
  double most = 0;
  for (std::size_t rank = 0; rank < std::min(refined_count, order.size()); ++rank) {
    const TriedSchedule& trial = trials[order[rank].second];
    const Worth worth = worthOf(plant, trial, rivals, slopesOf(plant, trial, rivals, fidelity, job_count, on_simulation));
    if (worth.told <= most || worth.told < worth_it * worth.largest) continue;
    most = worth.told;
    best = experimentOf(trial, rivals, worth);
  }
  return best;
}

}  // namespace musclesim
