#include "comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../base/parallel.h"

namespace musclesim {

Comparison::Comparison(const Plant& plant, std::vector<Stretch> stretches, Averages averages)
    : plant_(plant), stretches_(std::move(stretches)) {
  for (std::size_t k = 0; k < stretches_.size(); ++k)
    for (std::size_t s = 0; s < plant.signals().size(); ++s) {
      const std::vector<double>& y = plant.measured(stretches_[k].recording, static_cast<int>(s));
      Cell cell{k, static_cast<int>(s), {}, size_, plant.signals()[s].floor.value};
      for (int row = stretches_[k].first_row; row < std::min(stretches_[k].end_row, static_cast<int>(y.size())); row += stretches_[k].every)
        if (std::isfinite(y[static_cast<std::size_t>(row)])) cell.rows.push_back(row);
      if (cell.rows.size() < fewest_compared_rows) continue;
      size_ += static_cast<Eigen::Index>(cell.rows.size());
      cells_.push_back(std::move(cell));
    }
  if (averages == Averages::with) addAverages();
  measured_.resize(size_);
  for (const Cell& cell : cells_) {
    if (cell.block > 0) continue;
    const std::vector<double>& y = plant.measured(stretches_[cell.stretch].recording, cell.signal);
    for (std::size_t i = 0; i < cell.rows.size(); ++i)
      measured_[cell.first + static_cast<Eigen::Index>(i)] = y[static_cast<std::size_t>(cell.rows[i])];
  }
  average(measured_);
}

double averagedShareOfFloor(const std::vector<double>& values) {
  std::size_t rows = 0, readings = 0;
  double last = std::numeric_limits<double>::quiet_NaN();
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    ++rows;
    readings += value != last ? 1 : 0;
    last = value;
  }
  const double per_block = std::max(1.0, static_cast<double>(block_rows * readings) / static_cast<double>(std::max<std::size_t>(rows, 1)));
  return std::sqrt(1.0 / per_block + steady_share * steady_share);
}

/// What repeats differ by need not be white: it is not averaged.
void Comparison::addAverages() {
  const std::size_t plain_count = cells_.size();
  for (std::size_t i = 0; i < plain_count; ++i) {
    const Cell& plain = cells_[i];
    const NoiseFloor& floor = plant_.signals()[static_cast<std::size_t>(plain.signal)].floor;
    if (floor.source == NoiseFloor::Source::repeats || plain.rows.size() < 4 * block_rows) continue;
    const std::vector<double>& y = plant_.measured(stretches_[plain.stretch].recording, plain.signal);
    std::vector<double> values;
    for (const int row : plain.rows) values.push_back(y[static_cast<std::size_t>(row)]);
    Cell cell{plain.stretch, plain.signal, {}, size_, plain.floor * averagedShareOfFloor(values), block_rows, plain.first};
    for (std::size_t row = 0; row + block_rows <= plain.rows.size(); row += block_rows) cell.rows.push_back(plain.rows[row]);
    size_ += cell.count();
    cells_.push_back(std::move(cell));
  }
}

void Comparison::average(Eigen::VectorXd& values) const {
  for (const Cell& cell : cells_) {
    if (cell.block == 0) continue;
    const auto block = static_cast<Eigen::Index>(cell.block);
    for (Eigen::Index i = 0; i < cell.count(); ++i) values[cell.first + i] = values.segment(cell.first_of_all + i * block, block).mean();
  }
}

void Comparison::goCoarse(const Eigen::VectorXd& nominal, Purpose purpose) {
  constexpr double few_floors = 5, share_of_gap = 0.1;
  if (nominal.size() != size_) return;
  const bool looking = purpose == Purpose::looking;
  const Eigen::VectorXd residual = measured_ - nominal;
  for (const Fidelity fidelity : {Fidelity::coarsest, Fidelity::coarse, Fidelity::medium}) {
    if (fidelity == Fidelity::coarsest && !looking) continue;
    const Eigen::VectorXd coarse = predicted(Model{}, fidelity);
    if (coarse.size() != nominal.size() || !coarse.allFinite()) continue;
    const Eigen::VectorXd correction = nominal - coarse;
    const bool follows = std::ranges::all_of(cells_, [&](const Cell& cell) {
      const double bearable = std::max(few_floors * cell.floor, looking ? share_of_gap * std::sqrt(meanSquare(cell, residual)) : 0);
      return std::sqrt(meanSquare(cell, correction)) <= bearable;
    });
    if (!follows) {
      if (fidelity == Fidelity::medium) unsteady_ = unsteadiness(correction, residual);
      continue;
    }
    correction_ = correction;
    fidelity_ = fidelity;
    return;
  }
}

/// The signal, as it is, that another step moves most.
Unsteady Comparison::unsteadiness(const Eigen::VectorXd& change, const Eigen::VectorXd& residual) const {
  Unsteady worst;
  for (const Cell& cell : cells_) {
    const double in_floors = std::sqrt(meanSquare(cell, change)) / cell.floor;
    if (cell.block > 0 || in_floors <= worst.in_floors) continue;
    worst = {plant_.signals()[static_cast<std::size_t>(cell.signal)].name, in_floors,
             std::sqrt(meanSquare(cell, change) / std::max(1e-300, meanSquare(cell, residual)))};
  }
  return worst;
}

Eigen::VectorXd Comparison::predicted(const Model& model) const {
  if (fidelity_ == Fidelity::fine) return predicted(model, Fidelity::fine);
  const Eigen::VectorXd coarse = predicted(model, fidelity_);
  if (!coarse.size() || !coarse.allFinite()) return predicted(model, Fidelity::fine);
  return coarse + correction_;
}

