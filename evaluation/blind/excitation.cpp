#include "excitation.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "chance.h"
#include "musclesim/base/error.h"

namespace musclesim::blind {

namespace {

constexpr double interval_s = 0.01, rest_s = 0.3;

/// A polygon over time.
class Polygon {
 public:
  void add(double time_s, double value) { points_.push_back({time_s, value}); }
  double at(double time_s) const {
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const auto &a = points_[i - 1], &b = points_[i];
      if (time_s < b.time_s) return a.value + (b.value - a.value) * std::max(0.0, time_s - a.time_s) / (b.time_s - a.time_s);
    }
    return points_.back().value;
  }
  std::vector<double> sampled(double duration_s) const {
    std::vector<double> values;
    for (long row = 0; row < std::lround(duration_s / interval_s); ++row) values.push_back(at(static_cast<double>(row) * interval_s));
    return values;
  }

 private:
  struct Point {
    double time_s, value;
  };
  std::vector<Point> points_ = {{0, 0}, {rest_s, 0}};
};

Polygon triangle(double speed, double duration_s, RandomStream& random) {
  Polygon polygon;
  const double quarter_s = random.uniform(0.35, 0.6) * duration_s / speed / 4;
  double sign = happens(random, 0.5) ? 1 : -1;
  for (double t = rest_s + quarter_s; t < duration_s + 2 * quarter_s; t += 2 * quarter_s, sign = -sign) polygon.add(t, sign);
  return polygon;
}

/// Moves of `move_s` to levels of alternating sign and different size, each held for a time drawn from [shortest_s, longest_s].
Polygon levels(double move_s, double shortest_s, double longest_s, double duration_s, RandomStream& random) {
  Polygon polygon;
  double sign = happens(random, 0.5) ? 1 : -1, value = 0;
  for (double t = rest_s; t < duration_s; sign = -sign) {
    polygon.add(t, value);
    value = sign * random.uniform(0.2, 1);
    polygon.add(t + move_s, value);
    t += std::max(move_s * 2, random.uniform(shortest_s, longest_s));
  }
  return polygon;
}

/// Constant rate between turning points: first the full range, then loops inside it.
Polygon reversals(double speed, double duration_s, RandomStream& random) {
  Polygon polygon;
  const double rate_per_s = 8 * speed / duration_s;
  double value = 0, sign = happens(random, 0.5) ? 1 : -1, t = rest_s;
  for (int turn = 0; t < duration_s; ++turn, sign = -sign) {
    const double next = turn < 2 ? sign : std::clamp(value + sign * random.uniform(0.3, 1.4), -1.0, 1.0);
    if (std::abs(next - value) < 0.05) continue;
    t += std::abs(next - value) / rate_per_s;
    value = next;
    polygon.add(t, value);
  }
  return polygon;
}

std::vector<double> multisine(double speed, double duration_s, RandomStream& random) {
  constexpr int count = 4;
  constexpr double lowest_Hz = 0.25, highest_Hz = 2, rise_s = 0.5;
  double frequency_Hz[count], phase[count], largest = 0;
  for (int i = 0; i < count; ++i) {
    frequency_Hz[i] = speed * logUniform(random, lowest_Hz, highest_Hz);
    phase[i] = random.uniform(0, 2 * std::numbers::pi);
  }
  std::vector<double> values;
  for (long row = 0; row < std::lround(duration_s / interval_s); ++row) {
    const double t = static_cast<double>(row) * interval_s - rest_s;
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += std::sin(2 * std::numbers::pi * frequency_Hz[i] * t + phase[i]);
    values.push_back(t < 0 ? 0 : std::min(1.0, t / rise_s) * sum);
    largest = std::max(largest, std::abs(values.back()));
  }
  for (double& value : values) value /= largest;
  return values;
}

struct Range {
  double low, high;
};

/// Amplitudes by layout and kind, fractions of full scale.
Range amplitudeRange(Layout layout, const std::string& kind) {
  static const std::map<Layout, std::map<std::string, Range>> ranges = {{Layout::one_muscle,
                                                                         {{"triangle", {0.14, 0.19}},
                                                                          {"steps", {0.06, 0.12}},
                                                                          {"reversals", {0.13, 0.17}},
                                                                          {"multisine", {0.09, 0.14}},
                                                                          {"holds", {0.05, 0.14}}}},
                                                                        {Layout::pair,
                                                                         {{"triangle", {0.08, 0.12}},
                                                                          {"steps", {0.04, 0.07}},
                                                                          {"reversals", {0.05, 0.09}},
                                                                          {"multisine", {0.05, 0.08}},
                                                                          {"holds", {0.03, 0.07}}}},
                                                                        {Layout::many,
                                                                         {{"triangle", {0.01, 0.03}},
                                                                          {"steps", {0.01, 0.02}},
                                                                          {"reversals", {0.01, 0.03}},
                                                                          {"multisine", {0.01, 0.02}},
                                                                          {"holds", {0.01, 0.03}}}}};
  return ranges.at(layout).at(kind);
}

Excitation drawExcitation(Layout layout, const std::string& kind, RandomStream& random) {
  const Range range = amplitudeRange(layout, kind);
  return {kind, random.uniform(range.low, range.high), 1};
}

double drawMiddle(Layout layout, RandomStream& random) {
  static const std::map<Layout, Range> ranges = {
      {Layout::one_muscle, {0.32, 0.48}}, {Layout::pair, {0.3, 0.48}}, {Layout::many, {0.06, 0.18}}};
  return random.uniform(ranges.at(layout).low, ranges.at(layout).high);
}

}  // namespace

