#include "musclesim/controller/test_signal.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "musclesim/base/error.h"
#include "musclesim/base/random.h"
#include "waves.h"

namespace musclesim {

namespace {

using Shape = std::function<double(double)>;
constexpr double shortest_s = 1e-3, longest_s = 1e5, lowest_Hz = 1e-5, highest_Hz = 1e3;
constexpr double tolerance_s = 1e-6;  ///< jumps come this much early, so that a rounded time delays none by a control step

/// What a shape is made from.
struct ShapeRequest {
  const ControllerRequest& request;
  std::string name;
  int channel;

  /// Throws BadParameter for a time shorter than so many control steps.
  double seconds(const std::string& parameter, double default_s, const std::string& meaning, int fewest_steps = 2) const {
    const double value_s = request.parameters.number(name + "." + parameter, default_s, "s", shortest_s, longest_s, meaning);
    if (const double least_s = fewest_steps * request.step_s; value_s < least_s - tolerance_s)
      throw BadParameter(name + "." + parameter, fmt::format("{:g} s", value_s),
                         fmt::format("be at least {:g} s: a command lasts {:g} s (--step)", least_s, request.step_s));
    return value_s;
  }
  /// Throws BadParameter above half of the rate of commands (Nyquist 1928): it would come out as another frequency.
  double hertz(const std::string& parameter, double default_Hz, const std::string& meaning) const {
    const double value_Hz = request.parameters.number(name + "." + parameter, default_Hz, "Hz", lowest_Hz, highest_Hz, meaning);
    if (const double largest_Hz = 0.5 / request.step_s; value_Hz > largest_Hz)
      throw BadParameter(name + "." + parameter, fmt::format("{:g} Hz", value_Hz),
                         fmt::format("be at most {:g} Hz, half of the commands per second (--step)", largest_Hz));
    return value_Hz;
  }
  RandomStream random() const { return {request.seed, fmt::format("{}.channel_{}", name, channel)}; }
};

Shape steps(const ShapeRequest& r) {
  const double period_s = r.seconds("period_s", 4, "time of one cycle: half of it up, half of it down");
  return [=](double t) { return squareWave((t + tolerance_s) / period_s); };
}

Shape ramp(const ShapeRequest& r) {
  const double rise_s = r.seconds("rise_s", 5, "time from the level to the level and the amplitude, where it stays", 0);
  return [=](double t) { return std::min(1.0, t / rise_s); };
}

Shape triangle(const ShapeRequest& r) {
  const double period_s = r.seconds("period_s", 4, "time of one cycle");
  return [=](double t) { return triangleWave(t / period_s + 0.25); };
}

Shape sine(const ShapeRequest& r) {
  const double period_s = r.seconds("period_s", 2, "time of one cycle");
  return [=](double t) { return std::sin(2 * std::numbers::pi * (t / period_s)); };
}

Shape chirp(const ShapeRequest& r) {
  const double from_Hz = r.hertz("from_Hz", 0.1, "frequency at the beginning");
  const double to_Hz = r.hertz("to_Hz", 3, "frequency at the end of the sweep, which then stays");
  const double sweep_s = r.seconds("sweep_s", 20, "time of the sweep");
  const bool logarithmic =
      r.request.parameters.choice("chirp.sweep", "logarithmic", {"logarithmic", "linear"}, "how the frequency moves") == "logarithmic";
  return [wave = Chirp{from_Hz, to_Hz, sweep_s, logarithmic}](double t) { return wave.at(t); };
}

Shape prbs(const ShapeRequest& r) {
  const double hold_s = r.seconds("hold_s", 0.2, "time of one bit", 1);
  const int order = r.request.parameters.integer("prbs.order", 7, BinarySequence::smallest_order, BinarySequence::largest_order,
                                                 "bits of the shift register; the sequence repeats after 2^order - 1 bits");
  const auto offset = static_cast<std::uint64_t>(r.random().uniform() * (1 << BinarySequence::largest_order));
  return [=, sequence = BinarySequence(order, offset)](double t) {
    return sequence.at(static_cast<long>(std::floor((t + tolerance_s) / hold_s)));
  };
}

Shape multisine(const ShapeRequest& r) {
  const double low_Hz = r.hertz("low_Hz", 0.1, "lower end of the band");
  const double high_Hz = r.hertz("high_Hz", 2, "upper end of the band");
  const double period_s = r.seconds("period_s", 10, "time after which it repeats; its frequencies are multiples of 1/period");
  const bool random = r.request.parameters.choice("multisine.phases", "schroeder", {"schroeder", "random"},
                                                  "schroeder: low peaks, the same for all channels; random: by the seed") == "random";
  std::vector<int> harmonics = Multisine::harmonics(low_Hz, high_Hz, period_s);
  std::vector<double> phases = Multisine::schroederPhases(harmonics.size());
  RandomStream stream = r.random();
  if (random)
    for (double& phase : phases) phase = stream.uniform(0, 2 * std::numbers::pi);
  return [wave = Multisine(std::move(harmonics), std::move(phases), period_s)](double t) { return wave.at(t); };
}

Shape staircase(const ShapeRequest& r) {
  const double hold_s = r.seconds("hold_s", 1, "time of one level", 1);
  const int count = r.request.parameters.integer("staircase.step_count", 8, 1, 1000, "steps from the lowest to the highest level");
  return [=](double t) { return stairsWave(t + tolerance_s, hold_s, count); };
}

Shape reversals(const ShapeRequest& r) {
  const double period_s = r.seconds("period_s", 6, "time of the largest loop; smaller ones take less, at the same rate");
  const int count = r.request.parameters.integer("reversals.loop_count", 4, 1, 100, "loops of different size");
  return [=](double t) { return reversalsWave(t, period_s, count); };
}

const std::map<std::string, Shape (*)(const ShapeRequest&)>& shapeMakers() {
  static const std::map<std::string, Shape (*)(const ShapeRequest&)> makers = {
      {"steps", steps}, {"ramp", ramp},           {"triangle", triangle},   {"sine", sine},          {"chirp", chirp},
      {"prbs", prbs},   {"multisine", multisine}, {"staircase", staircase}, {"reversals", reversals}};
  return makers;
}

std::vector<Channel> chosenChannels(const ControllerRequest& request) {
  if (!request.channels.empty()) return channelsFrom(request.channels, request.muscle_count);
  std::vector<Channel> channels = request.robot ? antagonistsOf(*request.robot) : std::vector<Channel>();
  if (!channels.empty()) return channels;
  for (int muscle = 0; muscle < request.muscle_count; ++muscle) channels.push_back({"", {muscle}, {}});
  return channels;
}

}  // namespace

const std::vector<TestSignalInfo>& testSignals() {
  static const std::vector<TestSignalInfo> all = {
      {"steps", "test signal: up and down in steps"},
      {"ramp", "test signal: once up at a constant rate"},
      {"triangle", "test signal: up and down at a constant rate"},
      {"sine", "test signal: one frequency"},
      {"chirp", "test signal: a sine that sweeps through a band"},
      {"prbs", "test signal: pseudo-random binary sequence"},
      {"multisine", "test signal: many sines of a band at once"},
      {"staircase", "test signal: levels upwards, then downwards"},
      {"reversals", "test signal: loops that become smaller, at a constant rate"},
  };
  return all;
}

TestSignalController::TestSignalController(const std::string& name, const ControllerRequest& request) {
  const auto maker = shapeMakers().find(name);
  if (maker == shapeMakers().end()) throw BadParameter("test signal", name, "be one that testSignals() lists");
  auto& parameters = request.parameters;
  const double level = parameters.number(name + ".level", 0.4, "", 0, 1, "command of all muscles about which the signal moves");
  const double amplitude = parameters.number(name + ".amplitude", 0.1, "", -1, 1, "largest change of a command");
  channels_ = chosenChannels(request);
  const bool together = parameters.choice(name + ".drive", "difference", {"difference", "co_contraction"},
                                          "difference: antagonists move against each other; co_contraction: together") == "co_contraction";
  start_s_ = parameters.number(name + ".start_s", 0.5, "s", 0, longest_s, "the level is held until then");
  shift_s_ = parameters.number(name + ".shift_s", 0, "s", 0, longest_s, "each channel begins this much later than the one before");
  for (int i = 0; i < request.muscle_count; ++i)
    level_.push_back(parameters.number(fmt::format("{}.level_{}", name, i), level, "", 0, 1, fmt::format("level of muscle {}", i)));
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    amplitude_.push_back(
        parameters.number(fmt::format("{}.amplitude_{}", name, k), amplitude, "", -1, 1, fmt::format("amplitude of channel {}", k)));
    shapes_.push_back(maker->second({request, name, static_cast<int>(k)}));
    sense_.emplace_back(level_.size(), 0.0);
    for (const int muscle : channels_[k].rise) sense_.back()[static_cast<std::size_t>(muscle)] = 1;
    for (const int muscle : channels_[k].fall) sense_.back()[static_cast<std::size_t>(muscle)] = together ? 1 : -1;
  }
  requireRange(name);
}