Eigen::VectorXd Comparison::predicted(const Model& model, Fidelity fidelity) const {
  std::vector<Prediction> predictions(stretches_.size());
  parallelFor(static_cast<int>(stretches_.size()), plant_.jobCount(), [&](int i) {
    const Stretch& stretch = stretches_[static_cast<std::size_t>(i)];
    predictions[static_cast<std::size_t>(i)] = plant_.predict(stretch.recording, model, stretch.end_row, fidelity);
  });
  return gathered(predictions);
}

Eigen::VectorXd Comparison::predicted(const std::vector<Prediction>& per_stretch, Fidelity fidelity) const {
  Eigen::VectorXd result = gathered(per_stretch);
  if (result.size() && fidelity != Fidelity::fine) result += correction_;
  return result;
}

Eigen::VectorXd Comparison::gathered(const std::vector<Prediction>& per_stretch) const {
  for (const Prediction& prediction : per_stretch)
    if (prediction.diverged) return {};
  Eigen::VectorXd result(size_);
  for (const Cell& cell : cells_) {
    if (cell.block > 0) continue;
    const std::vector<double>& y = per_stretch[cell.stretch].values[static_cast<std::size_t>(cell.signal)];
    for (std::size_t i = 0; i < cell.rows.size(); ++i)
      result[cell.first + static_cast<Eigen::Index>(i)] = y[static_cast<std::size_t>(cell.rows[i])];
  }
  average(result);
  return result;
}

const Comparison::Cell& Comparison::cellLike(const Cell& other) const {
  return *std::ranges::find_if(cells_, [&](const Cell& cell) { return cell.signal == other.signal && cell.block == other.block; });
}

Comparison Comparison::bySquares(const Eigen::VectorXd& residual) const {
  Comparison result = *this;
  result.by_squares_ = true;
  for (Cell& cell : result.cells_) cell.floor = std::sqrt(cell.floor * cell.floor + meanSquare(cell, residual));
  return result;
}

double Comparison::meanSquare(const Cell& cell, const Eigen::VectorXd& residual) const {
  return residual.segment(cell.first, cell.count()).squaredNorm() / static_cast<double>(cell.count());
}

double Comparison::logMisfit(const Eigen::VectorXd& residual) const {
  if (residual.size() != size_ || !residual.allFinite()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const Cell& cell : cells_) {
    const double over_floor = meanSquare(cell, residual) / (cell.floor * cell.floor);
    sum += 0.5 * (by_squares_ ? over_floor : std::log(std::max(1.0, over_floor)));
  }
  return sum;
}

Eigen::VectorXd Comparison::weights(const Eigen::VectorXd& residual) const {
  Eigen::VectorXd result(size_);
  for (const Cell& cell : cells_) {
    const double rms = by_squares_ ? cell.floor : std::max(cell.floor, std::sqrt(meanSquare(cell, residual)));
    result.segment(cell.first, cell.count()).setConstant(1 / (rms * std::sqrt(static_cast<double>(cell.count()))));
  }
  return result;
}

Gap Comparison::gap(const Eigen::VectorXd& residual) const {
  struct Sum {
    double squares = 0;
    std::size_t count = 0;
  };
  std::map<int, Sum> sums;
  for (const Cell& cell : cells_) {
    if (cell.block > 0) continue;
    Sum& sum = sums[cell.signal];
    sum.squares += meanSquare(cell, residual) * static_cast<double>(cell.rows.size());
    sum.count += cell.rows.size();
  }
  Gap gap;
  for (const auto& [signal, sum] : sums) {
    const ComparedSignal& compared = plant_.signals()[static_cast<std::size_t>(signal)];
    const double mean_square = sum.squares / static_cast<double>(sum.count), floor = compared.floor.value;
    gap.per_signal[compared.name] = {std::sqrt(mean_square), floor};
    gap.normalised += std::max(0.0, mean_square - floor * floor) / (floor * floor) / static_cast<double>(sums.size());
  }
  return gap;
}

int Comparison::affectedCells(const Eigen::VectorXd& residual) const {
  constexpr double out_of_floor = 1.15;
  const auto count =
      std::ranges::count_if(cells_, [&](const Cell& cell) { return std::sqrt(meanSquare(cell, residual)) > out_of_floor * cell.floor; });
  return std::max(1, static_cast<int>(count));
}

bool isWithinFloor(const Comparison& comparison, const Eigen::VectorXd& residual) {
  constexpr Eigen::Index enough_rows = 200;
  constexpr double known = 1.15, estimated = 1.3, known_in_one = 1.3, estimated_in_one = 1.5;
  const Gap gap = comparison.gap(residual);
  const auto& signals = comparison.plant().signals();
  const bool all = std::ranges::all_of(signals, [&](const ComparedSignal& signal) {
    const auto found = gap.per_signal.find(signal.name);
    return found == gap.per_signal.end() ||
           found->second.rmse < (signal.floor.isEstimated() ? estimated : known) * found->second.noise_floor;
  });
  return all && std::ranges::all_of(comparison.cells(), [&](const Comparison::Cell& cell) {
           const bool is_estimated = signals[static_cast<std::size_t>(cell.signal)].floor.isEstimated();
           const double rms = std::sqrt(comparison.meanSquare(cell, residual));
           return cell.count() < enough_rows || rms < (is_estimated ? estimated_in_one : known_in_one) * cell.floor;
         });
}

}  // namespace musclesim
