#include "bench_report.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "../log/svg.h"
#include "musclesim/version.h"

namespace musclesim::command_line {

namespace {

/// Figure 9 of the paper, on a computer of 2007: r(n) = 8.5e-3 n^3.2.
double paperRatio(double n) {
  return 8.5e-3 * std::pow(n, 3.2);
}

const std::array<Color, 12> line_colors = {{{0.75, 0.1, 0.1, ""},
                                            {0.9, 0.55, 0.1, ""},
                                            {0.1, 0.3, 0.75, ""},
                                            {0.2, 0.6, 0.85, ""},
                                            {0.1, 0.6, 0.5, ""},
                                            {0.2, 0.6, 0.2, ""},
                                            {0.5, 0.05, 0.3, ""},
                                            {0.7, 0.4, 0.4, ""},
                                            {0.3, 0.1, 0.6, ""},
                                            {0.55, 0.4, 0.8, ""},
                                            {0.4, 0.4, 0.4, ""},
                                            {0.1, 0.4, 0.1, ""}}};

const BenchRun* runAt(const BenchCurve& curve, int muscle_count) {
  for (const BenchRun& run : curve.runs)
    if (run.muscle_count == muscle_count) return &run;
  return nullptr;
}

std::string cell(const BenchRun& run) {
  return run.diverged ? fmt::format("{:.3g} (diverged at {:.3g} s)", run.ratio, run.simulated_s)
                      : fmt::format("{:.3g}{}", run.ratio, run.cut_short ? "*" : "");
}

std::string spreadWords(const BenchCurve& curve) {
  std::vector<double> spreads;
  for (const BenchRun& run : curve.runs)
    if (run.repeat_count > 1) spreads.push_back(run.spread);
  if (spreads.empty()) return "";
  std::sort(spreads.begin(), spreads.end());
  return fmt::format("{:.2f} .. {:.2f}", spreads[spreads.size() / 2], spreads.back());
}

/// Logarithmic axes of the figure.
struct Plane {
  SvgBox box{70, 40, 560, 520};
  double n_min = 1, n_max = 30, r_min = 1e-4, r_max = 1e4;
  SvgPoint at(double n, double r) const {
    return {box.left + box.width * std::log(n / n_min) / std::log(n_max / n_min),
            box.bottom() - box.height * std::log(r / r_min) / std::log(r_max / r_min)};
  }
};

void drawAxes(Svg& svg, const Plane& plane) {
  svg.frame(plane.box, "#333333");
  for (const int n : {1, 2, 5, 10, 15, 20, 30}) {
    const SvgPoint foot = plane.at(n, plane.r_min);
    svg.line(foot, plane.at(n, plane.r_max), "#eeeeee", 1);
    svg.text({foot.x, foot.y + 16}, std::to_string(n), {.anchor = SvgAnchor::middle});
  }
  for (double r = plane.r_min; r <= plane.r_max * 1.01; r *= 10) {
    svg.line(plane.at(plane.n_min, r), plane.at(plane.n_max, r), std::abs(r - 1) < 1e-9 ? "#333333" : "#e4e4e4", 1);
    svg.text({plane.box.left - 6, plane.at(1, r).y + 4}, fmt::format("{:g}", r), {.anchor = SvgAnchor::end});
  }
  svg.text({plane.box.left + plane.box.width / 2, plane.box.bottom() + 36}, "number of muscles n", {.anchor = SvgAnchor::middle});
  svg.text({18, plane.box.top + plane.box.height / 2}, "r = CPU time / simulated time", {.anchor = SvgAnchor::middle, .turned = true});
}

}  // namespace

double fittedExponent(const BenchCurve& curve, int first_count) {
  double count = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const BenchRun& run : curve.runs) {
    if (run.muscle_count < first_count || !(run.ratio > 0)) continue;
    const double x = std::log(run.muscle_count), y = std::log(run.ratio);
    ++count, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return count < 2 ? std::nan("") : (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

std::string benchTable(const std::vector<BenchCurve>& curves, double duration_s, double shortest_cpu_s, double time_limit_s) {
  std::string text =
      "# Performance\n\nWritten by `musclesim bench` (musclesim " MUSCLESIM_VERSION
      "); do not edit. r = CPU time of one thread over simulated time, of the RoboticArm under random\npressures, new ones every 0.25 s of "
      "true time. r < 1 is faster than real time. `original` physics is 31.6 times slower than true\ntime: its r is per second of its own "
      "clock, as in the paper. The real-time factor of `run`, simulated over wall time, is about 1/r.\n\n";
  text += fmt::format(
      "One process measured all of this; every number is the median of its repeats over {:g} true seconds or, where that is longer, {:g} s "
      "of CPU time. `*`: cut short after {:g} s of CPU time and not repeated. Exponent: b of the power law a n^b, fitted to the points "
      "from n = 10 "
      "on. Spread: the largest over the smallest of the repeats, median and worst over all n; it is far from 1 if the machine had other "
      "work.\n\n",
      duration_s, shortest_cpu_s, time_limit_s);
  text += "| |";
  std::string rule = "|---|";
  for (const BenchRun& run : curves.front().runs) text += fmt::format(" n = {} |", run.muscle_count), rule += "---|";
  text += " exponent | spread | internal steps | joint gap mm | contacts |\n" + rule + "---|---|---|---|---|\n| paper, 2007 |";
  for (const BenchRun& run : curves.front().runs) text += fmt::format(" {:.3g} |", paperRatio(run.muscle_count));
  text += " 3.2 | | 1 | | |\n";
  for (const BenchCurve& curve : curves) {
    text += "| " + curve.name + " |";
    double gap_mm = 0;
    int contacts = 0;
    for (const BenchRun& run : curve.runs) {
      text += " " + cell(run) + " |";
      gap_mm = std::max(gap_mm, run.gap_mm);
      contacts = std::max(contacts, run.contact_count);
    }
    text += fmt::format(" {:.2f} | {} | {} | {:.2g} | {} |\n", fittedExponent(curve, 10), spreadWords(curve), curve.runs.back().substeps,
                        gap_mm, contacts);
  }
  text +=
      "\nInternal steps: per control step of 0.01 s. Joint gap: the largest over all n; dWorldQuickStep is fast because it lets joints "
      "drift apart.\n";
  for (const char* physics : {"original", "si"}) {
    const BenchCurve *ode = nullptr, *chain = nullptr;
    for (const BenchCurve& curve : curves) {
      if (curve.name == std::string(physics) + ", dWorldStep") ode = &curve;
      if (curve.name == std::string(physics) + ", chain stepper") chain = &curve;
    }
    if (!ode || !chain) continue;
    text += fmt::format("\n`{}`: dWorldStep takes", physics);
    for (const BenchRun& run : ode->runs)
      if (const BenchRun* other = runAt(*chain, run.muscle_count))
        text += fmt::format("{} {:.1f} (n = {})", &run == &ode->runs.front() ? "" : ",", run.ratio / other->ratio, run.muscle_count);
    text += " times as long as the chain stepper.\n";
  }
  return text + "\n![r over the number of muscles, with the paper's curve](figures/performance.svg)\n";
}

std::string benchFigure(const std::vector<BenchCurve>& curves, BenchReference reference) {
  Svg svg(960, 620, "Real-time ratio over the number of muscles");
  const Plane plane;
  drawAxes(svg, plane);
  const double legend_x = plane.box.right() + 14;
  double legend_y = plane.box.top + 12;
  const auto draw = [&](const std::vector<SvgPoint>& points, const Color& color, double width, const std::string& name) {
    svg.curve({points}, color, width, plane.box, name);
    svg.sample({legend_x, legend_y - 4}, 18, color, width);
    svg.text({legend_x + 24, legend_y}, name, {.size = 11});
    legend_y += 20;
  };
  std::vector<SvgPoint> paper;
  for (double n = 1; n <= 30; n += 1) paper.push_back(plane.at(n, paperRatio(n)));
  if (reference == BenchReference::paper) draw(paper, {0, 0, 0, ""}, 2.5, "paper, 2007: 8.5e-3 n^3.2");
  for (std::size_t c = 0; c < curves.size(); ++c) {
    std::vector<SvgPoint> points;
    for (const BenchRun& run : curves[c].runs)
      if (run.ratio > 0) points.push_back(plane.at(run.muscle_count, run.ratio));
    draw(points, line_colors[c % line_colors.size()], 1.6, curves[c].name);
  }
  return svg.document();
}

nlohmann::json benchJson(const std::vector<BenchCurve>& curves) {
  nlohmann::json json;
  json["command"] = "bench";
  json["status"] = "done";
  for (const BenchCurve& curve : curves)
    for (const BenchRun& run : curve.runs) {
      json["ratio"][curve.name][std::to_string(run.muscle_count)] = run.ratio;
      json["real_time_factor"][curve.name][std::to_string(run.muscle_count)] = 1 / run.ratio;
      json["spread"][curve.name][std::to_string(run.muscle_count)] = run.spread;
    }
  return json;
}

}  // namespace musclesim::command_line
