#include "comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "../../base/parallel.h"

namespace musclesim {

namespace {

/// Of each `every` rows of a segment the first with a value: a sensor may be read less often than the recording is logged.
template <typename HasValue>
std::vector<int> rowsOf(const Segment& segment, int end_row, const HasValue& hasValue) {
  std::vector<int> rows;
  for (int begin = segment.first_row; begin < end_row; begin += segment.every)
    for (int row = begin; row < std::min(begin + segment.every, end_row); ++row)
      if (hasValue(static_cast<std::size_t>(row))) {
        rows.push_back(row);
        break;
      }
  return rows;
}

}  // namespace

Comparison::Comparison(const Plant& plant, std::vector<Segment> segments, Derived derived) : plant_(plant), segments_(std::move(segments)) {
  for (std::size_t k = 0; k < segments_.size(); ++k)
    for (std::size_t s = 0; s < plant.signals().size(); ++s) {
      const std::vector<double>& y = plant.measured(segments_[k].recording, static_cast<int>(s));
      Block block{k, static_cast<int>(s), {}, size_, plant.signals()[s].sigma.value};
      block.rows = rowsOf(segments_[k], std::min(segments_[k].end_row, static_cast<int>(y.size())),
                          [&](std::size_t row) { return std::isfinite(y[row]); });
      if (block.rows.size() < fewest_compared_rows) continue;
      size_ += static_cast<Eigen::Index>(block.rows.size());
      blocks_.push_back(std::move(block));
    }
  if (derived == Derived::with) {
    addParity();
    addAverages();
  }
  shareEvidence();
  measured_.resize(size_);
  for (const Block& block : blocks_) {
    if (!block.isReading()) continue;
    const std::vector<double>& y = plant.measured(segments_[block.segment].recording, block.signal);
    for (std::size_t i = 0; i < block.rows.size(); ++i)
      measured_[block.first + static_cast<Eigen::Index>(i)] = y[static_cast<std::size_t>(block.rows[i])];
  }
  fillParity(measured_, [this](std::size_t segment, int signal) -> const std::vector<double>& {
    return plant_.measured(segments_[segment].recording, signal);
  });
  average(measured_);
}

double averagedShareOfSigma(const std::vector<double>& values) {
  std::size_t rows = 0, readings = 0;
  double last = std::numeric_limits<double>::quiet_NaN();
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    ++rows;
    readings += value != last ? 1 : 0;
    last = value;
  }
  const double per_block =
      std::max(1.0, static_cast<double>(averaging_rows * readings) / static_cast<double>(std::max<std::size_t>(rows, 1)));
  return std::sqrt(1.0 / per_block + steady_share * steady_share);
}

/// Adds a block of parity for each signal of motion of which other signals tell something.
void Comparison::addParity() {
  constexpr double least_share = 0.05;  // of a signal; below it, nothing remains of it beside the pose that it determines
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    const ParityRelations& parity = plant_.parity(segments_[k].recording);
    if (parity.count() == 0) continue;
    const std::vector<int> rows = rowsOf(segments_[k], segments_[k].end_row, [&](std::size_t row) {
      return std::ranges::all_of(parity.signals(),
                                 [&](int signal) { return std::isfinite(plant_.measured(segments_[k].recording, signal)[row]); });
    });
    if (rows.size() < fewest_compared_rows) continue;
    for (std::size_t s = 0; s < parity.signals().size(); ++s) {
      const auto position = static_cast<Eigen::Index>(s);
      const auto meanOf = [&](auto value) {
        return std::transform_reduce(rows.begin(), rows.end(), 0.0, std::plus<>{}, value) / static_cast<double>(rows.size());
      };
      if (meanOf([&](int row) { return parity.shareBeyondPose(row, position); }) < least_share) continue;
      const double variance = meanOf([&](int row) { return parity.noiseVariance(row, position); });
      Block block{k, parity.signals()[s], rows, size_, std::sqrt(variance)};
      block.is_parity = true;
      size_ += block.count();
      blocks_.push_back(std::move(block));
    }
  }
}

