#include "figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "diagram.h"
#include "look_alikes.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim::blind {

namespace {

const Color grey{0.6, 0.6, 0.6, ""}, blue{0.10, 0.30, 0.75, ""}, orange{0.85, 0.45, 0.00, ""};
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Vertical bars from low to high as one series.
void addBar(DiagramSeries& bars, double x, const Rate& rate) {
  bars.x.insert(bars.x.end(), {x, x, x});
  bars.y.insert(bars.y.end(), {rate.low(), rate.high(), nan});
}

void addPoint(DiagramSeries& points, DiagramSeries& bars, double x, const Rate& rate) {
  if (rate.count == 0) return;
  points.x.push_back(x);
  points.y.push_back(rate.value());
  addBar(bars, x, rate);
}

/// Edges of the bins over the gap, in units of the noise. An exchange of channels may lie above all sizes.
constexpr double gap_edges[] = {0, 3.5, 6, 11, 20, 40, 90, std::numeric_limits<double>::infinity()};

/// One curve of the detectability figure.
void addDetectability(Diagram& diagram, const std::vector<Judgement>& cases, const std::string& label, const Color& color, double shift,
                      bool (*hit)(const Judgement&)) {
  DiagramSeries points{label, color, {}, {}, SvgMark::disc}, bars{"", color, {}, {}, SvgMark::none, 1}, line{"", color, {}, {}};
  for (std::size_t bin = 0; bin + 1 < std::size(gap_edges); ++bin) {
    Rate rate;
    double sum = 0;
    for (const Judgement& j : cases) {
      if (j.kind != "single" || j.gap_over_noise < gap_edges[bin] || j.gap_over_noise >= gap_edges[bin + 1]) continue;
      rate.add(hit(j));
      sum += std::log10(j.gap_over_noise);
    }
    addPoint(points, bars, sum / std::max(rate.count, 1) + shift, rate);
  }
  line.x = points.x;
  line.y = points.y;
  diagram.series.insert(diagram.series.end(), {line, bars, points});
}

constexpr double cell_px = 64, left_px = 120, top_px = 96;

void fillCell(Svg& svg, std::size_t row, std::size_t column, double share, int count) {
  const double x = left_px + cell_px * static_cast<double>(column), y = top_px + cell_px * (static_cast<double>(row) + 0.5);
  const double light = 1 - 0.75 * share;
  if (count > 0) svg.line({x, y}, {x + cell_px, y}, hexColor({light, light, 1 - 0.35 * share, ""}), cell_px);
  svg.frame({x, y - cell_px / 2, cell_px, cell_px}, "#bbbbbb");
  if (count > 0)
    svg.text({x + cell_px / 2, y + 5}, fmt::format("{}", count),
             {14, SvgAnchor::middle, share > 0.55 ? "#ffffff" : "#333333", false, false});
}

}  // namespace

std::string reliabilitySvg(const Score& score) {
  DiagramSeries ideal{"as often right as said", grey, {0, 1}, {0, 1}};
  DiagramSeries points{"answers, 95 % interval", blue, {}, {}, SvgMark::disc}, bars{"", blue, {}, {}, SvgMark::none, 1};
  for (const CalibrationBin& bin : calibrationBins(claimsOfOneCause(score.cases))) addPoint(points, bars, bin.mean_probability, bin.right);
  return diagramsSvg("Reliability", {{"single and open causes", "probability of the top answer", "share right", {ideal, bars, points}}}, 1);
}

std::string detectabilitySvg(const Score& score) {
  Diagram diagram{"single causes", "log10 of the gap over the noise", "share of cases", {}};
  addDetectability(diagram, score.cases, "effect found", orange, -0.01, [](const Judgement& j) { return j.verdict == "effects_found"; });
  addDetectability(diagram, score.cases, "acceptable answer first", blue, 0.01,
                   [](const Judgement& j) { return j.acceptable.value_or(false); });
  return diagramsSvg("Detectability", {diagram}, 1);
}

std::string answeredClass(const Judgement& j) {
  if (j.verdict == "no_gap" || j.verdict == "not_excited") return "no gap";
  if (j.verdict == "failed" || !j.namesEffect()) return "none";
  return nameOf(effectInfo(idOf(j.top)).stage);
}

std::string confusionSvg(const Score& score) {
  const std::vector<std::string> truths = {"command", "pressure", "force", "body", "sensor", "open"},
                                 answers = {"command", "pressure", "force", "body", "sensor", "none", "no gap"};
  std::map<std::string, std::map<std::string, int>> counts;
  std::map<std::string, int> sums;
  for (const Judgement& j : score.cases) {
    if (j.kind != "single" && j.kind != "open") continue;
    const std::string truth = j.kind == "open" ? "open" : j.true_stages.front();
    ++counts[truth][answeredClass(j)];
    ++sums[truth];
  }
  Svg svg(left_px + cell_px * static_cast<double>(answers.size()) + 24, top_px + cell_px * static_cast<double>(truths.size()) + 24,
          "Confusion");
  svg.text({16, 28}, "True stage (rows) and stage of the top answer (columns), cases", {15, SvgAnchor::start, "#222222", true, false});
  for (std::size_t c = 0; c < answers.size(); ++c)
    svg.text({left_px + cell_px * (static_cast<double>(c) + 0.5), top_px - 12}, answers[c],
             {12, SvgAnchor::middle, "#333333", false, false});
  for (std::size_t r = 0; r < truths.size(); ++r) {
    svg.text({left_px - 10, top_px + cell_px * (static_cast<double>(r) + 0.5) + 4}, truths[r],
             {12, SvgAnchor::end, "#333333", false, false});
    for (std::size_t c = 0; c < answers.size(); ++c) {
      const int count = counts[truths[r]][answers[c]];
      fillCell(svg, r, c, sums[truths[r]] ? static_cast<double>(count) / sums[truths[r]] : 0, count);
    }
  }
  return svg.document();
}

}  // namespace musclesim::blind
