#include "gap_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../../log/columns.h"
#include "../../log/diagram.h"
#include "../data/loop_pairs.h"

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

Diagram loop(const ReplayGap& x, const ReplayGap& y) {
  return {fmt::format("{} over {}", y.name, x.name),
          axisTitle(x.name),
          axisTitle(y.name),
          {{"measured", measured_color, x.measured, y.measured, SvgMark::none, measured_width},
           {"simulated", simulated_color, x.simulated, y.simulated, SvgMark::none, simulated_width}}};
}

std::vector<Diagram> loops(const std::vector<ReplayGap>& gaps) {
  std::vector<TimedSignal> signals;
  signals.reserve(gaps.size());
  for (const ReplayGap& gap : gaps) signals.push_back({gap.name, gap.time_s, gap.measured});
  std::vector<Diagram> diagrams;
  for (const auto& [pressure, motion] : loopPairs(signals)) diagrams.push_back(loop(gaps[pressure], gaps[motion]));
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
