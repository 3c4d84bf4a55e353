#include "muscle_path.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/random.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/pulley.h"

namespace musclesim {

namespace {

/// In the source's world; lengths in mm, as Pulley has them.
Pulley pulleyInWorld(const SourceRobot& robot, const SourceStation& station) {
  const SourcePulley& pulley = robot.pulleys[*station.pulley];
  const Pose pose = robot.bodies[pulley.body].pose * pulley.pose;
  Pulley result{.center_mm = mm_per_m * pose.translation(),
                .axis = pulley.sphere ? Vector(Vector::Zero()) : Vector(pose.linear().col(2)),
                .radius_mm = mm_per_m * pulley.radius_m,
                .side_mm = {}};
  if (station.point) result.side_mm = mm_per_m * robot.inWorld(*station.point);
  return result;
}

/// Whether a pulley looks the same from both of the bodies that a joint connects: a cylinder along the axis of a hinge, or a sphere whose
/// centre lies on it.
bool isCoaxial(const SourceRobot& robot, const SourcePulley& pulley, const SourceJoint& joint) {
  if (joint.kind != SourceJoint::Kind::hinge) return false;
  const Pose &body = robot.bodies[joint.body].pose, pulley_pose = robot.bodies[pulley.body].pose * pulley.pose;
  const Eigen::Vector3d axis = body.linear() * joint.axis.normalized(), between = pulley_pose.translation() - body * joint.anchor_m;
  constexpr double same_place_m = 1e-9, parallel = 1e-9;  // sine
  return between.cross(axis).norm() < same_place_m && (pulley.sphere || pulley_pose.linear().col(2).cross(axis).norm() < parallel);
}

/// The index of that pulley on another body; adds it if there is none yet.
std::size_t pulleyOn(SourceRobot& robot, SourcePulley pulley, std::size_t body) {
  pulley.name += "_on_" + robot.bodies[body].name;
  pulley.pose = robot.bodies[body].pose.inverse() * robot.bodies[pulley.body].pose * pulley.pose;
  pulley.body = body;
  for (std::size_t i = 0; i < robot.pulleys.size(); ++i)
    if (robot.pulleys[i].name == pulley.name) return i;
  robot.pulleys.push_back(pulley);
  return robot.pulleys.size() - 1;
}

/// Side points are fixed to their pulley's body. A side point on the body at the other end of a hinge takes a pulley along the hinge's axis
/// with it: pulleys have no friction, so both bodies feel the same.
void attachSides(SourceRobot& robot, SourceMuscle& muscle) {
  for (SourceStation& station : muscle.path) {
    if (!station.pulley || !station.point || station.point->body == robot.pulleys[*station.pulley].body) continue;
    const SourcePulley pulley = robot.pulleys[*station.pulley];
    const std::size_t body = pulley.body, other = station.point->body;
    const auto joint = std::find_if(robot.joints.begin(), robot.joints.end(), [&](const SourceJoint& j) {
      return (j.body == body && j.to == other) || (j.body == other && j.to == body);
    });
    if (joint != robot.joints.end() && isCoaxial(robot, pulley, *joint)) {
      station.pulley = pulleyOn(robot, pulley, other);
      continue;
    }
    station.point = SourcePoint{body, robot.bodies[body].pose.inverse() * robot.inWorld(*station.point)};
    robot.notes.push_back(fmt::format("muscle {}: the side point of pulley {} is on body {} in the source and moves with the pulley here",
                                      muscle.name, pulley.name, robot.bodies[other].name));
  }
}

/// A pulley goes where a muscle here cannot wrap as in the source.
void removeImpossiblePulleys(SourceRobot& robot, SourceMuscle& muscle) {
  for (std::size_t i = 1; i + 1 < muscle.path.size();) {
    if (!muscle.path[i].pulley) {
      ++i;
      continue;
    }
    const Pulley pulley = pulleyInWorld(robot, muscle.path[i]);
    const auto isInside = [&](const SourceStation& station) { return pulley.encloses(mm_per_m * robot.inWorld(*station.point)); };
    std::string problem;
    if (pulley.side_mm && pulley.encloses(*pulley.side_mm))
      problem = "its side point lies inside, so that the muscle would wrap around on the inside";
    else if (isInside(muscle.path[i - 1]) || isInside(muscle.path[i + 1]))
      problem = "a point of the muscle next to it lies inside";
    if (problem.empty()) {
      ++i;
      continue;
    }
    robot.notes.push_back(
        fmt::format("muscle {}: pulley {} is left out of its path: {}", muscle.name, robot.pulleys[*muscle.path[i].pulley].name, problem));
    muscle.path.erase(muscle.path.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Pulleys that no path has any more go, too.
void removeUnusedPulleys(SourceRobot& robot) {
  std::vector<std::size_t> new_index(robot.pulleys.size(), robot.pulleys.size());
  std::vector<SourcePulley> used;
  for (SourceMuscle& muscle : robot.muscles)
    for (SourceStation& station : muscle.path) {
      if (!station.pulley) continue;
      std::size_t& index = new_index[*station.pulley];
      if (index == new_index.size()) {
        index = used.size();
        used.push_back(robot.pulleys[*station.pulley]);
      }
      station.pulley = index;
    }
  robot.pulleys = std::move(used);
}

/// Both ends on one body: the reader of robot files refuses such muscles and springs.
void removeWhatMovesNothing(SourceRobot& robot) {
  std::erase_if(robot.muscles, [&](const SourceMuscle& muscle) {
    const bool idle = muscle.path.front().point->body == muscle.path.back().point->body;
    if (idle)
      robot.notes.push_back(fmt::format("muscle {}: both of its ends are on body {}; it is not taken over", muscle.name,
                                        robot.bodies[muscle.path.front().point->body].name));
    return idle;
  });
  std::erase_if(robot.springs, [&](const SourceSpring& spring) {
    const bool idle = spring.from.body == spring.to.body;
    if (idle) robot.notes.push_back(fmt::format("spring {}: both of its ends are on one body; it is not taken over", spring.name));
    return idle;
  });
}

/// A pose at random within the limits of hinges and sliders, as a copy of the robot. Joints of closed loops stay.
SourceRobot posed(const SourceRobot& robot, RandomStream& random) {
  SourceRobot result = robot;
  for (const SourceJoint& joint : robot.joints)
    if (joint.limits && (joint.kind == SourceJoint::Kind::hinge || joint.kind == SourceJoint::Kind::slider)) {
      // Limits are reached, too, which a muscle is longest or shortest at.
      const double share = std::clamp(random.uniform(-0.1, 1.1), 0.0, 1.0);
      result.move(result.joints[static_cast<std::size_t>(&joint - robot.joints.data())],
                  joint.limits->low + share * (joint.limits->high - joint.limits->low));
    }
  return result;
}

/// Without the cable in series.
double lengthM(const SourceRobot& robot, const SourceMuscle& muscle) {
  return pathLengthM(robot, muscle) - muscle.tendon_m;
}

void giveRanges(SourceRobot& robot) {
  if (std::all_of(robot.muscles.begin(), robot.muscles.end(), [](const SourceMuscle& muscle) { return muscle.length_m.has_value(); }))
    return;
  std::vector<SourceRange> ranges;
  for (const SourceMuscle& muscle : robot.muscles) ranges.push_back({lengthM(robot, muscle), lengthM(robot, muscle)});
  constexpr int pose_count = 400;
  RandomStream random(0, "import.muscle_ranges");
  for (int pose = 0; pose < pose_count; ++pose) {
    const SourceRobot other = posed(robot, random);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const double length_m = lengthM(other, other.muscles[i]);
      ranges[i] = {std::min(ranges[i].low, length_m), std::max(ranges[i].high, length_m)};
    }
  }
  std::vector<std::string> given;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    SourceMuscle& muscle = robot.muscles[i];
    if (muscle.length_m) continue;
    given.push_back(muscle.name);
    // A little more than what occurs; where no joint with limits changes the length, what a pneumatic muscle does.
    constexpr double margin = 0.02, still = 1e-3, contracted = 0.7, stretched = 1.15;
    const bool moves = ranges[i].high > (1 + still) * ranges[i].low;
    muscle.length_m = moves ? SourceRange{(1 - margin) * ranges[i].low, (1 + margin) * ranges[i].high}
                            : SourceRange{contracted * ranges[i].low, stretched * ranges[i].high};
  }
  if (!given.empty())
    robot.notes.push_back(
        fmt::format("muscle{} {}: the range of lengths is that of the path over the joints' limits and 2 % more, or 0.7 .. "
                    "1.15 of the length as built where no joint with limits changes it",
                    given.size() == 1 ? "" : "s", fmt::join(given, ", ")));
}

/// Ranges that the reader of robot files takes: at least 15 mm, with the length as built inside.
void fitRange(SourceRobot& robot, SourceMuscle& muscle) {
  constexpr double shortest_m = 0.015, longest_share = 0.9;
  const double built_m = lengthM(robot, muscle);
  SourceRange range = *muscle.length_m;
  range.low = std::max(std::min(range.low, built_m), shortest_m);
  range.high = std::max({range.high, built_m, range.low / longest_share});
  if (range.low == muscle.length_m->low && range.high == muscle.length_m->high) return;
  robot.notes.push_back(fmt::format(
      "muscle {}: its range {:.4g} .. {:.4g} mm became {:.4g} .. {:.4g} mm, which is at least 15 mm and "
      "contains its length as built",
      muscle.name, mm_per_m * muscle.length_m->low, mm_per_m * muscle.length_m->high, mm_per_m * range.low, mm_per_m * range.high));
  muscle.length_m = range;
}

}  // namespace

double pathLengthM(const SourceRobot& robot, const SourceMuscle& muscle) {
  double length_mm = 0;
  for (std::size_t i = 0; i + 1 < muscle.path.size();) {
    const bool past_pulley = muscle.path[i + 1].pulley.has_value();
    const std::size_t next = past_pulley ? i + 2 : i + 1;
    const Vector from_mm = mm_per_m * robot.inWorld(*muscle.path[i].point), to_mm = mm_per_m * robot.inWorld(*muscle.path[next].point);
    length_mm += past_pulley ? wayPast(pulleyInWorld(robot, muscle.path[i + 1]), from_mm, to_mm).length_mm : (to_mm - from_mm).norm();
    i = next;
  }
  return length_mm / mm_per_m;
}

void preparePaths(SourceRobot& robot) {
  for (SourceMuscle& muscle : robot.muscles) attachSides(robot, muscle);
  for (SourceMuscle& muscle : robot.muscles) removeImpossiblePulleys(robot, muscle);
  removeWhatMovesNothing(robot);
  removeUnusedPulleys(robot);
  giveRanges(robot);
  for (SourceMuscle& muscle : robot.muscles) fitRange(robot, muscle);
}

}  // namespace musclesim
