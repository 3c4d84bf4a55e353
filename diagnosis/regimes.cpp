#include "regimes.h"

#include <fmt/format.h>

#include <cmath>

namespace musclesim {

namespace {

constexpr double reach_s = 0.1, rounding_s = 1e-9, least_change = 0.005;

Regime regimeAt(const Recording& recording, std::size_t row, std::size_t before) {
  double change = 0;
  for (int muscle = 0; muscle < recording.muscleCount(); ++muscle) {
    const auto& u = recording.find(fmt::format("command_{}", muscle))->values;
    if (const double step = u[row] - u[before]; std::abs(step) > std::abs(change)) change = step;
  }
  return change > least_change ? Regime::filling : change < -least_change ? Regime::venting : Regime::holding;
}

}  // namespace

std::string nameOf(Regime regime) {
  return regime == Regime::filling ? "filling" : regime == Regime::venting ? "venting" : "holding";
}

double RegimeSums::meanSquare(Regime regime) const {
  const auto i = static_cast<std::size_t>(regime);
  return rows[i] > 0 ? square[i] / rows[i] : 0;
}

RegimeSums regimeSums(const Comparison& comparison, const Eigen::VectorXd& residual) {
  RegimeSums sums;
  for (const Comparison::Cell& cell : comparison.cells()) {
    if (cell.block > 0) continue;
    const Recording& recording = comparison.plant().recordings()[static_cast<std::size_t>(comparison.stretches()[cell.stretch].recording)];
    std::size_t before = 0;
    for (std::size_t i = 0; i < cell.rows.size(); ++i) {
      const auto row = static_cast<std::size_t>(cell.rows[i]);
      while (recording.time_s[before] < recording.time_s[row] - reach_s - rounding_s) ++before;
      const std::size_t from = row > 0 ? std::min(before, row - 1) : 0;  // rows may lie further apart than that
      const auto regime = static_cast<std::size_t>(regimeAt(recording, row, from));
      const double r = residual[cell.first + static_cast<Eigen::Index>(i)] / cell.floor;
      sums.square[regime] += r * r;
      sums.rows[regime] += 1;
    }
  }
  return sums;
}

}  // namespace musclesim