/// Computes the parity blocks of rows (not of averages); `seriesOf` gives the values of a signal in all rows of a segment.
void Comparison::fillParity(Eigen::VectorXd& values, const SeriesOf& seriesOf) const {
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    std::vector<const Block*> parts;
    for (const Block& block : blocks_)
      if (block.is_parity && block.averaged_rows == 0 && block.segment == k) parts.push_back(&block);
    if (parts.empty()) continue;
    const ParityRelations& parity = plant_.parity(segments_[k].recording);
    const auto count = static_cast<Eigen::Index>(parity.signals().size());
    Eigen::VectorXd readings(count), measured(count);
    for (std::size_t i = 0; i < parts.front()->rows.size(); ++i) {
      const int row = parts.front()->rows[i];
      for (Eigen::Index s = 0; s < count; ++s) {
        const int signal = parity.signals()[static_cast<std::size_t>(s)];
        readings[s] = seriesOf(k, signal)[static_cast<std::size_t>(row)];
        measured[s] = plant_.measured(segments_[k].recording, signal)[static_cast<std::size_t>(row)];
      }
      const Eigen::VectorXd beyond_pose = parity.at(row, readings, measured);
      for (const Block* block : parts)
        values[block->first + static_cast<Eigen::Index>(i)] =
            beyond_pose[std::ranges::find(parity.signals(), block->signal) - parity.signals().begin()];
    }
  }
}

/// Adds averaged blocks, except for signals whose sigma comes from repeats: their differences need not be white noise.
void Comparison::addAverages() {
  const std::size_t plain_count = blocks_.size();
  for (std::size_t i = 0; i < plain_count; ++i) {
    const Block& plain = blocks_[i];
    const NoiseSigma& sigma = plant_.signals()[static_cast<std::size_t>(plain.signal)].sigma;
    if (sigma.source == NoiseSigma::Source::repeats || plain.rows.size() < 4 * averaging_rows) continue;
    const std::vector<double>& y = plant_.measured(segments_[plain.segment].recording, plain.signal);
    std::vector<double> values;
    for (const int row : plain.rows) values.push_back(y[static_cast<std::size_t>(row)]);
    Block block{plain.segment, plain.signal, {}, size_, plain.sigma * averagedShareOfSigma(values), averaging_rows};
    block.first_averaged = plain.first;
    block.is_parity = plain.is_parity;
    for (std::size_t row = 0; row + averaging_rows <= plain.rows.size(); row += averaging_rows) block.rows.push_back(plain.rows[row]);
    size_ += block.count();
    blocks_.push_back(std::move(block));
  }
}

/// A pressure or a tension is a channel of power 1 per segment. The n signals of motion are one channel: they hold d independent motions,
/// the robot's free coordinates, and that is its power; what they contradict each other by is another one, of the power n - d. Where no
/// parity is known, n signals of motion have the power sqrt(n), because their sensors fail one by one. Blocks of a channel share its power.
/// A single recording, or two, count as three: they hold as many motions.
void Comparison::shareEvidence() {
  if (!isTempered()) {
    for (Block& block : blocks_) block.power = counts(block) && block.isReading() ? static_cast<double>(block.count()) : 0;
    return;
  }
  constexpr double usual_recordings = 3;
  const auto channelOf = [this](const Block& block) {
    const std::string& name = plant_.signals()[static_cast<std::size_t>(block.signal)].name;
    if (block.is_parity) return std::string("parity");
    return isMotion(name) ? std::string("motion") : name;
  };
  struct Channel {
    double blocks = 0;
    std::set<int> signals;
  };
  std::map<std::pair<std::size_t, std::string>, Channel> channels;
  for (const Block& block : blocks_) {
    Channel& channel = channels[{block.segment, channelOf(block)}];
    ++channel.blocks;
    channel.signals.insert(block.signal);
  }
  const double per_segment = std::max(1.0, usual_recordings / static_cast<double>(segments_.size()));
  const auto powerOf = [&](const Block& block, const Channel& channel) {
    const auto signal_count = static_cast<double>(channel.signals.size());
    if (channelOf(block) == "motion" && !channels.contains({block.segment, "parity"})) return std::sqrt(signal_count);
    if (!isMotion(plant_.signals()[static_cast<std::size_t>(block.signal)].name)) return 1.0;
    const double relation_count = plant_.parity(segments_[block.segment].recording).count();
    return block.is_parity ? relation_count : signal_count - relation_count;
  };
  for (Block& block : blocks_) {
    const Channel& channel = channels[{block.segment, channelOf(block)}];
    block.power = counts(block) ? per_segment * powerOf(block, channel) / channel.blocks : 0;
  }
}

bool Comparison::counts(const Block& block) const {
  return focus_ == Focus::all_signals || plant_.signals()[static_cast<std::size_t>(block.signal)].name.starts_with("pressure_");
}

void Comparison::focusOn(Focus focus) {
  focus_ = focus;
  shareEvidence();
}

