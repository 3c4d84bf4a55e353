#include "gap_reduction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "../../base/parallel.h"
#include "../fit/refit.h"
#include "musclesim/base/random.h"

namespace musclesim {

namespace {

constexpr int draw_count = 1000;
constexpr double block_s = 1;
constexpr int round_count = 4;

/// Sums of squares of one bootstrap block, before and after, per signal.
struct BootstrapBlock {
  std::map<int, std::array<double, 3>> sums;  ///< before, after, rows
};

std::vector<BootstrapBlock> blocksOf(const BeforeAndAfter& both) {
  const auto& [comparison, before, after] = both;
  std::map<std::pair<std::size_t, int>, BootstrapBlock> blocks;
  for (const Comparison::Block& block : comparison.blocks()) {
    const auto& time_s = comparison.plant().recordings()[static_cast<std::size_t>(comparison.segments()[block.segment].recording)].time_s;
    for (std::size_t i = 0; i < block.rows.size(); ++i) {
      const int number = static_cast<int>(time_s[static_cast<std::size_t>(block.rows[i])] / block_s);
      auto& sum = blocks[{block.segment, number}].sums[block.signal];
      const auto k = block.first + static_cast<Eigen::Index>(i);
      sum[0] += before[k] * before[k];
      sum[1] += after[k] * after[k];
      sum[2] += 1;
    }
  }
  std::vector<BootstrapBlock> result;
  for (auto& [key, block] : blocks) result.push_back(std::move(block));
  return result;
}

/// Normalised gaps (means over signals) before and after.
std::pair<double, double> gapsOf(const Comparison& comparison, const std::vector<const BootstrapBlock*>& blocks) {
  std::map<int, std::array<double, 3>> sums;
  for (const BootstrapBlock* block : blocks)
    for (const auto& [signal, sum] : block->sums)
      for (std::size_t i = 0; i < 3; ++i) sums[signal][i] += sum[i];
  double before = 0, after = 0;
  for (const auto& [signal, sum] : sums) {
    const double sigma = comparison.plant().signals()[static_cast<std::size_t>(signal)].sigma.value, square = sigma * sigma;
    before += std::max(0.0, sum[0] / sum[2] - square) / square / static_cast<double>(sums.size());
    after += std::max(0.0, sum[1] / sum[2] - square) / square / static_cast<double>(sums.size());
  }
  return {before, after};
}

double reductionOf(const Comparison& comparison, const std::vector<const BootstrapBlock*>& blocks) {
  const auto [before, after] = gapsOf(comparison, blocks);
  return before > 0 ? 100 * (1 - after / before) : 0;
}

/// Uncertainty of the normalised gap of noise alone, for some hundred rows.
constexpr double noise_alone = 0.07;

/// ln(after / before) of the normalised gaps of each recording; the gap after counts at least as noise_alone.
std::vector<double> logRests(const BeforeAndAfter& both) {
  std::map<int, std::map<int, std::array<double, 3>>> sums;  // recording, signal: before, after, rows
  for (const Comparison::Block& block : both.comparison.blocks()) {
    if (!block.isReading()) continue;
    auto& sum = sums[both.comparison.segments()[block.segment].recording][block.signal];
    const auto rows = static_cast<double>(block.count());
    sum[0] += rows * both.comparison.meanSquare(block, both.before);
    sum[1] += rows * both.comparison.meanSquare(block, both.after);
    sum[2] += rows;
  }
  std::vector<double> result;
  for (const auto& [recording, signals] : sums) {
    double before = 0, after = 0;
    for (const auto& [signal, sum] : signals) {
      const double sigma = both.comparison.plant().signals()[static_cast<std::size_t>(signal)].sigma.value, square = sigma * sigma;
      before += std::max(0.0, sum[0] / sum[2] / square - 1) / static_cast<double>(signals.size());
      after += std::max(0.0, sum[1] / sum[2] / square - 1) / static_cast<double>(signals.size());
    }
    if (before > noise_alone) result.push_back(std::log(std::max(noise_alone, after) / before));
  }
  return result;
}

/// Student's prediction interval for one more value, as gap reduction in percent.
std::optional<std::pair<double, double>> ofAnotherRecording(const std::vector<double>& log_rests) {
  constexpr std::array quantile_975 = {4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262};  // 2 .. 9 degrees of freedom
  if (log_rests.size() < 3) return std::nullopt;
  const Eigen::Map<const Eigen::VectorXd> y(log_rests.data(), static_cast<Eigen::Index>(log_rests.size()));
  const double count = static_cast<double>(log_rests.size()), mean = y.mean();
  const double deviation = std::sqrt((y.array() - mean).square().sum() / (count - 1));
  const double half_width = quantile_975[std::min(quantile_975.size(), log_rests.size() - 2) - 1] * deviation * std::sqrt(1 + 1 / count);
  return std::pair{100 * (1 - std::exp(mean + half_width)), 100 * (1 - std::exp(mean - half_width))};
}

struct Sine {
  double frequency_hz, phase;
};

std::vector<std::vector<double>> disturbed(const Recording& recording, const std::vector<Sine>& sines, const Eigen::VectorXd& amplitude) {
  std::vector<std::vector<double>> commands(recording.time_s.size());
  for (int muscle = 0; muscle < recording.muscleCount(); ++muscle) {
    const auto& u = recording.find("command_" + std::to_string(muscle))->values;
    for (std::size_t row = 0; row < u.size(); ++row) {
      double sum = u[row];
      for (std::size_t k = 0; k < sines.size(); ++k)
        sum += amplitude[static_cast<Eigen::Index>(k)] *
               std::sin(2 * std::numbers::pi * sines[k].frequency_hz * recording.time_s[row] + sines[k].phase);
      commands[row].push_back(std::clamp(sum, 0.0, 1.0));
    }
  }
  return commands;
}

}  // namespace

double gapReductionPercent(const Gap& before, const Gap& after) {
  return before.normalised > 0 ? 100 * (1 - after.normalised / before.normalised) : 0;
}

bool clearlyBeats(double reduction_percent, double control_percent) {
  constexpr double clear_gain_percent = 5, clear_rest_share = 0.5;
  const double other_percent = std::max(0.0, control_percent);
  return reduction_percent > other_percent + clear_gain_percent || 100 - reduction_percent < clear_rest_share * (100 - other_percent);
}

Estimate gapReductionInterval(const BeforeAndAfter& held_out, const BeforeAndAfter& fitted, std::uint64_t seed) {
  const std::vector<BootstrapBlock> blocks = blocksOf(held_out);
  RandomStream random(seed, "diagnosis.bootstrap");
  std::vector<double> draws;
  for (int draw = 0; draw < draw_count; ++draw) {
    std::vector<const BootstrapBlock*> chosen;
    for (std::size_t i = 0; i < blocks.size(); ++i)
      chosen.push_back(
          &blocks[std::min(blocks.size() - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(blocks.size())))]);
    draws.push_back(reductionOf(held_out.comparison, chosen));
  }
  std::ranges::sort(draws);
  std::vector<const BootstrapBlock*> all;
  for (const BootstrapBlock& block : blocks) all.push_back(&block);
  Estimate reduction{reductionOf(held_out.comparison, all), draws[draw_count / 40], draws[draw_count - 1 - draw_count / 40]};
  std::vector<double> log_rests = logRests(held_out);
  std::ranges::copy(logRests(fitted), std::back_inserter(log_rests));
  if (const auto other = ofAnotherRecording(log_rests)) {
    reduction.low = std::min(reduction.low, other->first);
    reduction.high = std::max(reduction.high, other->second);
  }
  // If noise alone may leave as much as the upper end does, the whole gap may be removed.
  if ((1 - reduction.high / 100) * gapsOf(held_out.comparison, all).first <= noise_alone) reduction.high = 100;
  return reduction;
}

