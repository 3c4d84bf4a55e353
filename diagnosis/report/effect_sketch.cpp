#include "effect_sketch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "../words/effect_words.h"

namespace musclesim {

namespace {

struct SketchPoint {
  double x = 0, y = 0;  ///< 0..1, y upward
};
using SketchCurve = std::vector<SketchPoint>;
using Law = std::function<double(double)>;

struct Sketch {
  const char *across, *up;  ///< what the axes show
  std::function<SketchCurve()> expected, actual;
};

constexpr int sketch_points = 96;

SketchCurve graph(const Law& law) {
  SketchCurve curve;
  for (int i = 0; i <= sketch_points; ++i) {
    const double x = static_cast<double>(i) / sketch_points;
    curve.push_back({x, law(x)});
  }
  return curve;
}

std::function<SketchCurve()> graphOf(Law law) {
  return [law = std::move(law)] { return graph(law); };
}

/// y follows from x = middle + reach sin(phase) and its direction, over one and a half periods so that the beginning is forgotten.
std::function<SketchCurve()> loopOf(std::function<double(double x, double direction)> law) {
  return [law = std::move(law)] {
    SketchCurve curve;
    for (int i = 0; i <= 2 * sketch_points; ++i) {
      const double phase = 2 * std::numbers::pi * i / (2 * sketch_points);
      const double x = 0.5 - 0.42 * std::cos(phase);
      curve.push_back({x, law(x, std::sin(phase))});
    }
    return curve;
  };
}

/// A command that is raised at 0.12 and lowered at 0.56.
double pulse(double t) {
  return t > 0.12 && t < 0.56 ? 0.85 : 0.15;
}

/// tau dp/dt = pulse - p with different time constants.
double lagged(double t, double fill, double vent) {
  if (t <= 0.12) return 0.15;
  const double top = 0.85 - 0.7 * std::exp(-(std::min(t, 0.56) - 0.12) / fill);
  return t < 0.56 ? top : 0.15 + (top - 0.15) * std::exp(-(t - 0.56) / vent);
}

/// dp/dt limited.
double ramped(double t, double rate) {
  if (t <= 0.12) return 0.15;
  const double top = std::min(0.85, 0.15 + rate * (std::min(t, 0.56) - 0.12));
  return t < 0.56 ? top : std::max(0.15, top - rate * (t - 0.56));
}

double wave(double t) {
  return 0.5 + 0.36 * std::sin(2 * std::numbers::pi * 1.4 * t);
}

/// The play of a sensor: the reading follows when the wave pushes it from either side.
SketchCurve played(double width) {
  SketchCurve curve;
  double y = wave(0);
  for (int i = 0; i <= sketch_points; ++i) {
    const double t = static_cast<double>(i) / sketch_points;
    y = std::clamp(y, wave(t) - width, wave(t) + width);
    curve.push_back({t, y});
  }
  return curve;
}

using Sketches = std::map<std::string, Sketch>;

Sketches pressureSketches() {
  return {{"transport_delay", {"time", "pressure", graphOf(pulse), graphOf([](double t) { return pulse(t - 0.1); })}},
          {"valve_lag", {"time", "pressure", graphOf(pulse), graphOf([](double t) { return lagged(t, 0.08, 0.12); })}},
          {"flow_limit", {"time", "pressure", graphOf(pulse), graphOf([](double t) { return ramped(t, 2.4); })}},
          {"leak", {"time", "pressure", graphOf(pulse), graphOf([](double t) {
                      return t > 0.12 && t < 0.56 ? 0.7 + 0.15 * std::exp(-(t - 0.12) / 0.08) : 0.13;
                    })}},
          {"pressure_calibration", {"time", "pressure", graphOf(pulse), graphOf([](double t) { return 0.8 * pulse(t) + 0.1; })}},
          {"regulator_tail",
           {"time", "pressure", graphOf(pulse), graphOf([](double t) {
              return pulse(t) + (t < 0.12 ? 0 : t < 0.56 ? -0.2 * std::exp(-(t - 0.12) / 0.15) : 0.2 * std::exp(-(t - 0.56) / 0.15));
            })}},
          {"supply_droop", {"time", "supply", graphOf([](double) { return 0.85; }), graphOf([](double t) {
                              return t > 0.12 ? 0.85 - 0.5 * std::exp(-(t - 0.12) / 0.15) : 0.85;
                            })}},
          {"volume_coupling", {"time, stretched in the middle", "pressure", graphOf([](double) { return 0.4; }), graphOf([](double t) {
                                 return 0.4 + 0.4 * std::exp(-std::pow((t - 0.45) / 0.1, 2));
                               })}},
          {"command_dead_band",
           {"command", "pressure", graphOf([](double u) { return u; }), graphOf([](double u) { return u < 0.3 ? 0.02 : u; })}},
          {"command_quantisation", {"time", "command", graphOf(wave), graphOf([](double t) { return std::round(wave(t) * 6) / 6; })}},
          {"channel_swap", {"time", "command", graphOf(wave), graphOf([](double t) { return 1 - wave(t); })}}};
}

Sketches forceSketches() {
  const auto line = [](double x) { return 0.1 + 0.75 * x; };
  const auto straight = graphOf(line);
  return {
      {"braid_hysteresis", {"length", "tension", straight, loopOf([line](double x, double direction) {
                              return line(x) + (0.05 + 0.08 * x) * std::tanh(6 * direction);
                            })}},
      {"viscous_loss", {"length", "tension", straight, loopOf([line](double x, double direction) { return line(x) + 0.12 * direction; })}},
      {"creep", {"time, under constant load", "length", graphOf([](double t) { return t < 0.15 ? 0.2 : 0.6; }), graphOf([](double t) {
                   return t < 0.15 ? 0.2 : 0.85 - 0.25 * std::exp(-(t - 0.15) / 0.3);
                 })}},
      {"force_drift", {"time", "tension", graphOf([](double) { return 0.6; }), graphOf([](double t) { return 0.6 - 0.3 * t; })}},
      {"force_gain", {"length", "tension", straight, graphOf([line](double x) { return 0.75 * line(x); })}},
      {"length_offset", {"length", "tension", straight, graphOf([line](double x) { return std::max(0.02, line(x - 0.2)); })}},
      {"force_law", {"length", "tension", straight, graphOf([](double x) { return 0.1 + 0.75 * x * x; })}},
      {"series_elasticity", {"length", "tension", straight, graphOf([](double x) { return 0.1 + 0.48 * x; })}},
      {"threshold_pressure", {"pressure", "tension", graphOf([](double p) { return 0.85 * p; }), graphOf([](double p) {
                                return 0.85 * std::max(0.02, p - 0.25);
                              })}}};
}

Sketches bodySketches() {
  const auto spring = [](double q) { return 0.75 - 0.5 * q; };
  const auto gravity = [](double q) { return 0.5 - 0.35 * std::sin(2.6 * (q - 0.5)); };
  return {
      {"joint_coulomb_friction", {"angle", "torque", graphOf(spring), loopOf([spring](double q, double direction) {
                                    return spring(q) + 0.13 * std::tanh(8 * direction);
                                  })}},
      {"slide_friction", {"position", "force", graphOf(spring), loopOf([spring](double x, double direction) {
                            return spring(x) + 0.13 * std::tanh(8 * direction);
                          })}},
      {"joint_viscous_friction",
       {"angle", "torque", graphOf(spring), loopOf([spring](double q, double direction) { return spring(q) + 0.15 * direction; })}},
      {"joint_stiffness", {"angle", "torque", graphOf(spring), graphOf([](double q) { return 0.95 - 0.9 * q; })}},
      {"joint_stop_offset",
       {"angle", "torque of the stops", graphOf([](double q) { return 0.5 + 3 * (std::max(0.0, 0.2 - q) - std::max(0.0, q - 0.8)); }),
        graphOf([](double q) { return 0.5 + 3 * (std::max(0.0, 0.3 - q) - std::max(0.0, q - 0.9)); })}},
      {"contact",
       {"position", "force", graphOf([](double) { return 0.15; }), graphOf([](double x) { return 0.15 + 2.2 * std::max(0.0, x - 0.65); })}},
      {"external_force", {"position", "force", graphOf([](double) { return 0.2; }), graphOf([](double) { return 0.6; })}},
      {"payload",
       {"angle", "torque of gravity", graphOf(gravity), graphOf([](double q) { return 0.5 - 0.46 * std::sin(2.6 * (q - 0.5)); })}},
      {"base_tilt", {"angle", "torque of gravity", graphOf(gravity), graphOf([gravity](double q) { return gravity(q - 0.15); })}},
      {"attachment_offset", {"angle", "lever", graphOf([](double q) { return 0.3 + 0.9 * q * (1 - q); }), graphOf([](double q) {
                               return 0.42 + 0.9 * q * (1.15 - q);
                             })}}};
}

Sketches sensorSketches() {
  return {{"sensor_backlash", {"time", "reading", graphOf(wave), [] { return played(0.13); }}},
          {"sensor_bias", {"time", "reading", graphOf(wave), graphOf([](double t) { return wave(t) - 0.14; })}},
          {"sensor_delay", {"time", "reading", graphOf(wave), graphOf([](double t) { return wave(t - 0.09); })}},
          {"sensor_dropout", {"time", "reading", graphOf(wave), graphOf([](double t) { return wave(std::floor(t * 9) / 9); })}},
          {"sensor_gain", {"time", "reading", graphOf(wave), graphOf([](double t) { return 0.5 + 0.62 * (wave(t) - 0.5); })}},
          {"slow_clock", {"time", "reading", graphOf(wave), graphOf([](double t) { return wave(0.82 * t); })}}};
}

const Sketch* sketchOf(const std::string& id) {
  static const Sketches all = [] {
    Sketches sketches;
    for (Sketches part : {pressureSketches(), forceSketches(), bodySketches(), sensorSketches()}) sketches.merge(part);
    return sketches;
  }();
  const auto found = all.find(id);
  return found == all.end() ? nullptr : &found->second;
}

std::string sketchPath(const SketchCurve& curve, double left, double top, double width, double height) {
  std::string data;
  for (const SketchPoint& point : curve)
    data += fmt::format("{}{:.1f} {:.1f}", data.empty() ? "M" : "L", left + width * point.x,
                        top + height * (1 - std::clamp(point.y, 0.0, 1.0)));
  return data;
}

}  // namespace

std::string effectSketch(const std::string& id) {
  const Sketch* sketch = sketchOf(id);
  if (!sketch) return "";
  constexpr double left = 22, top = 6, width = 172, height = 92;
  return fmt::format(
      "<figure class=sketch><svg viewBox=\"0 0 200 116\" role=img aria-label=\"{}\"><path d=\"M{} {}v{}h{}\" class=axes />"
      "<path d=\"{}\" class=expected /><path d=\"{}\" class=actual />"
      "<text x=\"{}\" y=\"112\" text-anchor=end>{}</text>"
      "<text x=\"14\" y=\"{}\" text-anchor=end transform=\"rotate(-90 14 {})\">{}</text></svg>"
      "<figcaption>dashed: without the effect</figcaption></figure>\n",
      "Sketch: " + effectTitle(id), left, top, height, width, sketchPath(sketch->expected(), left, top, width, height),
      sketchPath(sketch->actual(), left, top, width, height), left + width, sketch->across, top, top, sketch->up);
}

}  // namespace musclesim
