#include "report_figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>

#include "../../log/axis.h"
#include "../../log/curve.h"
#include "../../log/svg.h"
#include "../words/sentences.h"

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
  const auto share = [&](double value) { return full > 0 ? std::clamp(value / full, 0.0, 1.0) : 0.0; };
  for (const Bar& bar : bars)
    rows += fmt::format(
        "<div class=bar><span>{}</span><span class=length><span class=\"fill {}\" style=\"margin-left:calc((100% - 6.5rem)*{:.4f});"
        "width:calc((100% - 6.5rem)*{:.4f})\"></span><span>{}</span></span></div>\n",
        escapedXml(bar.label), bar.look, share(bar.start), share(bar.value), escapedXml(bar.number));
  return fmt::format("<div class=bars role=group aria-label=\"{}\">\n{}</div>\n", escapedXml(title), rows);
}

std::string stagesFigure(const Diagnosis& d) {
  constexpr std::array<const char*, 5> stages = {"command", "pressure", "force", "body", "sensor"};
  constexpr double box = 94, gap = 20, height = 58, top = 6;
  const double width = static_cast<double>(stages.size()) * (box + gap) - gap + 4;
  Svg svg(width, height + 34, "The way of a sample and the shares of the gap");
  std::string markup;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double x = 2 + static_cast<double>(i) * (box + gap);
    const auto place = std::ranges::find(d.where, std::string(stages[i]), &Place::stage);
    const double share = place == d.where.end() ? 0 : place->share;
    const bool marked = mayBeAt(d.where, stages[i]), is_found = isFoundAt(d, stages[i]);
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
    words(top + 24, stages[i], 17, ink);
    words(top + 46, fmt::format("{:.0f} %", 100 * share), 18, ink);
    if (is_found)
      words(top + height + 20, "cause found", 15, guilty_color);
    else if (share >= 0.05)
      words(top + height + 20, place->component == "all" ? "all" : componentWords(withoutPrefix(place->component)), 15, "#222222");
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
  const bool all = place.component == "all", all_joints = all && place.stage == "body";
  const bool all_muscles = all && !all_joints && place.stage != "sensor";
  std::vector<std::string> drawn;
  for (const RobotDrawing::Line& line : drawing.lines)
    if (!line.component.empty() && (all_muscles || std::ranges::find(names, line.component) != names.end()))
      drawn.push_back(line.component);
  for (const RobotDrawing::Point& point : drawing.points)
    if ((all_joints && point.component.starts_with("joint_")) || std::ranges::find(names, point.component) != names.end())
      drawn.push_back(point.component);
  return drawn;
}

/// The name of a marked component, on the right of it or, where there is no room, on the left.
std::string guiltyLabel(SvgPoint at, double offset, const std::string& component, double width) {
  constexpr double letter_width = 9;
  const std::string words = componentWords(component);
  const bool is_left = at.x + offset + letter_width * static_cast<double>(words.size()) > width;
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"14\" font-weight=\"bold\" text-anchor=\"{}\" fill=\"{}\">{}</text>",
                     at.x + (is_left ? -offset : offset), at.y, is_left ? "end" : "start", guilty_color, escapedXml(words));
}

}  // namespace

