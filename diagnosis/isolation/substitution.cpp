#include "substitution.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "../../base/parallel.h"
#include "musclesim/base/random.h"

namespace musclesim {

namespace {

const std::string& nameOf(const Comparison& comparison, const Comparison::Block& block) {
  return comparison.plant().signals()[static_cast<std::size_t>(block.signal)].name;
}

double sigmaOf(const Plant& plant, int signal) {
  return plant.signals()[static_cast<std::size_t>(signal)].sigma.value;
}

/// Mean square of a residual over its variance, row by row and averaged over blocks of rows, in which weak but slow differences stand out.
class BlockRatio {
 public:
  void add(double residual, double variance) {
    plain_ += residual * residual / variance, ++count_;
    residual_ += residual, variance_ += variance;
    if (++filled_ < averaging_rows) return;
    averaged_ += residual_ * residual_ / (variance_ * (1 + steady_share * steady_share * static_cast<double>(averaging_rows))),
        ++block_count_;
    residual_ = variance_ = 0, filled_ = 0;
  }
  bool isEmpty() const { return count_ == 0; }
  double largestRms() const { return std::sqrt(std::max(plain_ / count_, block_count_ > 0 ? averaged_ / block_count_ : 0.0)); }

 private:
  double plain_ = 0, averaged_ = 0, residual_ = 0, variance_ = 0;
  std::size_t filled_ = 0;
  int count_ = 0, block_count_ = 0;
};

/// Index of a compared signal; -1 if it is not compared.
int signalIndex(const Plant& plant, const std::string& name) {
  for (std::size_t i = 0; i < plant.signals().size(); ++i)
    if (plant.signals()[i].name == name) return static_cast<int>(i);
  return -1;
}

/// The measured pressures of a muscle, or the commanded ones.
struct Pressures {
  int signal = -1;  ///< -1: commanded
  const std::vector<double>* values = nullptr;
};

std::optional<Pressures> pressuresOf(const Plant& plant, int recording, int muscle) {
  if (const int p = signalIndex(plant, fmt::format("pressure_{}", muscle)); p >= 0) return Pressures{p, &plant.measured(recording, p)};
  if (plant.holds(Stage::command) || plant.holds(Stage::pressure)) return std::nullopt;
  return Pressures{-1, &plant.recordings()[static_cast<std::size_t>(recording)].find(fmt::format("command_{}", muscle))->values};
}

/// The test of one muscle; empty if there is nothing to compare.
std::optional<TensionTest> testTensionOf(const Comparison& comparison, const Eigen::VectorXd& residual, int muscle) {
  const Plant& plant = comparison.plant();
  const int f = signalIndex(plant, fmt::format("force_{}_N", muscle)), l = signalIndex(plant, fmt::format("length_{}_mm", muscle));
  if (f < 0 || l < 0) return std::nullopt;
  BlockRatio found, expected;
  bool commanded = false;
  for (const Comparison::Block& block : comparison.blocks()) {
    if (block.signal != l || !block.isReading()) continue;
    const int recording = comparison.segments()[block.segment].recording;
    const auto pressures = pressuresOf(plant, recording, muscle);
    if (!pressures) return std::nullopt;
    commanded = pressures->signal < 0;
    const double pressure_sigma = commanded ? 0 : sigmaOf(plant, pressures->signal);
    const auto &ps = *pressures->values, &fs = plant.measured(recording, f), &ls = plant.measured(recording, l);
    for (std::size_t k = 0; k < block.rows.size(); ++k) {
      const auto i = static_cast<std::size_t>(block.rows[k]);
      if (i >= ps.size() || i >= fs.size() || !std::isfinite(ps[i] + fs[i])) continue;
      const double law = plant.tensionN(muscle, ps[i], ls[i]);
      const double by_p = plant.tensionN(muscle, ps[i] + pressure_sigma, ls[i]) - law,
                   by_l = plant.tensionN(muscle, ps[i], ls[i] + sigmaOf(plant, l)) - law;
      const double variance = by_p * by_p + by_l * by_l + sigmaOf(plant, f) * sigmaOf(plant, f);
      found.add(fs[i] - law, variance);
      expected.add(plant.tensionN(muscle, ps[i], ls[i] - residual[block.first + static_cast<Eigen::Index>(k)]) - law, variance);
    }
  }
  if (found.isEmpty()) return std::nullopt;
  return TensionTest{found.largestRms(), expected.largestRms(), commanded, commanded, true};
}

/// A signal of motion in all segments, row by row; NaN where it is not measured.
struct Motion {
  int signal;
  double sigma;
  std::vector<double> measured, simulated;
  double ratio = 0;  ///< largest RMS over sigma of its blocks
};

std::vector<Motion> motionsOf(const Comparison& comparison, const Eigen::VectorXd& residual) {
  std::vector<Motion> motions;
  const Plant& plant = comparison.plant();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::size_t> begin{0};
  for (const Segment& segment : comparison.segments()) begin.push_back(begin.back() + static_cast<std::size_t>(segment.end_row));
  for (int signal = 0; signal < static_cast<int>(plant.signals().size()); ++signal) {
    if (!isMotion(plant.signals()[static_cast<std::size_t>(signal)].name)) continue;
    Motion motion{signal, sigmaOf(plant, signal), std::vector<double>(begin.back(), nan), std::vector<double>(begin.back(), nan)};
    for (const Comparison::Block& block : comparison.blocks()) {
      if (block.signal != signal || block.is_parity) continue;
      motion.ratio = std::max(motion.ratio, std::sqrt(comparison.meanSquare(block, residual)) / block.sigma);
      if (!block.isReading()) continue;
      for (std::size_t k = 0; k < block.rows.size(); ++k) {
        const std::size_t row = begin[block.segment] + static_cast<std::size_t>(block.rows[k]);
        const Eigen::Index i = block.first + static_cast<Eigen::Index>(k);
        motion.measured[row] = comparison.measured()[i];
        motion.simulated[row] = comparison.measured()[i] - residual[i];
      }
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

/// A polynomial fit of the simulated values of one signal over those of another.
class Curve {
 public:
  Curve(const Motion& of, const Motion& over) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < over.simulated.size(); ++i)
      if (std::isfinite(over.simulated[i] + of.simulated[i])) rows.push_back(i);
    if (rows.size() < fewest_rows) return;
    double low = over.simulated[rows.front()], high = low;
    for (const std::size_t row : rows) low = std::min(low, over.simulated[row]), high = std::max(high, over.simulated[row]);
    if (!(high - low > moves * over.sigma)) return;
    middle_ = (low + high) / 2, half_ = (high - low) / 2;
    Eigen::MatrixXd powers(static_cast<Eigen::Index>(rows.size()), degree + 1);
    Eigen::VectorXd values(powers.rows());
    for (Eigen::Index i = 0; i < powers.rows(); ++i) {
      const double x = (over.simulated[rows[static_cast<std::size_t>(i)]] - middle_) / half_;
      for (int power = 0; power <= degree; ++power) powers(i, power) = std::pow(x, power);
      values[i] = of.simulated[rows[static_cast<std::size_t>(i)]];
    }
    coefficients_ = powers.colPivHouseholderQr().solve(values);
    const double error = std::sqrt((powers * coefficients_ - values).squaredNorm() / static_cast<double>(rows.size()));
    fits_ = error < close * of.sigma;
  }
  /// Whether one signal is a function of the other, to within a part of its noise.
  bool fits() const { return fits_; }
  bool covers(double x) const { return std::abs(x - middle_) <= half_; }
  double at(double x) const {
    double sum = 0;
    for (int power = degree; power >= 0; --power) sum = sum * (x - middle_) / half_ + coefficients_[power];
    return sum;
  }

 private:
  static constexpr int degree = 6;
  static constexpr std::size_t fewest_rows = 100;
  static constexpr double moves = 20;   ///< least range over noise of a signal that determines others
  static constexpr double close = 0.3;  ///< of the noise
  double middle_ = 0, half_ = 1;
  Eigen::VectorXd coefficients_;
  bool fits_ = false;
};

/// Difference between a signal and its value computed from another one, over the noise of both; empty if it is no function of it.
std::optional<double> contradiction(const Motion& of, const Motion& by) {
  const Curve curve(of, by);
  if (!curve.fits()) return std::nullopt;
  BlockRatio ratio;
  for (std::size_t i = 0; i < by.measured.size(); ++i) {
    const double x = by.measured[i];
    if (!std::isfinite(x + of.measured[i]) || !curve.covers(x)) continue;
    const double steepness = (curve.at(x + by.sigma) - curve.at(x - by.sigma)) / 2;
    ratio.add(of.measured[i] - curve.at(x), of.sigma * of.sigma + steepness * steepness);
  }
  if (ratio.isEmpty()) return std::nullopt;
  return ratio.largestRms();
}

constexpr int noise_draws = 4;

/// Replaces missing numbers by the one before, at the beginning by the first one; empty if there is none at all.
std::vector<double> withoutHoles(std::vector<double> values) {
  const auto first = std::ranges::find_if(values, [](double value) { return std::isfinite(value); });
  if (first == values.end()) return {};
  double last = *first;
  for (double& value : values) last = value = std::isfinite(value) ? value : last;
  return values;
}

/// Prediction with the measured pressures as commands of the model, with as much noise again added if a stream is given; empty if the model
/// diverges or a pressure is missing.
Eigen::VectorXd predictedUnderMeasuredPressures(const Comparison& comparison, RandomStream* noise) {
  const Plant& plant = comparison.plant();
  std::vector<std::vector<std::vector<double>>> commands_of;
  for (const Segment& segment : comparison.segments()) {
    const std::size_t rows = plant.recordings()[static_cast<std::size_t>(segment.recording)].time_s.size();
    std::vector<std::vector<double>> commands(rows, std::vector<double>(static_cast<std::size_t>(plant.muscleCount())));
    for (int muscle = 0; muscle < plant.muscleCount(); ++muscle) {
      const int signal = signalIndex(plant, fmt::format("pressure_{}", muscle));
      std::vector<double> p = plant.measured(segment.recording, signal);
      if (noise)
        for (double& value : p) value += sigmaOf(plant, signal) * noise->normal();
      p = withoutHoles(std::move(p));
      if (p.size() != rows) return {};
      for (std::size_t row = 0; row < rows; ++row)
        commands[row][static_cast<std::size_t>(muscle)] = std::clamp((p[row] + p[std::min(row + 1, rows - 1)]) / 2, 0.0, 1.0);
    }
    commands_of.push_back(std::move(commands));
  }
  std::vector<Prediction> predictions(commands_of.size());
  parallelFor(static_cast<int>(predictions.size()), plant.jobCount(), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    const Segment& segment = comparison.segments()[k];
    predictions[k] = plant.predict(segment.recording, Model{}, commands_of[k], segment.end_row, Fidelity::fine);
  });
  return comparison.predicted(predictions, Fidelity::fine);
}

}  // namespace

std::optional<double> ratioOf(const Comparison& comparison, const Eigen::VectorXd& residual, const std::string& beginning) {
  double sum = 0;
  int count = 0;
  for (const Comparison::Block& block : comparison.blocks()) {
    if (block.is_parity || !nameOf(comparison, block).starts_with(beginning)) continue;
    sum += comparison.meanSquare(block, residual) / (block.sigma * block.sigma);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

std::string mostAffected(const Comparison& comparison, const Eigen::VectorXd& residual, const std::string& beginning) {
  std::string name;
  double largest = 0;
  for (const Comparison::Block& block : comparison.blocks()) {
    const double ratio = std::sqrt(comparison.meanSquare(block, residual)) / block.sigma;
    if (block.is_parity || !nameOf(comparison, block).starts_with(beginning) || ratio <= largest) continue;
    largest = ratio;
    name = nameOf(comparison, block);
  }
  return name;
}

double largestMotionRatio(const Comparison& comparison, const Eigen::VectorXd& residual) {
  double largest = 0;
  for (const Comparison::Block& block : comparison.blocks())
    if (!block.is_parity && isMotion(nameOf(comparison, block)))
      largest = std::max(largest, std::sqrt(comparison.meanSquare(block, residual)) / block.sigma);
  return largest;
}

bool allPressuresMeasured(const Comparison& comparison) {
  for (std::size_t segment = 0; segment < comparison.segments().size(); ++segment)
    for (int muscle = 0; muscle < comparison.plant().muscleCount(); ++muscle) {
      const std::string name = fmt::format("pressure_{}", muscle);
      if (std::ranges::none_of(comparison.blocks(),
                               [&](const auto& block) { return block.segment == segment && nameOf(comparison, block) == name; }))
        return false;
    }
  return true;
}

std::optional<PressureTest> testPressures(const Comparison& comparison, const Eigen::VectorXd& residual) {
  const Eigen::VectorXd followed = predictedUnderMeasuredPressures(comparison, nullptr);
  if (!followed.size()) return std::nullopt;
  std::vector<Eigen::VectorXd> noises;
  RandomStream random(1, "diagnosis.substitution");
  for (int draw = 0; draw < noise_draws; ++draw) {
    const Eigen::VectorXd noisier = predictedUnderMeasuredPressures(comparison, &random);
    if (!noisier.size()) return std::nullopt;
    noises.push_back(noisier - followed);
  }
  const Eigen::VectorXd left = comparison.measured() - followed, change = residual - left;
  PressureTest test;
  double gap = 0, with_change = 0, block_count = 0;
  Eigen::VectorXd with_noise = Eigen::VectorXd::Zero(noise_draws);
  for (const Comparison::Block& block : comparison.blocks()) {
    if (block.is_parity || nameOf(comparison, block).starts_with("pressure_")) continue;
    auto meanProduct = [&](const Eigen::VectorXd& one, const Eigen::VectorXd& other) {
      return one.segment(block.first, block.count()).dot(other.segment(block.first, block.count())) / static_cast<double>(block.count());
    };
    auto logMisfit = [](double square, double sigma_square) { return 0.5 * std::log(std::max(1.0, square / sigma_square)); };
    double noise_square = 0;
    for (const Eigen::VectorXd& noise : noises) noise_square += meanProduct(noise, noise) / noise_draws;
    const double square = meanProduct(residual, residual), sigma_square = block.sigma * block.sigma;
    const double noisy_square = sigma_square + noise_square;
    test.misfit += logMisfit(square, sigma_square);
    test.misfit_increase += logMisfit(meanProduct(left, left), noisy_square) - logMisfit(square, noisy_square);
    ++block_count;
    if (square < out_of_noise * out_of_noise * sigma_square) continue;
    gap += (square - sigma_square) / noisy_square;
    with_change += meanProduct(residual, change) / noisy_square;
    for (int draw = 0; draw < noise_draws; ++draw)
      with_noise[draw] += meanProduct(residual, noises[static_cast<std::size_t>(draw)]) / noisy_square;
  }
  if (block_count > 0) test.misfit /= block_count, test.misfit_increase /= block_count;
  if (gap > 0) test.share = with_change / gap, test.share_deviation = std::sqrt(with_noise.squaredNorm() / noise_draws) / gap;
  return test;
}

std::optional<TensionTest> testTension(const Comparison& comparison, const Eigen::VectorXd& residual) {
  const Plant& plant = comparison.plant();
  if (plant.holds(Stage::force) || plant.holds(Stage::sensor)) return std::nullopt;
  std::optional<TensionTest> largest;
  bool some_commanded = false, all_commanded = true, of_all = true;
  for (int muscle = 0; muscle < plant.muscleCount(); ++muscle) {
    const auto one = testTensionOf(comparison, residual, muscle);
    some_commanded = some_commanded || (one && one->some_commanded);
    all_commanded = all_commanded && one && one->all_commanded;
    of_all = of_all && one;
    if (one && (!largest || one->found > largest->found)) largest = one;
  }
  if (largest) *largest = {largest->found, largest->expected, some_commanded, all_commanded, of_all};
  return largest;
}

std::optional<MotionTest> testMotion(const Comparison& comparison, const Eigen::VectorXd& residual) {
  const std::vector<Motion> motions = motionsOf(comparison, residual);
  // For every pair of signals the larger contradiction of the two curves.
  std::vector<std::vector<std::optional<double>>> pairs(motions.size(), std::vector<std::optional<double>>(motions.size()));
  bool told = false;
  for (std::size_t i = 0; i < motions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      pairs[i][j] = pairs[j][i] = std::max(contradiction(motions[i], motions[j]), contradiction(motions[j], motions[i]));
      told = told || pairs[i][j];
    }
  if (!told) return std::nullopt;
  MotionTest test;
  auto all = [&](auto&& holds) {
    for (std::size_t i = 0; i < motions.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (pairs[i][j] && !holds(i, j, *pairs[i][j])) return false;
    return true;
  };
  int visible_count = 0;
  for (std::size_t s = 0; s < motions.size(); ++s) {
    if (std::ranges::none_of(pairs[s], [](const auto& ratio) { return ratio.has_value(); })) continue;
    test.compared.push_back(comparison.plant().signals()[static_cast<std::size_t>(motions[s].signal)].name);
    visible_count += motions[s].ratio > disagrees ? 1 : 0;
  }
  test.compared_all = test.compared.size() == motions.size();
  test.agree = visible_count > 1 && all([](std::size_t, std::size_t, double ratio) { return ratio < agrees; });
  for (std::size_t s = 0; s < motions.size(); ++s) {
    const bool contradicted =
        std::ranges::any_of(pairs[s], [](const auto& ratio) { return ratio.has_value(); }) &&
        all([&](std::size_t i, std::size_t j, double ratio) { return i == s || j == s ? ratio > disagrees : ratio < agrees; });
    if (!contradicted || motions[s].ratio < disagrees) continue;
    bool others_right = true;
    for (std::size_t other = 0; other < motions.size(); ++other)
      others_right = others_right && (other == s || motions[other].ratio < disagrees);
    double ratio = 0;
    for (const auto& pair : pairs[s]) ratio = std::max(ratio, pair.value_or(0));
    // Of two signals that contradict each other, the faulty one is the one that is not as predicted.
    if (!test.odd.empty() && !others_right) continue;
    test.odd = comparison.plant().signals()[static_cast<std::size_t>(motions[s].signal)].name;
    test.odd_ratio = ratio;
    test.others_right = others_right;
  }
  return test;
}

}  // namespace musclesim
