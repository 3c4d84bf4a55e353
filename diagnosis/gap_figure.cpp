#include "gap_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../log/columns.h"
#include "../log/diagram.h"

namespace musclesim {

namespace {

const Color measured_color{0.63, 0.63, 0.63, ""}, simulated_color{0.85, 0.37, 0.05, ""}, residual_color{0.04, 0.31, 0.62, ""};
constexpr double measured_width = 3.5, simulated_width = 1.5, cell_height = 270;

/// "length (mm)": what the axis of a signal shows.
std::string axisTitle(const std::string& signal) {
  const Column column = parseColumnName(signal);
  return fmt::format("{} ({})", column.quantity, column.canonical_unit.empty() ? "fraction" : column.canonical_unit);
}

Diagram valuesDiagram(const ReplayGap& gap) {
  return {gap.name,
          "time (s)",
          axisTitle(gap.name),
          {{"measured", measured_color, gap.time_s, gap.measured, SvgMark::none, measured_width},
           {"simulated", simulated_color, gap.time_s, gap.simulated, SvgMark::none, simulated_width}}};
}

Diagram residualDiagram(const ReplayGap& gap) {
  Diagram diagram = {fmt::format("{}: residual, RMS {:.3g}", gap.name, gap.rmse()),
                     "time (s)",
                     axisTitle(gap.name),
                     {{"residual: measured - simulated", residual_color, gap.time_s, gap.residuals(), SvgMark::none, simulated_width}}};
  diagram.band = DiagramBand{gap.band(), fmt::format("noise band: {:g} standard deviations of the noise", band_in_sigmas)};
  return diagram;
}

const ReplayGap* find(const std::vector<ReplayGap>& gaps, const std::string& name) {
  const auto found = std::ranges::find(gaps, name, &ReplayGap::name);
  return found == gaps.end() ? nullptr : &*found;
}

Diagram loop(const ReplayGap& x, const ReplayGap& y) {
  return {fmt::format("{} over {}", y.name, x.name),
          axisTitle(x.name),
          axisTitle(y.name),
          {{"measured", measured_color, x.measured, y.measured, SvgMark::none, measured_width},
           {"simulated", simulated_color, x.simulated, y.simulated, SvgMark::none, simulated_width}}};
}

/// Pearson's coefficient over the rows where both are measured; 0 where one is constant.
double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0, sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  for (std::size_t row = 0; row < std::min(x.size(), y.size()); ++row) {
    if (!std::isfinite(x[row]) || !std::isfinite(y[row])) continue;
    n += 1, sx += x[row], sy += y[row];
    sxx += x[row] * x[row], syy += y[row] * y[row], sxy += x[row] * y[row];
  }
  const double variances = (n * sxx - sx * sx) * (n * syy - sy * sy);
  return variances > 0 ? (n * sxy - sx * sy) / std::sqrt(variances) : 0;
}

/// The pressure that goes with an angle most; null if no pressure is measured.
const ReplayGap* pressureOf(const ReplayGap& angle, const std::vector<ReplayGap>& gaps) {
  const ReplayGap* best = nullptr;
  double strongest = 0;
  for (const ReplayGap& gap : gaps) {
    if (!gap.name.starts_with("pressure_")) continue;
    const double strength = std::abs(correlation(gap.measured, angle.measured));
    if (best && strength <= strongest) continue;
    best = &gap;
    strongest = strength;
  }
  return best;
}

std::vector<Diagram> loops(const std::vector<ReplayGap>& gaps) {
  std::vector<Diagram> diagrams;
  for (const ReplayGap& gap : gaps) {
    const ReplayGap* pressure = nullptr;
    if (gap.name.starts_with("length_")) pressure = find(gaps, fmt::format("pressure_{}", parseColumnName(gap.name).muscle));
    if (gap.name.starts_with("angle_")) pressure = pressureOf(gap, gaps);
    if (pressure) diagrams.push_back(loop(*pressure, gap));
  }
  return diagrams;
}

}  // namespace

std::string gapFigureSvg(const std::string& title, const std::vector<ReplayGap>& gaps) {
  std::vector<Diagram> diagrams;
  for (const ReplayGap& gap : gaps) {
    diagrams.push_back(valuesDiagram(gap));
    diagrams.push_back(residualDiagram(gap));
  }
  for (Diagram& diagram : loops(gaps)) diagrams.push_back(std::move(diagram));
  return diagramsSvg(title, diagrams, 2, cell_height);
}

}  // namespace musclesim