void Comparison::average(Eigen::VectorXd& values) const {
  for (const Block& block : blocks_) {
    if (block.averaged_rows == 0) continue;
    for (Eigen::Index i = 0; i < block.count(); ++i) values[block.first + i] = meanOfBlock(values, block.first_averaged, i);
  }
}

constexpr double few_sigmas = 5;  ///< noise sigmas, from which on another motion is a different one

void Comparison::goCoarse(const Eigen::VectorXd& nominal, Purpose purpose) {
  constexpr double share_of_gap = 0.1;
  if (nominal.size() != size_) return;
  nominal_ = nominal;
  const bool screening = purpose == Purpose::screening;
  const Eigen::VectorXd residual = measured_ - nominal;
  if (plant_.possible(Fidelity::coarse) == Fidelity::fine) {
    const Eigen::VectorXd stronger = predicted(slightlyStronger(), Fidelity::fine);
    if (stronger.size() == size_ && isSensitive(stronger - nominal)) countAsNoise(stronger - nominal, residual, Unsteady::Change::forces);
  }
  for (const Fidelity fidelity : {Fidelity::coarsest, Fidelity::coarse, Fidelity::medium}) {
    if (fidelity == Fidelity::coarsest && !screening) continue;
    const Eigen::VectorXd coarse = predicted(Model{}, fidelity);
    if (coarse.size() != nominal.size() || !coarse.allFinite()) continue;
    const Eigen::VectorXd correction = nominal - coarse;
    const bool follows = std::ranges::all_of(blocks_, [&](const Block& block) {
      const double bearable = std::max(few_sigmas * block.sigma, screening ? share_of_gap * std::sqrt(meanSquare(block, residual)) : 0);
      return std::sqrt(meanSquare(block, correction)) <= bearable;
    });
    if (!follows) {
      if (fidelity != Fidelity::medium) continue;
      // Of a method of first order, twice the step makes twice the error: the change is the error of the steps in use.
      countAsNoise(correction, residual, Unsteady::Change::steps);
    }
    correction_ = correction;
    fidelity_ = fidelity;
    return;
  }
}

/// Whether what slightly stronger muscles change stands out of the noise of a signal, and is out of proportion to its motion.
bool Comparison::isSensitive(const Eigen::VectorXd& change) const {
  // The forces change by a thousandth. If the signal then changes by a tenth of its motion, an error of a percent in the forces, which a
  // real model may have, changes it by as much as its whole motion: the recording tells nothing there.
  constexpr double share_of_motion = 0.1;
  const auto spread = [](const auto& values) { return std::sqrt((values.array() - values.mean()).square().mean()); };
  return std::ranges::any_of(blocks_, [&](const Block& block) {
    const auto changed = change.segment(block.first, block.count()), moved = nominal_.segment(block.first, block.count());
    return block.isReading() && spread(changed) > std::max(few_sigmas * block.sigma, share_of_motion * spread(moved));
  });
}

/// Adds the change to the noise of every block: the model is not known any better.
void Comparison::countAsNoise(const Eigen::VectorXd& change, const Eigen::VectorXd& residual, Unsteady::Change by) {
  unsteady_ = unsteadiness(change, residual);
  unsteady_.by = by;
  for (Block& block : blocks_) block.sigma = std::hypot(block.sigma, std::sqrt(meanSquare(block, change)));
}

/// What the change does to the row-by-row signals, most of all to the one that it changes most.
Unsteady Comparison::unsteadiness(const Eigen::VectorXd& change, const Eigen::VectorXd& residual) const {
  Unsteady worst;
  for (const Block& block : blocks_) {
    const double in_sigmas = std::sqrt(meanSquare(block, change)) / block.sigma;
    if (!block.isReading()) continue;
    const std::string& name = plant_.signals()[static_cast<std::size_t>(block.signal)].name;
    double& of_signal = worst.all_in_sigmas[name];
    of_signal = std::max(of_signal, in_sigmas);
    if (in_sigmas <= worst.in_sigmas) continue;
    worst.signal = name;
    worst.in_sigmas = in_sigmas;
    worst.share_of_gap = std::sqrt(meanSquare(block, change) / std::max(1e-300, meanSquare(block, residual)));
  }
  return worst;
}

/// A prediction with fidelity(), corrected where that is not fine; in fine steps where it diverges in coarse ones.
Eigen::VectorXd Comparison::corrected(const std::function<Eigen::VectorXd(Fidelity)>& predictedIn) const {
  if (fidelity_ == Fidelity::fine) return predictedIn(Fidelity::fine);
  const Eigen::VectorXd coarse = predictedIn(fidelity_);
  if (!coarse.size() || !coarse.allFinite()) return predictedIn(Fidelity::fine);
  return withNominal(coarse + correction_);
}