void TestSignalController::requireRange(const std::string& name) const {
  constexpr double rounding = 1e-12;  ///< 0.3 - 0.3 counts as 0
  for (std::size_t i = 0; i < level_.size(); ++i) {
    double reach = 0;
    for (std::size_t k = 0; k < channels_.size(); ++k) reach += std::abs(sense_[k][i] * amplitude_[k]);
    if (level_[i] - reach >= -rounding && level_[i] + reach <= 1 + rounding) continue;
    throw BadParameter(fmt::format("{}.amplitude", name), fmt::format("{}", reach),
                       fmt::format("be at most {:g}, so that the command of muscle {} stays within 0 .. 1 about its level {:g}",
                                   std::min(level_[i], 1 - level_[i]), i, level_[i]));
  }
}

Action TestSignalController::output(const State& state) {
  Action action = level_;
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    const double time_s = state.time_s - start_s_ - static_cast<double>(k) * shift_s_;
    if (time_s < -tolerance_s) continue;
    const double move = amplitude_[k] * shapes_[k](std::max(0.0, time_s));
    for (std::size_t i = 0; i < action.size(); ++i) action[i] += sense_[k][i] * move;
  }
  for (double& pressure : action) pressure = std::clamp(pressure, 0.0, 1.0);
  return action;
}

std::vector<std::string> TestSignalController::notes() const {
  std::vector<std::string> names;
  for (const Channel& channel : channels_) names.push_back(channel.text());
  return {fmt::format("channels {}", fmt::join(names, ","))};
}

}  // namespace musclesim