ControlResidual nominalRefit(const Comparison& fitted, const Comparison& held_out, const OnSimulation& on_simulation) {
  const auto& nominal = fitted.plant().nominalParameters();
  auto modelAt = [&](const Eigen::VectorXd& z) {
    Model model;
    for (std::size_t i = 0; i < nominal.size(); ++i)
      model.parameters.emplace_back(nominal[i].first, nominal[i].second * std::exp(z[static_cast<Eigen::Index>(i)]));
    return model;
  };
  FitProblem problem;
  problem.start = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(nominal.size()));
  problem.clamped = [](const Eigen::VectorXd& z) -> Eigen::VectorXd { return z.cwiseMax(-1.5).cwiseMin(1.5); };
  problem.predicted = [&](const Eigen::VectorXd& z) {
    on_simulation();
    return fitted.predicted(modelAt(z));
  };
  const FitResult result = fit(fitted, problem, round_count);
  return {result.residual, held_out.residualOf(modelAt(result.z))};
}

Eigen::VectorXd negativeControlResidual(const Comparison& fitted, const Comparison& held_out, int parameter_count, std::uint64_t seed,
                                        const OnSimulation& on_simulation) {
  RandomStream random(seed, "diagnosis.sham");
  std::vector<Sine> sines;
  for (int i = 0; i < parameter_count; ++i) sines.push_back({0.1 + 1.9 * random.uniform(), 2 * std::numbers::pi * random.uniform()});
  auto predictedOn = [&](const Comparison& comparison, const Eigen::VectorXd& amplitude) {
    const Plant& plant = comparison.plant();
    std::vector<Prediction> predictions(comparison.segments().size());
    parallelFor(static_cast<int>(predictions.size()), plant.jobCount(), [&](int i) {
      const Segment& segment = comparison.segments()[static_cast<std::size_t>(i)];
      const Recording& recording = plant.recordings()[static_cast<std::size_t>(segment.recording)];
      predictions[static_cast<std::size_t>(i)] =
          plant.predict(segment.recording, Model{}, disturbed(recording, sines, amplitude), segment.end_row, comparison.fidelity());
    });
    return comparison.predicted(predictions, comparison.fidelity());
  };
  constexpr double typical = 0.02;
  FitProblem problem;
  problem.start = Eigen::VectorXd::Constant(parameter_count, 0.1);
  problem.clamped = [](const Eigen::VectorXd& z) -> Eigen::VectorXd { return z.cwiseMax(-10).cwiseMin(10); };
  problem.predicted = [&](const Eigen::VectorXd& z) {
    on_simulation();
    return predictedOn(fitted, typical * z);
  };
  const FitResult result = fit(fitted, problem, round_count);
  const Eigen::VectorXd predicted = predictedOn(held_out, typical * result.z);
  return predicted.size() ? held_out.measured() - predicted : Eigen::VectorXd{};
}

}  // namespace musclesim
