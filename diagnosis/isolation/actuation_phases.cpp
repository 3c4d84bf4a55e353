#include "actuation_phases.h"

#include <fmt/format.h>

#include <cmath>

namespace musclesim {

namespace {

constexpr double window_s = 0.1, rounding_s = 1e-9, least_change = 0.005;

ActuationPhase phaseAt(const Recording& recording, std::size_t row, std::size_t before) {
  double change = 0;
  for (int muscle = 0; muscle < recording.muscleCount(); ++muscle) {
    const auto& u = recording.find(fmt::format("command_{}", muscle))->values;
    if (const double step = u[row] - u[before]; std::abs(step) > std::abs(change)) change = step;
  }
  return change > least_change ? ActuationPhase::filling : change < -least_change ? ActuationPhase::venting : ActuationPhase::holding;
}

}  // namespace

std::string nameOf(ActuationPhase phase) {
  return phase == ActuationPhase::filling ? "filling" : phase == ActuationPhase::venting ? "venting" : "holding";
}

double PhaseSums::meanSquare(ActuationPhase phase) const {
  const auto i = static_cast<std::size_t>(phase);
  return rows[i] > 0 ? square[i] / rows[i] : 0;
}

PhaseSums phaseSums(const Comparison& comparison, const Eigen::VectorXd& residual) {
  PhaseSums sums;
  for (const Comparison::Block& block : comparison.blocks()) {
    if (!block.isReading()) continue;
    const Recording& recording = comparison.plant().recordings()[static_cast<std::size_t>(comparison.segments()[block.segment].recording)];
    std::size_t before = 0;
    for (std::size_t i = 0; i < block.rows.size(); ++i) {
      const auto row = static_cast<std::size_t>(block.rows[i]);
      while (recording.time_s[before] < recording.time_s[row] - window_s - rounding_s) ++before;
      const std::size_t from = row > 0 ? std::min(before, row - 1) : 0;  // rows may be further apart than the window
      const auto phase = static_cast<std::size_t>(phaseAt(recording, row, from));
      const double r = residual[block.first + static_cast<Eigen::Index>(i)] / block.sigma;
      sums.square[phase] += r * r;
      sums.rows[phase] += 1;
    }
  }
  return sums;
}

std::string phaseOf(const Comparison& comparison, const Eigen::VectorXd& residual) {
  constexpr double fewest_rows = 50, stands_out = 1.5;
  const PhaseSums sums = phaseSums(comparison, residual);
  double square = 0, rows = 0, largest = 0;
  std::string found;
  for (const ActuationPhase phase : {ActuationPhase::filling, ActuationPhase::venting, ActuationPhase::holding}) {
    const auto i = static_cast<std::size_t>(phase);
    square += sums.square[i];
    rows += sums.rows[i];
    if (sums.rows[i] <= fewest_rows || sums.meanSquare(phase) <= largest) continue;
    largest = sums.meanSquare(phase);
    found = nameOf(phase);
  }
  return rows > 0 && largest > stands_out * square / rows ? found : "";
}

}  // namespace musclesim