Eigen::VectorXd Comparison::predicted(const Model& model) const {
  return corrected([&](Fidelity fidelity) { return predicted(model, fidelity); });
}

Eigen::VectorXd Comparison::residualOf(const Model& model) const {
  Eigen::VectorXd residual = predicted(model);
  if (residual.size()) residual = measured_ - residual;
  return residual;
}

Eigen::VectorXd Comparison::predictedInOne(int signal, const Model& faulty, const Model& base) const {
  return corrected([&](Fidelity fidelity) {
    std::vector<Prediction> predictions;
    for (const Segment& segment : segments_) {
      const auto predict = [&](const Model& model) { return plant_.predict(segment.recording, model, segment.end_row, fidelity, focus_); };
      Prediction all = predict(base), one = predict(faulty);
      const auto index = static_cast<std::size_t>(signal);
      all.diverged |= one.diverged;
      all.values[index] = std::move(one.values[index]);
      predictions.push_back(std::move(all));
    }
    return withNominal(gathered(predictions));
  });
}

Eigen::VectorXd Comparison::predicted(const Model& model, Fidelity fidelity) const {
  std::vector<Prediction> predictions(segments_.size());
  parallelFor(static_cast<int>(segments_.size()), plant_.jobCount(), [&](int i) {
    const Segment& segment = segments_[static_cast<std::size_t>(i)];
    predictions[static_cast<std::size_t>(i)] = plant_.predict(segment.recording, model, segment.end_row, fidelity, focus_);
  });
  return withNominal(gathered(predictions));
}

/// A prediction with the values of the model without effects in all blocks that do not count.
Eigen::VectorXd Comparison::withNominal(Eigen::VectorXd prediction) const {
  if (prediction.size() && nominal_.size())
    for (const Block& block : blocks_)
      if (!counts(block)) prediction.segment(block.first, block.count()) = nominal_.segment(block.first, block.count());
  return prediction;
}

Eigen::VectorXd Comparison::predicted(const std::vector<Prediction>& per_segment, Fidelity fidelity) const {
  Eigen::VectorXd result = gathered(per_segment);
  if (result.size() && fidelity > Fidelity::fine) result += correction_;
  return result;
}

Eigen::VectorXd Comparison::gathered(const std::vector<Prediction>& per_segment) const {
  for (const Prediction& prediction : per_segment)
    if (prediction.diverged) return {};
  Eigen::VectorXd result(size_);
  const auto seriesOf = [&](std::size_t segment, int signal) -> const std::vector<double>& {
    return per_segment[segment].values[static_cast<std::size_t>(signal)];
  };
  for (const Block& block : blocks_) {
    if (!block.isReading()) continue;
    const std::vector<double>& y = seriesOf(block.segment, block.signal);
    for (std::size_t i = 0; i < block.rows.size(); ++i)
      result[block.first + static_cast<Eigen::Index>(i)] = y[static_cast<std::size_t>(block.rows[i])];
  }
  fillParity(result, seriesOf);
  average(result);
  return result;
}

double Comparison::meanSquare(const Block& block, const Eigen::VectorXd& residual) const {
  return residual.segment(block.first, block.count()).squaredNorm() / static_cast<double>(block.count());
}

void Comparison::setGap(const Eigen::VectorXd& nominal_residual) {
  for (Block& block : blocks_) block.gap = std::sqrt(meanSquare(block, nominal_residual));
}

namespace {

/// power / 2 ln((s^2 + ms) / (s^2 + sigma^2)) of one tolerance.
double misfitBeyond(const Tolerance& tolerance, const Comparison::Block& block, double mean_square) {
  const double left = tolerance.share_of_gap * block.gap, noise_square = block.sigma * block.sigma,
               scale_square = noise_square + left * left;
  return 0.5 * block.power * std::log((scale_square + mean_square) / (scale_square + noise_square));
}

}  // namespace

double Comparison::misfitOf(const Block& block, double mean_square) const {
  if (!isTempered()) return 0.5 * block.power * (mean_square / (block.sigma * block.sigma) - 1);
  double sum = 0;
  for (const Tolerance& tolerance : tolerances) sum += tolerance.nats * misfitBeyond(tolerance, block, mean_square);
  return sum;
}

std::array<double, tolerances.size()> Comparison::misfits(const Eigen::VectorXd& residual) const {
  std::array<double, tolerances.size()> sums{};
  for (const Block& block : blocks_)
    for (std::size_t i = 0; i < tolerances.size(); ++i) sums[i] += misfitBeyond(tolerances[i], block, meanSquare(block, residual));
  return sums;
}

