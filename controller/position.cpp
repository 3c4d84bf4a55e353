#include "musclesim/controller/position.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "inverse_model.h"
#include "musclesim/base/error.h"
#include "targets.h"

namespace musclesim {

namespace {

std::vector<Channel> antagonistsFor(const ControllerRequest& request) {
  if (!request.robot) throw BadParameter("controller position needs to know its robot");
  if (!request.channels.empty()) return channelsFrom(request.channels, request.muscle_count);
  std::vector<Channel> channels = antagonistsOf(*request.robot);
  if (channels.empty())
    throw BadParameter(
        "controller position found no antagonists by moment arms (the robot has none, or its joints close a loop): name them, for example "
        "--channels elbow=0:1 for muscle 0 against muscle 1");
  return channels;
}

constexpr double largest_gain = 10;  ///< an error of a tenth of a degree or mm commands full scale

/// A gain to two digits, as a default that people read.
double rounded(double value) {
  return std::min(largest_gain, std::strtod(fmt::format("{:.2g}", value).c_str(), nullptr));
}

std::vector<std::string> angleNames(const Robot& robot) {
  std::vector<std::string> names;
  for (const Robot::Angle& angle : robot.angles()) names.push_back(angle.name);
  return names;
}

/// Refuses a target that its joint cannot follow.
void requireWithinStops(const std::string& joint, double middle_deg, double amplitude_deg, const std::pair<double, double>& stops_deg) {
  const auto [low_deg, high_deg] = stops_deg;
  const double room_deg = std::min(middle_deg - low_deg, high_deg - middle_deg);
  constexpr double rounding_deg = 1e-6;  ///< stops are kept in rad
  if (room_deg < -rounding_deg)
    throw BadParameter(fmt::format("position.target_{}_deg", joint), fmt::format("{:g} deg", middle_deg),
                       fmt::format("lie in {:g} .. {:g} deg, between the stops of the joint", low_deg, high_deg));
  if (std::abs(amplitude_deg) > room_deg + rounding_deg)
    throw BadParameter(fmt::format("position.amplitude_{}_deg", joint), fmt::format("{:g} deg", amplitude_deg),
                       fmt::format("be at most {:g} deg about the middle of {:g} deg: the stops of the joint are at {:g} and {:g} deg",
                                   room_deg, middle_deg, low_deg, high_deg));
}

}  // namespace

PositionController::PositionController(const ControllerRequest& request) : step_s_(request.step_s) {
  auto& parameters = request.parameters;
  const std::vector<Channel> channels = antagonistsFor(request);
  is_height_ = parameters.choice("position.quantity", request.robot->angles().empty() ? "height" : "angles", {"angles", "height"},
                                 "what follows a target: joint angles, or the height of the hand") == "height";
  const double level = parameters.number("position.level", 0.4, "", 0, 1, "co-contraction: command of both antagonists without difference");
  for (int i = 0; i < request.muscle_count; ++i) {
    level_.push_back(parameters.number(fmt::format("position.level_{}", i), level, "", 0, 1, fmt::format("level of muscle {}", i)));
    largest_difference_ = std::max({largest_difference_, level_.back(), 1 - level_.back()});
  }
  addLoops(request, channels);
  setTargets(request);
  const bool wanted = parameters.choice("position.feed_forward", "inverse", {"inverse", "off"},
                                        "inverse: what moves the clean model along the target, for angles") == "inverse";
  if (!is_height_) invertModel(*request.robot);
  setGains(parameters);
  feeds_forward_ = inverse_ && wanted;
}

PositionController::~PositionController() = default;

void PositionController::addLoops(const ControllerRequest& request, const std::vector<Channel>& channels) {
  const std::vector<std::string> angles = angleNames(*request.robot);
  angle_count_ = angles.size();
  for (const Channel& channel : channels) {
    const std::string joint = is_height_ ? "" : channel.name.empty() && angles.size() == 1 ? angles.front() : channel.name;
    const auto place = std::ranges::find(angles, joint);
    if (!is_height_ && place == angles.end())
      throw BadParameter("channel", channel.text(),
                         fmt::format("name the joint that it moves, NAME={}, of {}", channel.text(), fmt::join(angles, ", ")));
    auto loop = std::ranges::find(loops_, joint, &Loop::joint);
    if (loop == loops_.end()) {
      loop = loops_.insert(loop, Loop{});
      loop->joint = joint;
      loop->angle = is_height_ ? 0 : static_cast<std::size_t>(place - angles.begin());
      loop->sense.assign(level_.size(), 0.0);
    }
    loop->channels.push_back(channel);
    for (const int muscle : channel.rise) loop->sense[static_cast<std::size_t>(muscle)] = 1;
    for (const int muscle : channel.fall) loop->sense[static_cast<std::size_t>(muscle)] = -1;
  }
}

void PositionController::setTargets(const ControllerRequest& request) {
  auto& parameters = request.parameters;
  if (!request.targets_file.empty()) {
    const auto table = std::make_shared<TargetTable>(request.targets_file);
    for (Loop& loop : loops_) {
      noteTargetsBeyondStops(loop, table->column(loop.joint), *request.robot);
      loop.target = [table, column = table->column(loop.joint)](double t) { return table->at(column, t); };
    }
    end_s_ = table->endS();
    return;
  }
  if (is_height_) {
    ControllerRequest height = request;
    height.task = "height";
    loops_.front().target = [y_mm = Target::make(height).point_mm.y()](double) { return y_mm; };
    return;
  }
  const double period_s = parameters.number("position.period_s", 2, "s", 1e-3, 1e5, "time of one cycle of the target's sine");
  for (Loop& loop : loops_) {
    const Robot::Angle& angle = request.robot->angles()[loop.angle];
    const auto [low_deg, high_deg] = angle.joint->stopsDeg(angle.axis);
    const double default_deg = std::isfinite(high_deg - low_deg) ? (low_deg + high_deg) / 2 : 0;
    const double middle_deg =
        parameters.number(fmt::format("position.target_{}_deg", loop.joint), default_deg, "deg", -1e4, 1e4, "target, its middle");
    const double amplitude_deg =
        parameters.number(fmt::format("position.amplitude_{}_deg", loop.joint), 0, "deg", -1e4, 1e4, "amplitude of the target's sine");
    requireWithinStops(loop.joint, middle_deg, amplitude_deg, {low_deg, high_deg});
    loop.target = [=](double t) { return middle_deg + amplitude_deg * std::sin(2 * std::numbers::pi * (std::max(0.0, t) / period_s)); };
  }
}

void PositionController::noteTargetsBeyondStops(const Loop& loop, const std::vector<double>& targets_deg, const Robot& robot) {
  if (is_height_) return;
  const Robot::Angle& angle = robot.angles()[loop.angle];
  const auto [low_deg, high_deg] = angle.joint->stopsDeg(angle.axis);
  const auto [least, most] = std::ranges::minmax(targets_deg);
  if (least >= low_deg && most <= high_deg) return;
  target_notes_.push_back(fmt::format(
      "warning: the targets of joint {} run from {:g} to {:g} degrees, but its stops allow {:g} .. {:g}: it cannot follow there",
      loop.joint, least, most, low_deg, high_deg));
}

void PositionController::setGains(Parameters& parameters) {
  for (Loop& loop : loops_) {
    const std::string of = is_height_ ? "" : loop.joint + "_", unit = is_height_ ? "mm" : "deg";
    const auto gain = [&](const std::string& name, double value, const std::string& gain_unit, const std::string& meaning) {
      return parameters.number("position." + name, value, gain_unit, 0, largest_gain, meaning);
    };
    const Gains usual = usualGains(loop);
    loop.gains = {
        gain("proportional_" + of + "per_" + unit, usual.proportional, "1/" + unit, "K_p, difference of pressure per error"),
        gain("integral_" + of + "per_" + unit + "_s", usual.integral_per_s, "1/(" + unit + " s)",
             "K_i, difference of pressure per error and second"),
        gain("damping_" + of + "s_per_" + unit, usual.damping_s, "s/" + unit, "K_d, difference of pressure per speed of the error")};
  }
}

PositionController::Gains PositionController::usualGains(const Loop& loop) const {
  // Tuned at the arm (height) and the elbow with chain muscles, with a control step of 0.01 s.
  constexpr Gains height = {4e-3, 5e-3, 4e-4}, without_model = {0.01, 0.02, 0.001};
  constexpr double bandwidth_per_s = 36, damping_ratio = 1.5, integral_per_proportional_s = 1.7;
  if (is_height_) return height;
  const double b = inverse_ ? inverse_->accelerationPerDifference(loop.angle, anglesAt(0), antagonism(loop)) : 0;
  if (!(b > 0)) return without_model;
  const double proportional = bandwidth_per_s * bandwidth_per_s / b;
  return {rounded(proportional), rounded(integral_per_proportional_s * proportional), rounded(2 * damping_ratio * bandwidth_per_s / b)};
}

void PositionController::invertModel(const Robot& robot) {
  try {
    inverse_ = std::make_unique<InverseModel>(robot);
  } catch (const Error& error) {
    feed_forward_note_ =
        fmt::format("no model of the robot's motion, so no feed-forward, and gains that suit no robot in particular: {}", error.what());
  }
}

double PositionController::reading(const Loop& loop, const State& state) const {
  return is_height_ ? reportedHand(state).y() : state.angle_deg.at(loop.angle);
}

Antagonism PositionController::antagonism(const Loop& loop) const {
  return {level_, loop.sense, largest_difference_};
}

std::vector<double> PositionController::anglesAt(double time_s) const {
  std::vector<double> angles_deg(angle_count_, 0.0);
  for (const Loop& loop : loops_) angles_deg[loop.angle] = loop.target(time_s);
  return angles_deg;
}

double PositionController::forward(const Loop& loop, double time_s) const {
  constexpr double beside_s = 0.05;  ///< smooths the corners of targets; 0.2 % of the acceleration of a sine of 0.5 Hz
  if (!feeds_forward_) return 0;
  const double change_deg = loop.target(time_s + beside_s) - 2 * loop.target(time_s) + loop.target(time_s - beside_s);
  const double acceleration_deg_per_s2 = has_begun_ ? change_deg / (beside_s * beside_s) : 0;
  return inverse_->difference(loop.angle, anglesAt(time_s), acceleration_deg_per_s2, antagonism(loop));
}

double PositionController::difference(Loop& loop, const State& state) {
  loop.target_now = loop.target(state.time_s);
  const double forward_now = forward(loop, state.time_s + step_s_ / 2);
  if (!has_begun_) return forward_now;
  const double error = loop.target_now - reading(loop, state);
  const double speed_per_s = has_error_ ? (error - loop.error_before) / step_s_ : 0;
  loop.error_before = error;
  const Gains& gains = loop.gains;
  const double u = forward_now + gains.proportional * error + loop.integrated + gains.damping_s * speed_per_s;
  const double limited = std::clamp(u, -largest_difference_, largest_difference_);
  double change_per_s = gains.integral_per_s * error;
  if (gains.proportional > 0) change_per_s += (limited - u) * gains.integral_per_s / gains.proportional;
  loop.integrated = std::clamp(loop.integrated + step_s_ * change_per_s, -2 * largest_difference_, 2 * largest_difference_);
  return limited;
}

Action PositionController::output(const State& state) {
  Action action = level_;
  for (Loop& loop : loops_) {
    const double u = difference(loop, state);
    for (std::size_t i = 0; i < action.size(); ++i) action[i] = std::clamp(action[i] + loop.sense[i] * u, 0.0, 1.0);
  }
  has_error_ = has_begun_;
  has_begun_ = true;
  return action;
}

std::optional<Vector> PositionController::targetMm() const {
  if (!is_height_) return std::nullopt;
  return Vector(0, loops_.front().target_now, 0);
}

void PositionController::moveTarget(const Vector& target_mm) {
  if (is_height_) loops_.front().target = [y_mm = target_mm.y()](double) { return y_mm; };
}

std::vector<std::pair<std::string, double>> PositionController::signals() const {
  std::vector<std::pair<std::string, double>> signals;
  for (const Loop& loop : loops_)
    if (!is_height_) signals.emplace_back("target_" + loop.joint + "_deg", loop.target_now);
  return signals;
}

std::vector<std::string> PositionController::notes() const {
  std::vector<std::string> notes;
  for (const Loop& loop : loops_) {
    std::vector<std::string> names;
    for (const Channel& channel : loop.channels) names.push_back(channel.text());
    notes.push_back(fmt::format("{} moved by {}{}", is_height_ ? "height of the hand" : "angle " + loop.joint, fmt::join(names, ","),
                                feeds_forward_ ? "" : ", without feed-forward"));
  }
  notes.insert(notes.end(), target_notes_.begin(), target_notes_.end());
  if (!feed_forward_note_.empty()) notes.push_back(feed_forward_note_);
  return notes;
}

}  // namespace musclesim
