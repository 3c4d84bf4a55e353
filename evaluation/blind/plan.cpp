#include "plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cause.h"
#include "chance.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/replay.h"

namespace musclesim::blind {

namespace {

constexpr double hand_noise_mm = 0.3;

/// The measured signals: all angles and, on robots without any, the lengths; a third of the plants lack pressure or force.
std::vector<std::string> drawSignals(const Robot& robot, RandomStream& random) {
  const bool pressure = happens(random, 0.83), force = happens(random, 0.8), length = happens(random, 0.7), hand = happens(random, 0.6);
  const bool turns = !robot.angles().empty();
  std::vector<std::string> signals;
  for (const std::string& name : robot.signalNames()) {
    const bool measured = name.starts_with("pressure_") ? pressure
                          : name.starts_with("force_")  ? force
                          : name.starts_with("length_") ? length || !turns
                          : name.starts_with("hand_")   ? hand && turns
                                                        : name.starts_with("angle_");
    if (measured) signals.push_back(name);
  }
  return signals;
}

std::map<std::string, double> drawNoise(const std::vector<std::string>& signals, RandomStream& random) {
  const double pressure = rounded(logUniform(random, 0.002, 0.004), 1e5), force = rounded(logUniform(random, 0.5, 1), 1e3),
               length = rounded(logUniform(random, 0.05, 0.1), 1e4), angle = rounded(logUniform(random, 0.05, 0.1), 1e4);
  std::map<std::string, double> noise;
  for (const std::string& name : signals)
    noise[name] = name.starts_with("pressure_") ? pressure
                  : name.starts_with("force_")  ? force
                  : name.starts_with("length_") ? length
                  : name.starts_with("angle_")  ? angle
                                                : hand_noise_mm;
  return noise;
}

/// The range in which a signal must stay.
struct Bounds {
  std::string signal;
  double low, high;
  bool holds(double value) const { return value >= low && value <= high; }
};

/// Away from the stops: an impact is not predictable. Causes move joints further than the clean model does, so joints need a wide margin.
std::vector<Bounds> boundsOf(const Robot& robot) {
  constexpr double joint_margin = 1.0 / 7, muscle_margin = 0.02;  // shares of the range
  std::vector<Bounds> bounds;
  for (const Robot::Angle& angle : robot.angles()) {
    const auto [low, high] = angle.joint->stopsDeg(angle.axis);
    const double margin = joint_margin * (high - low);
    if (std::isfinite(margin)) bounds.push_back({fmt::format("angle_{}_deg", angle.name), low + margin, high - margin});
  }
  for (int i = 0; i < robot.actuatorCount(); ++i) {
    const Actuator& muscle = *robot.actuators()[static_cast<std::size_t>(i)];
    const double low = muscle.minimumLengthMm(), high = muscle.maximumLengthMm(), margin = muscle_margin * (high - low);
    bounds.push_back({fmt::format("length_{}_mm", i), low + margin, high - margin});
  }
  return bounds;
}

/// The largest excursion from rest over the one that the bounds allow, of the signals that rest within their bounds.
double excursionOf(const Recording& motion, const std::vector<Bounds>& bounds) {
  double largest = 0;
  for (const Bounds& one : bounds) {
    const Signal* signal = motion.find(one.signal);
    if (!signal || signal->values.empty() || !one.holds(signal->values.front())) continue;
    const double rest = signal->values.front();
    for (const double value : signal->values) {
      const double allowed = value > rest ? one.high - rest : rest - one.low;
      if (value != rest) largest = std::max(largest, std::abs(value - rest) / allowed);
    }
  }
  return largest;
}

/// Reduces the motion until the clean model stays off its stops. Returns its motion.
Recording keepFromStops(Recording& plan, const std::vector<Bounds>& bounds) {
  constexpr double least_factor = 0.2, largest_factor = 0.8;  // of one reduction: far out, the motion is not in proportion to the commands
  constexpr int most_reductions = 20;
  for (int reduction = 0;; ++reduction) {
    Recording motion = replayRecording(plan).simulated;
    const double excursion = excursionOf(motion, bounds);
    if (excursion <= 1 || reduction == most_reductions) return motion;
    const double smaller = std::clamp(1 / excursion, least_factor, largest_factor);
    for (Signal& command : plan.signals) {
      const double middle = command.values.front();
      for (double& u : command.values) u = rounded(middle + smaller * (u - middle), 1e4);
    }
  }
}

/// Whether a coordinate of the hand moves by less than its noise in all motions: a plane robot's hand never leaves its plane.
bool isFlat(const std::string& signal, const std::vector<Recording>& motions) {
  return signal.starts_with("hand_") && std::ranges::all_of(motions, [&](const Recording& motion) {
           const auto [low, high] = std::ranges::minmax(motion.find(signal)->values);
           return high - low < hand_noise_mm;
         });
}

/// The load of the rig, which is drawn too.
std::map<std::string, Parameter::Value> drawLoad(const Robot& robot, RandomStream& random) {
  const double load_kg = rounded(random.uniform(1.5, 3), 10);
  if (robot.name() != "rig") return {};
  return {{"load_kg", load_kg}};
}

}  // namespace

Plan drawPlan(const std::string& name, const std::string& robot_name, const Robot& robot, const std::vector<std::string>& kinds,
              double duration_s, RandomStream& random) {
  const Layout layout = layoutOf(robot.actuatorCount());
  Plan plan{name, robot_name, drawKind(kinds, random), "none", drawExcitations(layout, random), {}, drawSignals(robot, random), {}};
  if (plan.kind.most_known > 0 || plan.kind.unknown) plan.size = oneOf(random, sizeNames());
  const auto load = drawLoad(robot, random);
  const std::vector<Bounds> bounds = boundsOf(robot);
  std::vector<Recording> motions;
  for (const Excitation& excitation : plan.excitations) {
    plan.recordings.push_back(
        planned(robot_name, robot.actuatorCount(), excitation, layout == Layout::many ? duration_s / 2 : duration_s, random));
    plan.recordings.back().info.robot_parameters = load;
    motions.push_back(keepFromStops(plan.recordings.back(), bounds));
  }
  std::erase_if(plan.signals, [&](const std::string& signal) { return isFlat(signal, motions); });
  plan.noise_std = drawNoise(plan.signals, random);
  return plan;
}

}  // namespace musclesim::blind
