#include "report_figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "../log/axis.h"
#include "../log/curve.h"
#include "../log/svg.h"
#include "sentences.h"

namespace musclesim {

namespace {

constexpr const char* guilty_color = "#b00020";

/// A drawing with further markup inserted before its end.
std::string with(const Svg& svg, const std::string& markup) {
  std::string document = svg.document();
  return document.insert(document.rfind("</svg>"), markup);
}

std::string pathData(const std::vector<std::vector<SvgPoint>>& pieces) {
  std::string data;
  for (const auto& piece : pieces)
    for (std::size_t i = 0; i < piece.size(); ++i) data += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", piece[i].x, piece[i].y);
  return data;
}

/// "pressure_0" of "signal_pressure_0": the label below the sensor's box must not be wider than the box.
std::string withoutPrefix(const std::string& component) {
  const std::string prefix = "signal_";
  return component.starts_with(prefix) ? component.substr(prefix.size()) : component;
}

}  // namespace

std::string barsFigure(const std::string& title, const std::vector<Bar>& bars, double full) {
  std::string rows;
  for (const Bar& bar : bars)
    rows += fmt::format(
        "<div class=bar><span>{}</span><span class=length><span class=\"fill{}\" style=\"width:calc((100% - 5rem)*{:.4f})\"></span>"
        "<span>{}</span></span></div>\n",
        escapedXml(bar.label), bar.strong ? " strong" : "", full > 0 ? std::clamp(bar.value / full, 0.0, 1.0) : 0.0,
        escapedXml(bar.number));
  return fmt::format("<div class=bars role=group aria-label=\"{}\">\n{}</div>\n", escapedXml(title), rows);
}

std::string stagesFigure(const std::vector<Place>& where) {
  constexpr std::array<const char*, 5> stages = {"command", "pressure", "force", "body", "sensor"};
  constexpr double box = 94, gap = 20, height = 58, top = 6;
  const double width = static_cast<double>(stages.size()) * (box + gap) - gap + 4;
  Svg svg(width, height + 34, "The way of a sample and the shares of the gap");
  std::string markup;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double x = 2 + static_cast<double>(i) * (box + gap);
    const auto place = std::ranges::find(where, std::string(stages[i]), &Place::stage);
    const double share = place == where.end() ? 0 : place->share;
    const bool marked = mayBeAt(where, stages[i]);
    const int grey = static_cast<int>(std::lround(245 - 190 * share));
    const std::string ink = share > 0.5 ? "#ffffff" : "#222222";
    markup += fmt::format(
        "<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" rx=\"8\" fill=\"rgb({},{},{})\" stroke=\"{}\" "
        "stroke-width=\"{}\"/>",
        x, top, box, height, grey, grey, grey, marked ? guilty_color : "#888888", marked ? 4 : 1);
    auto words = [&](double y, const std::string& text, int size, const std::string& color) {
      markup += fmt::format(
          "<text x=\"{:.0f}\" y=\"{:.0f}\" font-family=\"sans-serif\" font-size=\"{}\" text-anchor=\"middle\" fill=\"{}\">{}</text>",
          x + box / 2, y, size, color, escapedXml(text));
    };
    words(top + 24, stages[i], 15, ink);
    words(top + 46, fmt::format("{:.0f} %", 100 * share), 17, ink);
    if (share >= 0.05) words(top + height + 20, withoutPrefix(place->component), 13, "#222222");
    if (i + 1 < stages.size())
      markup += fmt::format("<path d=\"M{0:.0f} {1:.0f}h{2:.0f}m-7 -5l7 5l-7 5\" fill=\"none\" stroke=\"#555555\" stroke-width=\"1.6\"/>",
                            x + box + 4, top + height / 2, gap - 8);
  }
  return with(svg, markup);
}

namespace {

/// The drawn components that a place stands for: "signal_length_0" the muscle, "signal_angle_elbow" the joint, "muscle_0+muscle_1" both.
std::vector<std::string> drawnComponents(const RobotDrawing& drawing, const Place& place) {
  std::string name = place.component;
  for (const char* quantity : {"length_", "force_", "pressure_"})
    if (name.starts_with(std::string("signal_") + quantity)) name = "muscle_" + name.substr(7 + std::string(quantity).size());
  if (name.starts_with("signal_angle_")) name = "joint_" + name.substr(13);
  if (name.starts_with("signal_hand")) name = "hand";
  std::vector<std::string> names;
  for (std::istringstream parts(name); std::getline(parts, name, '+');) names.push_back(name);
  const bool all_muscles = place.component == "all" && place.stage != "body" && place.stage != "sensor";
  std::vector<std::string> drawn;
  for (const RobotDrawing::Line& line : drawing.lines)
    if (!line.component.empty() && (all_muscles || std::ranges::find(names, line.component) != names.end()))
      drawn.push_back(line.component);
  for (const RobotDrawing::Point& point : drawing.points)
    if (std::ranges::find(names, point.component) != names.end()) drawn.push_back(point.component);
  return drawn;
}

}  // namespace