std::string robotFigure(const RobotDrawing& drawing, const std::vector<Place>& places) {
  if (drawing.lines.empty()) return "";
  Eigen::AlignedBox2d box;
  for (const RobotDrawing::Line& line : drawing.lines)
    for (const Eigen::Vector2d& point : line.points_mm) box.extend(point);
  constexpr double most_height = 300, margin = 34, most_width = 320;
  const Eigen::Vector2d extent = box.sizes().cwiseMax(1.0);
  const double scale = std::min((most_height - 2 * margin) / extent.y(), (most_width - 2 * margin) / extent.x());
  const double width = std::max(220.0, extent.x() * scale + 2 * margin), height = std::max(110.0, extent.y() * scale + 2 * margin);
  auto pixel = [&](const Eigen::Vector2d& p) {
    return SvgPoint{width / 2 + (p.x() - box.center().x()) * scale, height / 2 - (p.y() - box.center().y()) * scale};
  };
  std::vector<std::string> marked;
  for (const Place& place : places)
    for (std::string& component : drawnComponents(drawing, place))
      if (std::ranges::find(marked, component) == marked.end()) marked.push_back(std::move(component));
  const auto isMarked = [&](const std::string& component) { return std::ranges::find(marked, component) != marked.end(); };
  const Svg svg(width, height, "The robot from the front" + (marked.empty() ? "" : fmt::format("; marked: {}", fmt::join(marked, ", "))));
  const bool are_all =
      std::ranges::all_of(drawing.lines, [&](const auto& line) { return line.component.empty() || isMarked(line.component); });
  std::string markup, labels;
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
        std::max(2.0, line.width_mm * scale) + (guilty ? 2 : 0), escapedXml(line.title));
    if (guilty && !are_all) {
      const SvgPoint before = points[(points.size() - 1) / 2], behind = points[points.size() / 2];
      labels += guiltyLabel({0.5 * (before.x + behind.x), 0.5 * (before.y + behind.y) - 12}, 14, line.component, width);
    }
  }
  for (const RobotDrawing::Point& point : drawing.points) {
    if (!isMarked(point.component)) continue;
    const SvgPoint at = pixel(point.point_mm);
    markup += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"11\" fill=\"none\" stroke=\"{}\" stroke-width=\"4\"/>", at.x, at.y,
                          guilty_color);
    labels += guiltyLabel({at.x, at.y + 5}, 18, point.component, width);
  }
  return with(svg, markup + labels);
}

namespace {

/// How the curve of one kind is drawn; the style sheet gives the classes colour, width and dashes.
struct CurveKind {
  const char *look, *words;
};
constexpr std::array<CurveKind, 3> curve_kinds = {CurveKind{"measured", "measured"}, CurveKind{"before", "simulated before"},
                                                  CurveKind{"after", "simulated after"}};

std::string curveWords(std::size_t kind, bool has_after) {
  return kind == 1 && !has_after ? "simulated" : curve_kinds[kind].words;
}

/// Path data in tenths of a pixel from the corner of the box, each point relative to the one before.
std::string tenths(const std::vector<std::vector<SvgPoint>>& pieces, const SvgBox& box) {
  std::string data;
  const auto number = [&](long value) {
    if (value >= 0 && !data.empty() && std::isdigit(static_cast<unsigned char>(data.back()))) data += ' ';
    data += std::to_string(value);
  };
  for (const auto& piece : pieces) {
    long last_x = 0, last_y = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const long x = std::lround(10 * (piece[i].x - box.left)), y = std::lround(10 * (piece[i].y - box.top));
      if (i < 2) data += i == 0 ? 'M' : 'l';
      number(x - last_x);
      number(y - last_y);
      last_x = x;
      last_y = y;
    }
    if (piece.size() == 1) data += "l0 0";
  }
  return data;
}

/// One of the two plots of a signal: grid, frame, and curves in a viewport of their own, which the script narrows.
struct Panel {
  SvgBox box;
  Axis times, values;
  std::string curves;

  void add(const std::string& look, const std::vector<double>& time_s, const std::vector<double>& y, int pixels_per_column) {
    if (y.empty()) return;
    const SvgBox coarse{box.left / pixels_per_column, box.top, box.width / pixels_per_column, box.height};
    const Axis columns(extentOf(times), coarse.left, coarse.right(), 8, false);
    auto pieces = curvePieces(time_s, y, columns, values, Between::straight);
    for (auto& piece : pieces)
      for (SvgPoint& point : piece) point.x *= pixels_per_column;
    curves += fmt::format("<path class=\"curve {}\" d=\"{}\"/>", look, tenths(pieces, box));
  }

  /// The noise band around 0.
  void addBand(double half) {
    const double top = std::max(box.top, values.pixel(half)), bottom = std::min(box.bottom(), values.pixel(-half));
    curves += fmt::format("<path class=band d=\"M0 {0:.0f}h{1:.0f}v{2:.0f}h-{1:.0f}z\"/>", 10 * (top - box.top), 10 * box.width,
                          10 * std::max(0.2, bottom - top));
  }