double Comparison::misfit(const Eigen::VectorXd& residual) const {
  if (residual.size() != size_ || !residual.allFinite()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const Block& block : blocks_) sum += misfitOf(block, meanSquare(block, residual));
  return sum;
}

double Comparison::weightSquare(const Block& block, double mean_square) const {
  if (!isTempered()) return block.power / (block.sigma * block.sigma);
  double sum = 0;
  for (const Tolerance& tolerance : tolerances) {
    const double left = tolerance.share_of_gap * block.gap;
    sum += tolerance.nats / (block.sigma * block.sigma + left * left + mean_square);
  }
  return block.power * sum;
}

Eigen::VectorXd Comparison::weights(const Eigen::VectorXd& residual) const {
  Eigen::VectorXd result(size_);
  for (const Block& block : blocks_)
    result.segment(block.first, block.count())
        .setConstant(std::sqrt(weightSquare(block, meanSquare(block, residual)) / static_cast<double>(block.count())));
  return result;
}

double Comparison::scale() const {
  double power = 0, nats = 0;
  for (const Block& block : blocks_) power += block.power;
  for (const Tolerance& tolerance : tolerances) nats += tolerance.nats;
  return power * nats;
}

Gap Comparison::gap(const Eigen::VectorXd& residual) const {
  struct Sum {
    double squares = 0, readings = 0, reading_squares = 0;
    std::size_t count = 0;
  };
  std::map<int, Sum> sums;
  for (const Block& block : blocks_) {
    if (!block.isReading()) continue;
    Sum& sum = sums[block.signal];
    sum.squares += meanSquare(block, residual) * static_cast<double>(block.rows.size());
    sum.count += block.rows.size();
    const auto readings = measured_.segment(block.first, block.count());
    sum.readings += readings.sum();
    sum.reading_squares += readings.squaredNorm();
  }
  Gap gap;
  for (const auto& [signal, sum] : sums) {
    const ComparedSignal& compared = plant_.signals()[static_cast<std::size_t>(signal)];
    const auto count = static_cast<double>(sum.count);
    const double mean_square = sum.squares / count, sigma = compared.sigma.value, mean = sum.readings / count;
    gap.per_signal[compared.name] = {std::sqrt(mean_square), sigma, std::sqrt(std::max(0.0, sum.reading_squares / count - mean * mean))};
    gap.normalised += std::max(0.0, mean_square - sigma * sigma) / (sigma * sigma) / static_cast<double>(sums.size());
  }
  return gap;
}

namespace {

bool standsOut(const SignalGap& gap, const ComparedSignal& signal) {
  return gap.rmse >= (signal.sigma.isEstimated() ? out_of_estimated_noise : out_of_noise) * gap.noise_sigma;
}

}  // namespace

SmallGap largestBesideMotion(const Comparison& comparison, const Eigen::VectorXd& residual) {
  SmallGap largest;
  const Gap gap = comparison.gap(residual);
  for (const ComparedSignal& signal : comparison.plant().signals()) {
    const auto found = gap.per_signal.find(signal.name);
    if (found == gap.per_signal.end() || !standsOut(found->second, signal)) continue;
    const auto& [rmse, sigma, motion] = found->second;
    const double percent = 100 * std::sqrt(rmse * rmse - sigma * sigma) / motion;
    if (percent > largest.percent_of_motion) largest = {signal.name, percent};
  }
  return largest;
}

bool isWithinNoise(const Comparison& comparison, const Eigen::VectorXd& residual) {
  constexpr Eigen::Index enough_rows = 200;
  constexpr double known_in_one = 1.3, estimated_in_one = 1.5;
  const Gap gap = comparison.gap(residual);
  const auto& signals = comparison.plant().signals();
  const bool all = std::ranges::all_of(signals, [&](const ComparedSignal& signal) {
    const auto found = gap.per_signal.find(signal.name);
    return found == gap.per_signal.end() || !standsOut(found->second, signal);
  });
  return all && std::ranges::all_of(comparison.blocks(), [&](const Comparison::Block& block) {
           const bool is_estimated = signals[static_cast<std::size_t>(block.signal)].sigma.isEstimated();
           const double rms = std::sqrt(comparison.meanSquare(block, residual));
           return block.is_parity || block.count() < enough_rows || rms < (is_estimated ? estimated_in_one : known_in_one) * block.sigma;
         });
}

}  // namespace musclesim