std::string robotFigure(const RobotDrawing& drawing, const Place& place) {
  if (drawing.lines.empty()) return "";
  Eigen::AlignedBox2d box;
  for (const RobotDrawing::Line& line : drawing.lines)
    for (const Eigen::Vector2d& point : line.points_mm) box.extend(point);
  constexpr double most_height = 300, margin = 34, most_width = 640;
  const Eigen::Vector2d extent = box.sizes().cwiseMax(1.0);
  const double scale = std::min((most_height - 2 * margin) / extent.y(), (most_width - 2 * margin) / extent.x());
  const double width = std::max(220.0, extent.x() * scale + 2 * margin), height = std::max(110.0, extent.y() * scale + 2 * margin);
  auto pixel = [&](const Eigen::Vector2d& p) {
    return SvgPoint{width / 2 + (p.x() - box.center().x()) * scale, height / 2 - (p.y() - box.center().y()) * scale};
  };
  const std::vector<std::string> marked = drawnComponents(drawing, place);
  const auto isMarked = [&](const std::string& component) { return std::ranges::find(marked, component) != marked.end(); };
  const Svg svg(width, height, "The robot from the front" + (marked.empty() ? "" : fmt::format("; marked: {}", fmt::join(marked, ", "))));
  std::string markup, labels;
  auto label = [](SvgPoint at, const std::string& component) {
    return fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" font-family=\"sans-serif\" font-size=\"13\" font-weight=\"bold\" fill=\"{}\">{}</text>", at.x,
        at.y, guilty_color, escapedXml(component));
  };
  for (const RobotDrawing::Line& line : drawing.lines) {
    const bool muscle = !line.component.empty(), guilty = muscle && isMarked(line.component);
    std::vector<SvgPoint> points;
    for (const Eigen::Vector2d& point : line.points_mm) points.push_back(pixel(point));
    markup += fmt::format(
        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.1f}\" stroke-linecap=\"round\" "
        "stroke-linejoin=\"round\"><title>{}</title></path>",
        pathData({points}),
        guilty   ? guilty_color
        : muscle ? "#9a9a9a"
                 : "#dcdcdc",
        std::max(2.0, line.width_mm * scale) + (guilty ? 2 : 0), muscle ? line.component : "bone");
    if (guilty && place.component != "all") {
      const SvgPoint before = points[(points.size() - 1) / 2], behind = points[points.size() / 2];
      labels += label({0.5 * (before.x + behind.x) + 14, 0.5 * (before.y + behind.y) - 12}, line.component);
    }
  }
  for (const RobotDrawing::Point& point : drawing.points) {
    if (!isMarked(point.component)) continue;
    const SvgPoint at = pixel(point.point_mm);
    markup += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"11\" fill=\"none\" stroke=\"{}\" stroke-width=\"4\"/>", at.x, at.y,
                          guilty_color);
    labels += label({at.x + 18, at.y + 5}, point.component);
  }
  return with(svg, markup + labels);
}