std::vector<double> shapeOf(const std::string& kind, double speed, double duration_s, RandomStream& random) {
  constexpr double jump_s = 1e-3, ramp_s = 0.25;
  if (kind == "triangle") return triangle(speed, duration_s, random).sampled(duration_s);
  if (kind == "steps") return levels(jump_s, 0.35 / speed, 0.8 / speed, duration_s, random).sampled(duration_s);
  if (kind == "holds") return levels(ramp_s / speed, 0.8 / speed, 1.4 / speed, duration_s, random).sampled(duration_s);
  if (kind == "reversals") return reversals(speed, duration_s, random).sampled(duration_s);
  if (kind == "multisine") return multisine(speed, duration_s, random);
  throw BadParameter("kind of excitation", kind, "be one of triangle, steps, reversals, multisine, holds");
}

Layout layoutOf(int muscle_count) {
  return muscle_count == 1 ? Layout::one_muscle : muscle_count == 2 ? Layout::pair : Layout::many;
}

std::vector<Excitation> drawExcitations(Layout layout, RandomStream& random) {
  std::vector<Excitation> drawn;
  const std::string third = oneOf(random, std::vector<std::string>{"reversals", "multisine", "holds"});
  for (const std::string& kind : {std::string("triangle"), std::string("steps"), third})
    drawn.push_back(drawExcitation(layout, kind, random));
  drawn.push_back(drawExcitation(layout, oneOf(random, std::vector<std::string>{"triangle", "reversals", "multisine", "holds"}), random));
  drawn.back().speed = happens(random, 0.5) ? 0.6 : 1.6;
  drawn.back().amplitude *= random.uniform(0.6, 1.1);
  return drawn;
}

Recording planned(const std::string& robot, int muscle_count, const Excitation& excitation, double duration_s, RandomStream& random) {
  constexpr double command_steps = 1e4;
  const Layout layout = layoutOf(muscle_count);
  const double middle = drawMiddle(layout, random);
  const std::vector<double> shape = shapeOf(excitation.kind, excitation.speed, duration_s, random);
  const bool slow = excitation.kind == "triangle" || excitation.kind == "reversals";
  const double both = layout == Layout::pair && slow && happens(random, 0.6) ? random.uniform(0.05, 0.09) : 0;
  const std::vector<double> together = shapeOf("triangle", 1.4 * excitation.speed, duration_s, random);
  Recording plan;
  plan.info.robot = robot;
  plan.info.trial = excitation.kind;
  for (std::size_t row = 0; row < shape.size(); ++row) plan.time_s.push_back(static_cast<double>(row) * interval_s);
  for (int muscle = 0; muscle < muscle_count; ++muscle) {
    Signal command{fmt::format("command_{}", muscle), {}};
    const std::vector<double> own = layout == Layout::many ? shapeOf(excitation.kind, excitation.speed, duration_s, random) : shape;
    const double sign = layout == Layout::pair && muscle == 1 ? -1 : 1;
    for (std::size_t row = 0; row < shape.size(); ++row)
      command.values.push_back(rounded(middle + sign * excitation.amplitude * own[row] + both * together[row], command_steps));
    plan.signals.push_back(std::move(command));
  }
  return plan;
}

}  // namespace musclesim::blind
