#include "source_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "musclesim/base/error.h"
#include "musclesim/base/text.h"
#include "musclesim/base/units.h"

namespace musclesim {

namespace {

using Kind = SourceJoint::Kind;

bool isHinge(const SourceJoint& joint) {
  return joint.kind == Kind::hinge;
}

/// The point in which the axes of two hinges cross; no value if they pass each other or are parallel.
std::optional<Eigen::Vector3d> crossing(const SourceJoint& a, const SourceJoint& b) {
  const Eigen::Vector3d u = a.axis.normalized(), v = b.axis.normalized(), normal = u.cross(v);
  constexpr double parallel = 1e-9;  // sine of the angle between the axes
  constexpr double apart_m = 1e-9;
  if (normal.norm() < parallel) return std::nullopt;
  const Eigen::Vector3d between = b.anchor_m - a.anchor_m;
  if (std::abs(between.dot(normal.normalized())) > apart_m) return std::nullopt;
  return a.anchor_m + between.cross(v).dot(normal) / normal.squaredNorm() * u;
}

bool areSquare(const SourceJoint& a, const SourceJoint& b) {
  constexpr double right_angle = 1e-9;  // cosine; what attachUniversal takes
  return std::abs(a.axis.normalized().dot(b.axis.normalized())) < right_angle;
}

/// A joint of two or three axes has no friction, damping or spring of its own, and its limits contain the pose as built.
bool isPlain(const SourceJoint& joint) {
  const bool holds_zero = !joint.limits || (joint.limits->low <= 0 && joint.limits->high >= 0);
  return joint.friction == 0 && joint.damping == 0 && joint.stiffness == 0 && holds_zero;
}

/// Two plain hinges whose axes cross at right angles. In a series the first axis stays fixed to the parent, the second to the child.
std::optional<SourceJoint> universalOf(const std::vector<SourceJoint>& series) {
  if (series.size() != 2 || !std::all_of(series.begin(), series.end(), [](const auto& j) { return isHinge(j) && isPlain(j); })) return {};
  const auto anchor = crossing(series[0], series[1]);
  if (!anchor || !areSquare(series[0], series[1])) return {};
  SourceJoint joint = series[1];
  joint.kind = Kind::universal;
  joint.name = series[1].name + "_" + series[0].name;
  joint.anchor_m = *anchor;
  joint.axis2 = series[0].axis;  // still in the child's frame
  joint.limits2 = series[0].limits;
  return joint;
}

/// Three plain hinges that meet in a point and are not in a plane.
std::optional<SourceJoint> ballOf(const std::vector<SourceJoint>& series) {
  if (series.size() != 3 || !std::all_of(series.begin(), series.end(), [](const auto& j) { return isHinge(j) && isPlain(j); })) return {};
  const auto anchor = crossing(series[0], series[1]), other = crossing(series[1], series[2]);
  constexpr double apart_m = 1e-9;
  if (!anchor || !other || (*anchor - *other).norm() > apart_m) return {};
  constexpr double flat = 1e-6;  // volume spanned by the three unit axes
  if (std::abs(series[0].axis.normalized().cross(series[1].axis.normalized()).dot(series[2].axis.normalized())) < flat) return {};
  SourceJoint joint = series[0];
  joint.kind = Kind::ball;
  joint.name = series[0].name + "_" + series[1].name + "_" + series[2].name;
  joint.anchor_m = *anchor;
  joint.limits.reset();
  return joint;
}

/// Moves a joint's end from one body to another; `pose` is that of the old body in the new one.
void reattach(SourceJoint& joint, std::size_t old_body, std::size_t new_body, const Pose& pose) {
  if (joint.body == old_body) {
    joint.body = new_body;
    joint.anchor_m = pose * joint.anchor_m;
    joint.axis = pose.linear() * joint.axis;
  }
  if (joint.to == old_body) {
    joint.to = new_body;
    joint.axis2 = pose.linear() * joint.axis2;
  }
}

}  // namespace

SourceRobot::SourceRobot() {
  bodies.push_back({.name = "world", .fixed = true});
}

void SourceRobot::join(std::size_t parent, std::size_t child, std::vector<SourceJoint> series) {
  if (series.empty()) series.push_back({.name = bodies[child].name + "_fixed"});
  if (auto universal = universalOf(series)) {
    universal->axis2 = bodies[parent].pose.linear().transpose() * bodies[child].pose.linear() * universal->axis2;
    notes.push_back(fmt::format("joints {} and {} of body {}: one universal joint, {}; its first axis is that of {}", series[0].name,
                                series[1].name, bodies[child].name, universal->name, series[1].name));
    series = {*universal};
  } else if (const auto ball = ballOf(series)) {
    notes.push_back(fmt::format("joints {}, {} and {} of body {}: one ball joint, {}, without limits", series[0].name, series[1].name,
                                series[2].name, bodies[child].name, ball->name));
    series = {*ball};
  }
  std::size_t to = parent;
  for (std::size_t i = 0; i < series.size(); ++i) {
    std::size_t body = child;
    if (i + 1 < series.size()) {
      body = bodies.size();
      bodies.push_back({.name = fmt::format("{}_carrier_{}", bodies[child].name, i), .pose = bodies[child].pose, .carrier_for = child});
    }
    series[i].body = body;
    series[i].to = to;
    joints.push_back(series[i]);
    to = body;
  }
}

bool SourceRobot::move(const SourceJoint& joint, double amount) {
  const Pose& pose = bodies[joint.body].pose;
  const Eigen::Vector3d anchor = pose * joint.anchor_m, axis = (pose.linear() * joint.axis).normalized();
  Pose change = Pose::Identity();
  if (joint.kind == Kind::hinge)
    change = Eigen::Translation3d(anchor) * Eigen::AngleAxisd(amount, axis) * Eigen::Translation3d(-anchor);
  else
    change.translation() = amount * axis;
  std::vector<bool> moved(bodies.size());
  std::vector<std::size_t> open{joint.body};
  moved[joint.body] = true;
  while (!open.empty()) {
    const std::size_t body = open.back();
    open.pop_back();
    for (const SourceJoint& other : joints) {
      if (&other == &joint || (other.body != body && other.to != body)) continue;
      const std::size_t next = other.body == body ? other.to : other.body;
      if (!moved[next]) open.push_back(next);
      moved[next] = true;
    }
  }
  if (moved[joint.to]) return false;
  for (std::size_t body = 0; body < bodies.size(); ++body)
    if (moved[body]) bodies[body].pose = change * bodies[body].pose;
  return true;
}

namespace {

/// Makes everything that refers to the joint's body refer to the body that it is fixed to.
void mergeBodies(SourceRobot& robot, std::size_t body, std::size_t to) {
  SourceBody &part = robot.bodies[body], &whole = robot.bodies[to];
  const Pose pose = whole.pose.inverse() * part.pose;
  if (to == 0) {
    part.fixed = true;
  } else {
    part.gone = true;
    whole.mass.add(part.mass.seenFrom(pose));
    whole.collides = whole.collides || part.collides;
    for (SourceShape shape : part.shapes) {
      shape.pose = pose * shape.pose;
      whole.shapes.push_back(shape);
    }
    robot.notes.push_back(fmt::format("body {}: a part of body {}, to which it is fixed", part.name, whole.name));
  }
  const auto movePoint = [&](SourcePoint& point) {
    if (point.body != body) return;
    point.body = to;
    point.position_m = pose * point.position_m;
  };
  for (SourceJoint& joint : robot.joints) reattach(joint, body, to, pose);
  for (SourcePulley& pulley : robot.pulleys)
    if (pulley.body == body) pulley.body = to, pulley.pose = pose * pulley.pose;
  for (SourceMuscle& muscle : robot.muscles)
    for (SourceStation& station : muscle.path)
      if (station.point) movePoint(*station.point);
  for (SourceSpring& spring : robot.springs) movePoint(spring.from), movePoint(spring.to);
  for (SourceBody& other : robot.bodies)
    if (other.carrier_for == body) other.carrier_for = to;
}

/// Exchanges body and `to`. The angle of one body against the other about an axis is that of the other against the one about the opposite
/// axis.
void swapEnds(const SourceRobot& robot, SourceJoint& joint) {
  const Pose between = robot.bodies[joint.to].pose.inverse() * robot.bodies[joint.body].pose;
  joint.anchor_m = between * joint.anchor_m;
  if (joint.kind == Kind::universal) {
    joint.axis = -std::exchange(joint.axis2, -joint.axis);
    std::swap(joint.limits, joint.limits2);
  } else {
    joint.axis = -(between.linear() * joint.axis);
  }
  std::swap(joint.body, joint.to);
}

void mergeFixedBodies(SourceRobot& robot) {
  const auto isFixed = [](const SourceJoint& joint) { return joint.kind == Kind::fixed; };
  for (auto joint = std::find_if(robot.joints.begin(), robot.joints.end(), isFixed); joint != robot.joints.end();
       joint = std::find_if(robot.joints.begin(), robot.joints.end(), isFixed)) {
    const std::size_t body = joint->body, to = joint->to;
    robot.joints.erase(joint);
    if (body == to) continue;  // two fixed joints between the same bodies
    if (body == 0)
      mergeBodies(robot, to, body);
    else
      mergeBodies(robot, body, to);
  }
  for (SourceJoint& joint : robot.joints) {
    if (joint.body == joint.to)
      throw BadFile(robot.file, fmt::format("joint {}: fixed joints hold both of its bodies together, so that it cannot move", joint.name));
    if (joint.body == 0) swapEnds(robot, joint);
  }
}

void requireMechanics(const SourceRobot& robot, const SourceJoint& joint) {
  for (const auto& [name, value] : {std::pair("friction", joint.friction), {"damping", joint.damping}, {"stiffness", joint.stiffness}})
    if (!(value >= 0)) throw BadFile(robot.file, fmt::format("joint {}: its {} {:g} must not be negative", joint.name, name, value));
}

void requireMass(const SourceRobot& robot, const SourceBody& body) {
  if (!(body.mass.mass_kg > 0))
    throw BadFile(robot.file, fmt::format("body {}: it can move and has no mass; give it a mass and an inertia", body.name));
}

/// Carriers get a thousandth of the mass and inertia of the body that they carry, which keeps the rest.
void giveCarriersMass(SourceRobot& robot) {
  constexpr double share = 1e-3;
  std::vector<int> carriers(robot.bodies.size());
  for (const SourceBody& carrier : robot.bodies) ++carriers[carrier.carrier_for];
  for (SourceBody& carrier : robot.bodies) {
    if (carrier.carrier_for == 0) continue;
    requireMass(robot, robot.bodies[carrier.carrier_for]);
    carrier.mass = robot.bodies[carrier.carrier_for].mass.scaled(share);
    robot.notes.push_back(fmt::format("body {}: stands between two joints of body {} and has a thousandth of its mass", carrier.name,
                                      robot.bodies[carrier.carrier_for].name));
  }
  for (std::size_t body = 1; body < robot.bodies.size(); ++body)
    robot.bodies[body].mass = robot.bodies[body].mass.scaled(1 - share * carriers[body]);
}

/// The angle within limits that exclude 0 at which the robot is built: the limit next to 0, or the middle where the engine could not hold
/// the other limit.
double poseWithin(const SourceRange& limits, double widest) {
  const double nearest = limits.low > 0 ? limits.low : limits.high;
  return limits.high - limits.low <= widest ? nearest : (limits.low + limits.high) / 2;
}

void shift(SourceJoint& joint, double amount) {
  joint.limits->low -= amount;
  joint.limits->high -= amount;
  joint.rest -= amount;
}

std::string quantity(const SourceJoint& joint, double value) {
  return joint.kind == Kind::slider ? fmt::format("{:.4g} mm", value * mm_per_m) : fmt::format("{:.4g} deg", value * deg_per_rad);
}

void fitLimits(SourceRobot& robot, SourceJoint& joint) {
  constexpr double widest_hinge = 175 * rad_per_deg;  // stops further away act on the wrong side
  const double widest = joint.kind == Kind::slider ? std::numeric_limits<double>::infinity() : widest_hinge;
  if (joint.limits && (joint.limits->low > 0 || joint.limits->high < 0)) {
    const double amount = poseWithin(*joint.limits, widest);
    robot.notes.push_back(fmt::format("joint {}: 0 lies outside of its limits {} .. {}; it is built at {}, from where positions count",
                                      joint.name, quantity(joint, joint.limits->low), quantity(joint, joint.limits->high),
                                      quantity(joint, amount)));
    if (!robot.move(joint, amount))
      throw BadFile(robot.file,
                    fmt::format("joint {}: its limits exclude 0, and it belongs to a closed loop, so that the robot cannot be built "
                                "within them; give it limits that contain 0",
                                joint.name));
    shift(joint, amount);
  }
  for (auto* limits : {&joint.limits, &joint.limits2}) {
    if (!*limits || ((*limits)->low >= -widest && (*limits)->high <= widest)) continue;
    robot.notes.push_back(fmt::format("joint {}: no limits, since {} .. {} are beyond the -175 .. 175 deg that stops can have", joint.name,
                                      quantity(joint, (*limits)->low), quantity(joint, (*limits)->high)));
    limits->reset();
  }
  if (joint.kind != Kind::universal || joint.limits.has_value() == joint.limits2.has_value()) return;
  // A robot file has limits for both axes or for none.
  (joint.limits ? joint.limits2 : joint.limits) = SourceRange{-widest, widest};
}

/// Bodies need positive moments of inertia of which none is greater than the sum of the other two.
void makePossible(SourceRobot& robot, SourceBody& body) {
  requireMass(robot, body);
  Eigen::Matrix3d& inertia = body.mass.inertia_kg_m2;
  inertia = (inertia + inertia.transpose()).eval() / 2;
  constexpr double water_kg_per_m3 = 1000;
  const double radius_m = std::cbrt(body.mass.mass_kg / water_kg_per_m3 * 3 / (4 * std::numbers::pi));
  const double sphere_kg_m2 = 0.4 * body.mass.mass_kg * radius_m * radius_m;
  constexpr double least_ratio = 1e-6;  // of a sphere's moment: below it the moment is meant to be 0
  if (principalInertia(inertia).moments_kg_m2(0) < least_ratio * sphere_kg_m2) {
    inertia += sphere_kg_m2 * Eigen::Matrix3d::Identity();
    robot.notes.push_back(
        fmt::format("body {}: a moment of inertia is not positive; all are raised by {:.3g} kg m^2, that of a sphere of its "
                    "mass with the density of water",
                    body.name, sphere_kg_m2));
  }
  const double missing_kg_m2 = missingInertia(inertia);
  if (missing_kg_m2 == 0) return;
  inertia += missing_kg_m2 * Eigen::Matrix3d::Identity();
  robot.notes.push_back(
      fmt::format("body {}: its moments of inertia are raised by {:.3g} kg m^2, since no body has one that is greater than "
                  "the sum of the other two",
                  body.name, missing_kg_m2));
}

/// Letters, digits and _; other characters become _.
std::string plainName(const std::string& name) {
  std::string plain = name;
  for (char& character : plain)
    if (!std::isalnum(static_cast<unsigned char>(character))) character = '_';
  return plain;
}

/// Names that parameters of the program begin with; a robot cannot have them.
bool isGroupOfParameters(const std::string& name) {
  static const std::set<std::string> groups = {"muscle", "force_law", "physics", "world", "task",
                                               "asm",    "aasm",      "effect",  "noise", "record"};
  return groups.contains(name);
}

/// Gives all things of one kind names that are plain and different.
template <class Things>
void nameAll(SourceRobot& robot, Things& things, const std::string& kind, std::set<std::string> taken) {
  int index = 0;
  for (auto& thing : things) {
    const std::string plain = thing.name.empty() ? fmt::format("{}_{}", kind, index) : plainName(thing.name);
    std::string name = plain;
    for (int number = 2; !taken.insert(name).second; ++number) name = fmt::format("{}_{}", plain, number);
    if (!thing.name.empty() && name != thing.name) robot.notes.push_back(fmt::format("{} {}: named {}", kind, inQuotes(thing.name), name));
    thing.name = name;
    ++index;
  }
}

}  // namespace

void giveShapes(SourceRobot& robot, SourceBody& body, const LinkShapes& shapes) {
  body.shapes = shapes.touching.empty() ? shapes.seen : shapes.touching;
  if (!shapes.seen.empty())
    for (SourceShape& shape : body.shapes)
      if (!shape.color) shape.color = shapes.seen[0].color;
  if (shapes.mesh_count == 0) return;
  const std::string meshes = shapes.mesh_count == 1 ? "a mesh is" : fmt::format("{} meshes are", shapes.mesh_count);
  std::string instead = "its other shapes stay";
  if (body.shapes.empty()) {
    if (const auto box = equivalentBox(body.mass)) body.shapes.push_back(*box);
    instead = body.shapes.empty() ? "it is not drawn" : "it is drawn as the box with its inertia";
  }
  robot.notes.push_back(fmt::format("body {}: {} not taken over; {}", body.name, meshes, instead));
}

void prepare(SourceRobot& robot) {
  robot.name = plainName(robot.name);
  if (isGroupOfParameters(robot.name)) robot.name += "_robot";
  nameAll(robot, robot.bodies, "body", {});
  nameAll(robot, robot.joints, "joint", {});
  nameAll(robot, robot.pulleys, "pulley", {});
  nameAll(robot, robot.muscles, "muscle", {});
  nameAll(robot, robot.springs, "spring", {});
  mergeFixedBodies(robot);
  giveCarriersMass(robot);
  for (SourceJoint& joint : robot.joints) requireMechanics(robot, joint), fitLimits(robot, joint);
  for (std::size_t body = 1; body < robot.bodies.size(); ++body)
    if (!robot.bodies[body].gone && !robot.bodies[body].fixed) makePossible(robot, robot.bodies[body]);
}

}  // namespace musclesim