  std::string markup(const std::string& label) const {
    std::string text;
    for (const double tick : values.ticks()) {
      const double y = values.pixel(tick);
      text += fmt::format("<path class=grid d=\"M{:.0f} {:.1f}h{:.0f}\"/><text x=\"{:.0f}\" y=\"{:.1f}\" text-anchor=end>{}</text>",
                          box.left, y, box.width, box.left - 6, y + 4, values.label(tick));
    }
    text += fmt::format("<text class=unit x=\"11\" y=\"{0:.0f}\" text-anchor=middle transform=\"rotate(-90 11 {0:.0f})\">{1}</text>",
                        box.top + box.height / 2, escapedXml(label));
    return text +
           fmt::format(
               "<svg class=\"view\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" preserveAspectRatio=none "
               "data-start=\"{}\" "
               "data-end=\"{}\" data-low=\"{}\" data-high=\"{}\">{}</svg><rect class=frame x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
               box.left, box.top, box.width, box.height, 10 * box.width, 10 * box.height, times.minimum(), times.maximum(),
               values.minimum(), values.maximum(), curves, box.left, box.top, box.width, box.height);
  }

 private:
  static Extent extentOf(const Axis& axis) {
    Extent extent;
    extent.add(axis.minimum());
    extent.add(axis.maximum());
    return extent;
  }
};

struct LookedCurve {
  const char* look;
  const std::vector<double>& y;
};

std::vector<double> difference(const std::vector<double>& measured, const std::vector<double>& simulated) {
  std::vector<double> result;
  for (std::size_t i = 0; i < simulated.size(); ++i) result.push_back(measured[i] - simulated[i]);
  return result;
}

double largest(const std::vector<double>& residual) {
  Extent extent;
  extent.add(residual);
  return std::max(extent.maximum(), -extent.minimum());
}

std::string legend(bool has_after, bool with_band, bool with_readings) {
  std::string keys;
  for (std::size_t kind = 0; kind < (has_after ? 3U : 2U); ++kind)
    keys += fmt::format(
        "<span class=key><svg viewBox=\"0 0 30 10\" aria-hidden=true><path class=\"curve {0}\" d=\"M0 5h30\"/></svg>{1}{2}</span>",
        curve_kinds[kind].look, curveWords(kind, has_after),
        with_readings ? fmt::format(" <output data-curve={}></output>", curve_kinds[kind].look) : "");
  if (with_band)
    keys += "<span class=key><svg viewBox=\"0 0 30 10\" aria-hidden=true><path class=band d=\"M0 0h30v10h-30z\"/></svg>noise band</span>";
  return "<div class=legend>" + keys + (with_readings ? "<span class=key><output class=time></output></span>" : "") + "</div>";
}

std::string timeTicks(const Axis& times, double y) {
  std::string text = fmt::format("<g class=ticks text-anchor=middle data-y=\"{}\">", y);
  for (const double tick : times.ticks())
    text += fmt::format("<text x=\"{:.1f}\" y=\"{}\">{}</text>", times.pixel(tick), y, times.label(tick));
  return text + "</g>";
}

}  // namespace

std::string traceFigure(const Trace& trace, const TraceWords& words, double noise_sigma, int pixels_per_column) {
  constexpr double width = 720, left = 94, right = 706, gap = 24, band_sigmas = 2;
  constexpr double magnified = 0.7;  // a residual that is hardly smaller needs no scale of its own
  const bool has_after = !trace.after.empty();
  const std::vector<double> before = difference(trace.measured, trace.before), after = difference(trace.measured, trace.after);
  Extent times;
  times.add(trace.time_s);
  const Axis time_axis(times, left, right, 8, false);
  std::string markup;
  double top = 14;
  const double band = band_sigmas * noise_sigma;
  const auto panel = [&](const std::string& label, double height, bool is_residual, const std::vector<LookedCurve>& curves) {
    Extent values;
    for (const LookedCurve& curve : curves) values.add(curve.y);
    if (is_residual) {
      const double most = std::max({band, values.maximum(), -values.minimum()});
      for (const double bound : {-most, most}) values.add(bound);
    }
    const SvgBox box{left, top, right - left, height};
    Panel drawn{box, time_axis, {values, box.bottom(), box.top, height > 120 ? 5 : 3, true}, ""};
    if (is_residual && band > 0) drawn.addBand(band);
    for (const LookedCurve& curve : curves) drawn.add(curve.look, trace.time_s, curve.y, pixels_per_column);
    markup += drawn.markup(label);
    top = box.bottom() + gap;
  };
  panel(words.unit, 160, false, {{"measured", trace.measured}, {"before", trace.before}, {"after", trace.after}});
  panel("residual", 84, true, {{"before", before}, {"after", after}});
  if (has_after && largest(after) < magnified * largest(before)) panel("after only", 84, true, {{"after", after}});
  const double bottom = top - gap;
  return fmt::format(
      "<figure class=trace data-signal=\"{0}\"><figcaption><b>{1}</b> <code>{0}</code> <span class=small>{2}</span></figcaption>{3}"
      "<svg class=plot viewBox=\"0 0 {4} {5}\" tabindex=0 role=img aria-label=\"{6}\">{7}{8}"
      "<text x=\"{9}\" y=\"{10}\" text-anchor=middle>time, s</text></svg></figure>\n",
      escapedXml(trace.signal), escapedXml(words.title), escapedXml(words.remark), legend(has_after, true, true), width, bottom + 44,
      escapedXml(words.title + " over time; below: the residual, measured minus simulated. " + words.remark), markup,
      timeTicks(time_axis, bottom + 18), (left + right) / 2, bottom + 40);
}

