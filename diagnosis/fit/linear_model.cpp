#include "linear_model.h"

#include <algorithm>
#include <cmath>

#include "../../base/parallel.h"

namespace musclesim {

void descend(const Eigen::MatrixXd& normal, const Eigen::VectorXd& slope, const Eigen::VectorXd& least, const Eigen::VectorXd& most,
             double still, Eigen::VectorXd& x) {
  constexpr int most_sweeps = 200;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double largest_step = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double next = std::clamp(x[i] + (slope[i] - normal.row(i).dot(x)) / normal(i, i), least[i], most[i]);
      largest_step = std::max(largest_step, std::abs(next - x[i]));
      x[i] = next;
    }
    if (largest_step <= still) return;
  }
}

LinearModel::LinearModel(const Comparison& comparison, const Eigen::VectorXd& residual, std::vector<Column> columns)
    : comparison_(comparison), columns_(std::move(columns)) {
  const auto count = static_cast<Eigen::Index>(columns_.size());
  grams_.resize(comparison.blocks().size());
  parallelFor(static_cast<int>(grams_.size()), comparison.plant().jobCount(), [&](int b) {
    const auto index = static_cast<std::size_t>(b);
    const Comparison::Block& block = comparison.blocks()[index];
    Eigen::MatrixXd part(block.count(), count + 1), lower = Eigen::MatrixXd::Zero(count + 1, count + 1);
    for (Eigen::Index i = 0; i < count; ++i)
      part.col(i) = columns_[static_cast<std::size_t>(i)].change->segment(block.first, block.count());
    part.col(count) = residual.segment(block.first, block.count());
    lower.selfadjointView<Eigen::Lower>().rankUpdate(part.transpose(), 1 / static_cast<double>(block.count()));
    grams_[index] = lower.selfadjointView<Eigen::Lower>();
  });
}

LinearModel::Normal LinearModel::normalOf(const std::vector<std::size_t>& columns, const std::vector<double>& weights) const {
  const auto count = static_cast<Eigen::Index>(columns.size());
  Normal normal{Eigen::MatrixXd::Zero(count, count), Eigen::VectorXd::Zero(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Column& column = columns_[columns[static_cast<std::size_t>(i)]];
    normal.matrix(i, i) = column.precision + 1e-9;
    normal.slope[i] = -column.precision * column.start;
  }
  const Eigen::Index last = grams_.front().rows() - 1;
  for (std::size_t b = 0; b < grams_.size(); ++b)
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto row = static_cast<Eigen::Index>(columns[static_cast<std::size_t>(i)]);
      for (Eigen::Index j = 0; j <= i; ++j)
        normal.matrix(i, j) += weights[b] * grams_[b](row, static_cast<Eigen::Index>(columns[static_cast<std::size_t>(j)]));
      normal.slope[i] += weights[b] * grams_[b](row, last);
    }
  normal.matrix = normal.matrix.selfadjointView<Eigen::Lower>();
  return normal;
}

LinearModel::Solution LinearModel::solve(const std::vector<std::size_t>& columns) const {
  constexpr int reweightings = 4;
  constexpr double longest_step = 8;  // over that of the weighted squares
  constexpr double still = 1e-6;      // of amounts
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(count), least(count), most(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    least[i] = columns_[columns[static_cast<std::size_t>(i)]].least;
    most[i] = columns_[columns[static_cast<std::size_t>(i)]].most;
  }
  x = x.cwiseMax(least).cwiseMin(most);
  const Eigen::Index last = grams_.front().rows() - 1;
  std::vector<double> mean_squares(grams_.size()), weights(grams_.size());
  const auto cost = [&] {
    double sum = 0;
    for (std::size_t b = 0; b < grams_.size(); ++b) {
      double square = grams_[b](last, last);
      for (Eigen::Index i = 0; i < count; ++i) {
        const auto row = static_cast<Eigen::Index>(columns[static_cast<std::size_t>(i)]);
        square -= 2 * x[i] * grams_[b](row, last);
        for (Eigen::Index j = 0; j < count; ++j)
          square += x[i] * x[j] * grams_[b](row, static_cast<Eigen::Index>(columns[static_cast<std::size_t>(j)]));
      }
      mean_squares[b] = std::max(0.0, square);
      sum += comparison_.misfitOf(comparison_.blocks()[b], mean_squares[b]);
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const Column& column = columns_[columns[static_cast<std::size_t>(i)]];
      sum += 0.5 * column.precision * (column.start + x[i]) * (column.start + x[i]);
    }
    return sum;
  };
  Solution best{cost(), x};
  for (int round = 0; round < reweightings && count > 0; ++round) {
    for (std::size_t b = 0; b < grams_.size(); ++b) weights[b] = comparison_.weightSquare(comparison_.blocks()[b], mean_squares[b]);
    const Normal normal = normalOf(columns, weights);
    const Eigen::VectorXd before = x;
    descend(normal.matrix, normal.slope, least, most, still, x);
    double now = cost();
    // Weighted squares are steeper than the misfit they stand for, so that a longer step is often better.
    for (double length = 2; length <= longest_step; length *= 2) {
      const Eigen::VectorXd nearer = x;
      x = (before + 2 * (nearer - before)).cwiseMax(least).cwiseMin(most);
      if (const double farther = cost(); farther < now) {
        now = farther;
      } else {
        x = nearer;
        cost();  // its mean squares are those of the next weights
        break;
      }
    }
    if (now < best.cost) best = {now, x};
  }
  return best;
}

}  // namespace musclesim