std::string traceFigure(const Trace& trace, bool has_after) {
  constexpr double width = 900, height = 230;
  const SvgBox box{70, 26, width - 90, height - 66};
  Extent values, times;
  for (const auto* one : {&trace.measured, &trace.before, &trace.after}) values.add(*one);
  times.add(trace.time_s);
  const Axis time_axis(times, box.left, box.right(), 8, false), value_axis(values, box.bottom(), box.top, 5, true);
  Svg svg(width, height, trace.signal);
  for (const double tick : value_axis.ticks()) {
    svg.line({box.left, value_axis.pixel(tick)}, {box.right(), value_axis.pixel(tick)}, "#e5e5e5", 1);
    svg.text({box.left - 6, value_axis.pixel(tick) + 4}, value_axis.label(tick), {12, SvgAnchor::end});
  }
  svg.text({0.5 * (box.left + box.right()), height - 8}, "time, s", {12, SvgAnchor::middle});
  svg.frame(box, "#999999");
  struct Kind {
    const std::vector<double>& y;
    const char *words, *color, *dash;
    double line_width;
  };
  const std::array<Kind, 3> kinds = {Kind{trace.measured, "measured", "#a0a0a0", "", 3.5},
                                     Kind{trace.before, has_after ? "simulated before" : "simulated", "#d95f0e", "7 4", 1.5},
                                     Kind{trace.after, "simulated after", "#0b4f9e", "", 1.3}};
  std::string markup, curves;
  double x = box.left;
  for (const Kind& kind : kinds) {
    if (kind.y.empty()) continue;
    const std::string stroke = fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\"", kind.color,
                                           kind.line_width, *kind.dash ? kind.dash : "none");
    markup += fmt::format("<path d=\"M{:.0f} 14h26\" {}/>", x, stroke);
    markup += fmt::format("<text x=\"{:.0f}\" y=\"18\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#333333\">{}</text>", x + 32,
                          kind.words);
    x += 160;
    curves += fmt::format("<path d=\"{}\" {} vector-effect=\"non-scaling-stroke\"/>",
                          pathData(curvePieces(trace.time_s, kind.y, time_axis, value_axis, Between::straight)), stroke);
  }
  // The curves have their own viewport, which the script narrows.
  markup += fmt::format(
      "<svg class=\"view\" x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" viewBox=\"{0} {1} {2} {3}\" preserveAspectRatio=\"none\" "
      "data-start=\"{4}\" data-end=\"{5}\">{6}</svg>",
      box.left, box.top, box.width, box.height, time_axis.minimum(), time_axis.maximum(), curves);
  markup +=
      fmt::format("<g class=\"ticks\" font-family=\"sans-serif\" font-size=\"12\" text-anchor=\"middle\" fill=\"#333333\" data-y=\"{}\">",
                  box.bottom() + 16);
  for (const double tick : time_axis.ticks())
    markup += fmt::format("<text x=\"{:.1f}\" y=\"{}\">{}</text>", time_axis.pixel(tick), box.bottom() + 16, time_axis.label(tick));
  return "<div class=\"trace\"><h3><code>" + escapedXml(trace.signal) + "</code></h3>" + with(svg, markup + "</g>") + "</div>\n";
}

std::string zoomScript() {
  return R"js(<script>
(() => {
  const views = [...document.querySelectorAll('svg.view')].map(view => {
    const [x, y, width, height] = view.getAttribute('viewBox').split(' ').map(Number);
    return {view, x, y, width, height, start: +view.dataset.start, end: +view.dataset.end,
            ticks: view.parentNode.querySelector('g.ticks')};
  });
  if (!views.length) return;
  const whole = [Math.min(...views.map(v => v.start)), Math.max(...views.map(v => v.end))];
  const niceStep = span => {
    const raw = span / 8, power = 10 ** Math.floor(Math.log10(raw));
    return [1, 2, 5, 10].map(f => f * power).find(step => step >= raw);
  };
  const show = ([from, to]) => views.forEach(v => {
    const perSecond = v.width / (v.end - v.start), a = Math.max(from, v.start), b = Math.min(to, v.end);
    if (b <= a) return;
    v.view.setAttribute('viewBox', `${v.x + (a - v.start) * perSecond} ${v.y} ${(b - a) * perSecond} ${v.height}`);
    v.shown = [a, b];
    const step = niceStep(b - a), digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    v.ticks.replaceChildren();
    for (let t = Math.ceil(a / step - 1e-9) * step; t <= b + 1e-9; t += step) {
      const text = document.createElementNS('http://www.w3.org/2000/svg', 'text');
      text.setAttribute('x', v.x + (t - a) / (b - a) * v.width);
      text.setAttribute('y', v.ticks.dataset.y);
      text.textContent = t.toFixed(digits);
      v.ticks.append(text);
    }
  });
  views.forEach(v => {
    const outer = v.view.parentNode, timeAt = event => {
      const box = outer.getBoundingClientRect(), x = (event.clientX - box.left) * outer.viewBox.baseVal.width / box.width;
      const [a, b] = v.shown || [v.start, v.end];
      return Math.min(b, Math.max(a, a + (x - v.x) / v.width * (b - a)));
    };
    let from = null;
    outer.style.cursor = 'col-resize';
    outer.addEventListener('pointerdown', event => { from = timeAt(event); event.preventDefault(); });
    window.addEventListener('pointerup', event => {
      if (from === null) return;
      const to = timeAt(event), range = [Math.min(from, to), Math.max(from, to)];
      from = null;
      if (range[1] - range[0] > 0.01 * (v.end - v.start)) show(range);
    });
    window.addEventListener('pointercancel', () => { from = null; });
    outer.addEventListener('dblclick', () => show(whole));
  });
  document.getElementById('whole').addEventListener('click', () => show(whole));
})();
</script>
)js";
}

}  // namespace musclesim
