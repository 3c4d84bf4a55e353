#include "locate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "regimes.h"

namespace musclesim {

namespace {

constexpr std::size_t stage_count = 5;
constexpr double agrees = 1.2;     ///< RMS over floor up to which a signal counts as predicted
constexpr double disagrees = 1.5;  ///< from which on it counts as not
constexpr double per_misfit = 5;   ///< ln of the odds of a stage per unit of log misfit of its best disturbance
constexpr double hardly = 0.03;    ///< factor for a stage that a substitution speaks against

using StageWeights = std::array<double, stage_count>;

std::size_t indexOf(Stage stage) {
  return static_cast<std::size_t>(stage);
}

/// RMS over floor of all cells of signals whose name begins with a word; nothing if there are none.
std::optional<double> ratioOf(const Comparison& comparison, const Eigen::VectorXd& residual, const std::string& beginning) {
  double sum = 0;
  int count = 0;
  for (const Comparison::Cell& cell : comparison.cells()) {
    if (!comparison.plant().signals()[static_cast<std::size_t>(cell.signal)].name.starts_with(beginning)) continue;
    sum += comparison.meanSquare(cell, residual) / (cell.floor * cell.floor);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

/// Mean ln(RMS / floor) of motion and tension.
double motionMisfit(const Comparison& comparison, const Eigen::VectorXd& residual) {
  double sum = 0;
  int count = 0;
  for (const Comparison::Cell& cell : comparison.cells()) {
    if (comparison.plant().signals()[static_cast<std::size_t>(cell.signal)].name.starts_with("pressure_")) continue;
    sum += 0.5 * std::log(std::max(1.0, comparison.meanSquare(cell, residual) / (cell.floor * cell.floor)));
    ++count;
  }
  return count ? sum / count : 0;
}

int signalNumber(const Plant& plant, const std::string& name) {
  for (std::size_t i = 0; i < plant.signals().size(); ++i)
    if (plant.signals()[i].name == name) return static_cast<int>(i);
  return -1;
}

bool allPressuresMeasured(const Plant& plant) {
  for (int muscle = 0; muscle < plant.muscleCount(); ++muscle)
    if (signalNumber(plant, fmt::format("pressure_{}", muscle)) < 0) return false;
  return true;
}

/// The residual when the measured pressures are the commands; empty if the model cannot follow.
Eigen::VectorXd residualUnderMeasuredPressures(const Comparison& comparison) {
  const Plant& plant = comparison.plant();
  std::vector<Prediction> predictions;
  for (const Stretch& stretch : comparison.stretches()) {
    const std::size_t rows = plant.recordings()[static_cast<std::size_t>(stretch.recording)].time_s.size();
    std::vector<std::vector<double>> commands(rows, std::vector<double>(static_cast<std::size_t>(plant.muscleCount())));
    for (int muscle = 0; muscle < plant.muscleCount(); ++muscle) {
      const std::vector<double>& p = plant.measured(stretch.recording, signalNumber(plant, fmt::format("pressure_{}", muscle)));
      if (p.size() != rows) return {};
      const auto first = std::ranges::find_if(p, [](double value) { return std::isfinite(value); });
      if (first == p.end()) return {};
      double last = std::clamp(*first, 0.0, 1.0);
      for (std::size_t row = 0; row < rows; ++row) {
        if (std::isfinite(p[row])) last = std::clamp(p[row], 0.0, 1.0);
        commands[row][static_cast<std::size_t>(muscle)] = last;
      }
    }
    predictions.push_back(plant.predict(stretch.recording, Model{}, commands, stretch.end_row, comparison.fidelity()));
  }
  const Eigen::VectorXd predicted = comparison.predicted(predictions);
  if (!predicted.size()) return {};
  return comparison.measured() - predicted;
}

/// Mean square of a residual over its variance, row by row, and averaged over blocks of rows: what is weak but slow stands out there.
class BlockRatio {
 public:
  void add(double residual, double variance) {
    plain_ += residual * residual / variance, ++count_;
    residual_ += residual, variance_ += variance;
    if (++filled_ < block_rows) return;
    averaged_ += residual_ * residual_ / (variance_ * (1 + steady_share * steady_share * static_cast<double>(block_rows))), ++block_count_;
    residual_ = variance_ = 0, filled_ = 0;
  }
  bool isEmpty() const { return count_ == 0; }
  double largestRms() const { return std::sqrt(std::max(plain_ / count_, block_count_ > 0 ? averaged_ / block_count_ : 0.0)); }

 private:
  double plain_ = 0, averaged_ = 0, residual_ = 0, variance_ = 0;
  std::size_t filled_ = 0;
  int count_ = 0, block_count_ = 0;
};

/// Of measured tension minus that of the law at measured pressure and length, over what noise of all three gives; of the muscle in which it
/// is largest.
struct TensionTest {
  double found = 0;     ///< RMS ratio
  double expected = 0;  ///< if all of the gap in the length arose in the law
};

/// Nothing if one of the three signals is missing.
std::optional<TensionTest> testTension(const Comparison& comparison, const Eigen::VectorXd& residual) {
  const Plant& plant = comparison.plant();
  std::optional<TensionTest> largest;
  for (int muscle = 0; muscle < plant.muscleCount(); ++muscle) {
    const int p = signalNumber(plant, fmt::format("pressure_{}", muscle)), f = signalNumber(plant, fmt::format("force_{}_N", muscle)),
              l = signalNumber(plant, fmt::format("length_{}_mm", muscle));
    if (p < 0 || f < 0 || l < 0) continue;
    auto floorOf = [&](int signal) { return plant.signals()[static_cast<std::size_t>(signal)].floor.value; };
    BlockRatio found, expected;
    for (const Comparison::Cell& cell : comparison.cells()) {
      if (cell.signal != l || cell.block > 0) continue;
      const int recording = comparison.stretches()[cell.stretch].recording;
      const auto &ps = plant.measured(recording, p), &fs = plant.measured(recording, f), &ls = plant.measured(recording, l);
      for (std::size_t k = 0; k < cell.rows.size(); ++k) {
        const auto i = static_cast<std::size_t>(cell.rows[k]);
        if (i >= ps.size() || i >= fs.size() || !std::isfinite(ps[i] + fs[i])) continue;
        const double law = plant.tensionN(muscle, ps[i], ls[i]);
        const double by_p = plant.tensionN(muscle, ps[i] + floorOf(p), ls[i]) - law,
                     by_l = plant.tensionN(muscle, ps[i], ls[i] + floorOf(l)) - law;
        const double variance = by_p * by_p + by_l * by_l + floorOf(f) * floorOf(f);
        found.add(fs[i] - law, variance);
        expected.add(plant.tensionN(muscle, ps[i], ls[i] - residual[cell.first + static_cast<Eigen::Index>(k)]) - law, variance);
      }
    }
    if (!found.isEmpty() && (!largest || found.largestRms() > largest->found)) largest = {found.largestRms(), expected.largestRms()};
  }
  return largest;
}

/// Shares of the stages by likeness alone.
StageWeights byLikeness(const Comparison& comparison, const std::vector<Suspect>& suspects, const std::vector<Signature>& signatures,
                        const Eigen::VectorXd& residual) {
  StageWeights best;
  best.fill(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < suspects.size(); ++i) {
    double& misfit = best[indexOf(suspects[i].info().stage)];
    misfit = std::min(misfit, signatures[i].log_misfit / comparison.affectedCells(residual));
  }
  const double least = *std::ranges::min_element(best);
  StageWeights weights{};
  for (std::size_t i = 0; i < stage_count; ++i) weights[i] = std::isfinite(best[i]) ? std::exp(-per_misfit * (best[i] - least)) : 0;
  return weights;
}

void normalise(StageWeights& weights) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  for (double& weight : weights) weight = sum > 0 ? weight / sum : 1.0 / stage_count;
}

/// The likeliest component of a stage.
std::string componentOf(Stage stage, const std::vector<Suspect>& suspects, const std::vector<Signature>& signatures) {
  std::string component = "all";
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < suspects.size(); ++i)
    if (suspects[i].info().stage == stage && signatures[i].log_misfit < least) {
      least = signatures[i].log_misfit;
      component = suspects[i].component();
    }
  return component;
}

/// Where the residual is largest, by what the commands do, in words; empty if it is much the same everywhere.
std::string regimeOf(const Comparison& comparison, const Eigen::VectorXd& residual) {
  constexpr double fewest_rows = 50, stands_out = 1.5;
  const RegimeSums sums = regimeSums(comparison, residual);
  double square = 0, rows = 0, largest = 0;
  std::string found;
  for (const Regime regime : {Regime::filling, Regime::venting, Regime::holding}) {
    const auto i = static_cast<std::size_t>(regime);
    square += sums.square[i];
    rows += sums.rows[i];
    if (sums.rows[i] <= fewest_rows || sums.meanSquare(regime) <= largest) continue;
    largest = sums.meanSquare(regime);
    found = nameOf(regime);
  }
  return rows > 0 && largest > stands_out * square / rows ? found : "";
}

}  // namespace

Location locate(const Comparison& comparison, const std::vector<Suspect>& suspects, const std::vector<Signature>& signatures,
                const Eigen::VectorXd& residual) {
  StageWeights weights = byLikeness(comparison, suspects, signatures, residual);
  normalise(weights);
  double &command = weights[indexOf(Stage::command)], &pressure = weights[indexOf(Stage::pressure)],
         &force = weights[indexOf(Stage::force)], &body = weights[indexOf(Stage::body)], &sensor = weights[indexOf(Stage::sensor)];
  std::vector<std::string> reasons;
  if (allPressuresMeasured(comparison.plant())) {
    const double ratio = ratioOf(comparison, residual, "pressure_").value_or(1);
    const Eigen::VectorXd left = residualUnderMeasuredPressures(comparison);
    const double before = motionMisfit(comparison, residual), after = left.size() ? motionMisfit(comparison, left) : 0;
    if (ratio < agrees) {
      command *= hardly;
      pressure *= hardly;
      reasons.push_back("measured pressures are as predicted, so the gap arises behind the pressure stage");
    } else if (!left.size()) {
      reasons.push_back(
          "pressures differ from the predicted ones, but the model cannot follow them or they are not complete: shares say how much "
          "typical disturbances of each stage resemble the gap");
    } else if (before > 0.1 && after < 0.5 * before) {
      for (double* weight : {&force, &body, &sensor}) *weight *= hardly;
      reasons.push_back(
          fmt::format("with the measured pressures in place of the simulated ones {:.0f} % of the log gap of the motion vanishes",
                      100 * (1 - after / before)));
    } else if (before > 0.1) {
      reasons.push_back(
          "pressures differ from the predicted ones, but most of the motion's gap stays when they are put in their place: there is more "
          "than one cause, and shares say how much typical disturbances of each stage resemble the whole gap");
    }
  }
  if (const auto tension = testTension(comparison, residual)) {
    if (tension->found < agrees && tension->expected > disagrees) {
      force *= hardly;
      reasons.push_back("tensions follow the force law at the measured pressures and lengths");
    } else if (tension->found < agrees) {
      reasons.push_back("the gap is too small to show in tensions against the force law at the measured pressures and lengths");
    } else if (tension->found > disagrees) {
      body *= hardly;
      reasons.push_back(fmt::format("tensions differ from the force law at the measured pressures and lengths by {:.1f} times the noise",
                                    tension->found));
    }
  }
  if (reasons.empty())
    reasons.push_back("too few signals for substitution: shares say how much typical disturbances of each stage resemble the gap");
  normalise(weights);

  Location location;
  location.method = fmt::format("{}", fmt::join(reasons, "; "));
  const std::string regime = regimeOf(comparison, residual);
  for (std::size_t i = 0; i < stage_count; ++i) {
    const auto stage = static_cast<Stage>(i);
    location.places.push_back({nameOf(stage), componentOf(stage, suspects, signatures), regime, weights[i]});
  }
  std::ranges::stable_sort(location.places, [](const Place& a, const Place& b) { return a.share > b.share; });
  return location;
}

}  // namespace musclesim