std::string loopFigure(const Loop& loop) {
  constexpr double width = 360, height = 290;
  constexpr std::size_t most_points = 500;
  const SvgBox box{66, 12, width - 82, height - 60};
  Extent across, up;
  for (const LoopCurve& curve : loop.curves) {
    across.add(curve.x);
    up.add(curve.y);
  }
  const Axis x_axis(across, box.left, box.right(), 5, true), y_axis(up, box.bottom(), box.top, 5, true);
  std::string markup;
  for (const double tick : y_axis.ticks())
    markup += fmt::format("<path class=grid d=\"M{} {:.1f}h{}\"/><text x=\"{}\" y=\"{:.1f}\" text-anchor=end>{}</text>", box.left,
                          y_axis.pixel(tick), box.width, box.left - 6, y_axis.pixel(tick) + 4, y_axis.label(tick));
  for (const double tick : x_axis.ticks())
    markup +=
        fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=middle>{}</text>", x_axis.pixel(tick), box.bottom() + 18, x_axis.label(tick));
  for (std::size_t kind = 0; kind < loop.curves.size(); ++kind) {
    const LoopCurve& curve = loop.curves[kind];
    std::vector<SvgPoint> points;
    for (std::size_t i = 0; i < curve.x.size(); i += 1 + curve.x.size() / most_points)
      points.push_back({x_axis.pixel(curve.x[i]), y_axis.pixel(curve.y[i])});
    markup += fmt::format("<path class=\"curve {}\" d=\"{}\"/>", curve_kinds[kind].look, pathData({points}));
  }
  markup += fmt::format("<rect class=frame x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>", box.left, box.top, box.width, box.height);
  markup +=
      fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=middle>{}</text>", box.left + box.width / 2, height - 8, escapedXml(loop.across));
  markup += fmt::format("<text x=\"11\" y=\"{0}\" text-anchor=middle transform=\"rotate(-90 11 {0})\">{1}</text>", box.top + box.height / 2,
                        escapedXml(loop.up));
  return fmt::format(
      "<figure class=loop><figcaption><b>{}</b></figcaption>{}<svg class=still viewBox=\"0 0 {} {}\" role=img "
      "aria-label=\"{}\">{}</svg></figure>\n",
      escapedXml(loop.title), legend(loop.curves.size() > 2, false, false), width, height, escapedXml(loop.title), markup);
}

std::string signFigure(Belief belief) {
  // A disc with a tick, a triangle with "!", a diamond with "?", a square with "=": told apart without colour.
  const char* shape = "";
  switch (belief) {
    case Belief::explained:
      shape = "<circle cx=32 cy=32 r=29 /><path class=mark d=\"M17 33l11 11l19-23\" />";
      break;
    case Belief::partly:
      shape = "<path d=\"M32 4L61 58H3z\" /><path class=mark d=\"M32 23v17m0 8v2\" />";
      break;
    case Belief::cannot_tell:
      shape = "<path d=\"M32 2L62 32L32 62L2 32z\" /><path class=mark d=\"M24 25c0-12 17-11 16-1c-1 6-8 6-8 12m0 8v2\" />";
      break;
    case Belief::no_gap:
      shape = "<rect x=5 y=5 width=54 height=54 rx=8 /><path class=mark d=\"M19 26h26m-26 13h26\" />";
  }
  return fmt::format("<svg class=sign viewBox=\"0 0 64 64\" aria-hidden=true>{}</svg>", shape);
}

}  // namespace musclesim
