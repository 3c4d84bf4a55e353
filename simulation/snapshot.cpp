#include "snapshot.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "../robot/ode_vector.h"
#include "../robot/springs.h"
#include "contacts.h"
#include "musclesim/base/color.h"
#include "musclesim/robot/line_of_pull.h"

namespace musclesim {

namespace {

constexpr float line_radius_mm = 3;  ///< drawn radius of massless muscles, which have no radius

Eigen::Matrix4f poseFrom(const Vector& position, const Eigen::Matrix3d& rotation) {
  Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();
  pose.topLeftCorner<3, 3>() = rotation.cast<float>();
  pose.topRightCorner<3, 1>() = position.cast<float>();
  return pose;
}

DrawnPart partOf(const Primitive& primitive, int number) {
  const dGeomID geom = primitive.geom();
  const dReal* r = dGeomGetRotation(geom);
  Eigen::Matrix3d rotation;
  rotation << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  return {primitive.shape().kind, primitive.shape().size_mm.cast<float>(), poseFrom(fromOde(dGeomGetPosition(geom)), rotation),
          primitive.color(), number};
}

/// A drum as wide as the line that it carries needs; cylinders have no ends in the model.
DrawnPart partOf(const Pulley& pulley) {
  constexpr float drum_width_mm = 5 * line_radius_mm;
  const Color color{0.45, 0.45, 0.5, ""};
  const auto radius_mm = static_cast<float>(pulley.radius_mm);
  if (pulley.axis.isZero(0))
    return {Shape::Kind::sphere, {radius_mm, 0, 0}, poseFrom(pulley.center_mm, Eigen::Matrix3d::Identity()), color};
  Eigen::Matrix3d turn;
  turn.col(2) = pulley.axis.normalized();
  turn.col(0) = turn.col(2).unitOrthogonal();
  turn.col(1) = turn.col(2).cross(turn.col(0));
  return {Shape::Kind::cylinder, {radius_mm, drum_width_mm, 0}, poseFrom(pulley.center_mm, turn), color};
}

/// Where a chain is attached. The direction of its outer link does not say it: the two beads of a short link coincide.
Eigen::Vector3f attachmentOf(const Joint& joint) {
  dVector3 anchor = {};
  dJointGetBallAnchor(joint.id(), anchor);
  return fromOde(anchor).cast<float>();
}

/// Loose ends of a chain lie one radius beyond the first and the last bead.
std::vector<Eigen::Vector3f> pointsOf(const Actuator& muscle) {
  std::vector<Eigen::Vector3f> points;
  if (muscle.line()) {
    for (const Vector& point : muscle.line()->pointsMm()) points.push_back(point.cast<float>());
    return points;
  }
  const double radius = muscle.settings().bead_radius_mm;
  const auto along = [](const Link& link) { return (positionOf(link.bead[1]) - positionOf(link.bead[0])).stableNormalized(); };
  const Link &first = muscle.links().front(), &last = muscle.links().back();
  points.push_back(muscle.startJoint() ? attachmentOf(*muscle.startJoint())
                                       : (positionOf(first.bead[0]) - radius * along(first)).cast<float>());
  for (const Link& link : muscle.links())
    for (const dBodyID bead : link.bead) points.push_back(positionOf(bead).cast<float>());
  points.push_back(muscle.endJoint() ? attachmentOf(*muscle.endJoint()) : (positionOf(last.bead[1]) + radius * along(last)).cast<float>());
  return points;
}

DrawnHose hoseOf(const Actuator& muscle, const Color& color) {
  const float radius = muscle.line() ? line_radius_mm : static_cast<float>(muscle.settings().bead_radius_mm);
  return {pointsOf(muscle), radius, color, muscle.tensionN(), muscle.minimumLengthMm(), muscle.maximumLengthMm(), muscle.lengthMm()};
}

/// A coil has straight ends of a tenth of its length each, and the same number of windings at any length.
DrawnSpring springOf(const PointSpring& spring) {
  constexpr float wire_radius_mm = 1, coil_radius_mm = 6, straight_share = 0.1F;
  constexpr int windings = 10, points_per_winding = 10;
  const auto [from_mm, to_mm] = spring.endsMm();
  const Eigen::Vector3f from = from_mm.cast<float>(), along = (to_mm - from_mm).cast<float>();
  DrawnSpring drawn{{from}, wire_radius_mm, {0.35, 0.4, 0.45, ""}};
  if (!spring.settings().pulls_only && along.norm() > 0) {
    const Eigen::Vector3f side = along.unitOrthogonal(), other_side = along.normalized().cross(side);
    for (int i = 0; i <= windings * points_per_winding; ++i) {
      const float turned = static_cast<float>(i) / points_per_winding, angle = 2 * std::numbers::pi_v<float> * turned;
      const float share = straight_share + (1 - 2 * straight_share) * turned / windings;
      drawn.points_mm.push_back(from + share * along + coil_radius_mm * (std::cos(angle) * side + std::sin(angle) * other_side));
    }
  }
  drawn.points_mm.push_back(to_mm.cast<float>());
  return drawn;
}

std::optional<Vector> anchorOf(const Joint& joint) {
  dVector3 anchor = {};
  if (joint.kind() == Joint::Kind::ball)
    dJointGetBallAnchor(joint.id(), anchor);
  else if (joint.kind() == Joint::Kind::hinge)
    dJointGetHingeAnchor(joint.id(), anchor);
  else if (joint.kind() == Joint::Kind::hinge2)
    dJointGetHinge2Anchor(joint.id(), anchor);
  else if (joint.kind() == Joint::Kind::universal)
    dJointGetUniversalAnchor(joint.id(), anchor);
  else
    return std::nullopt;
  return fromOde(anchor);
}

/// The name of a joint: that of its angle, or else that of the bone.
std::string labelOf(const Joint& joint, const Body& body, const Robot& robot) {
  for (const Robot::Angle& angle : robot.angles())
    if (angle.joint == &joint) return angle.name;
  return body.parts.empty() ? joint.name() : body.parts.front()->name();
}

/// The joints between bones, with the axes of the moving bone. Joints of muscles are left out.
std::vector<DrawnFrame> framesOf(Simulation& simulation) {
  std::vector<DrawnFrame> frames;
  for (const auto& body : simulation.world().bodies()) {
    for (const auto& joint : simulation.world().joints()) {
      if (dJointGetBody(joint->id(), 0) != body->id) continue;
      if (const auto anchor = anchorOf(*joint))
        frames.push_back({labelOf(*joint, *body, simulation.robot()), poseFrom(*anchor, rotationOf(body->id))});
    }
  }
  const Robot& robot = simulation.robot();
  if (robot.hand()) frames.push_back({"hand", poseFrom(robot.handMm(), robot.hand()->getRotation())});
  return frames;
}

std::vector<DrawnContact> contactsOf(const Simulation& simulation) {
  std::vector<DrawnContact> contacts;
  for (const ContactPoint& point : simulation.contacts().points())
    contacts.push_back({fromOde(point.geometry.pos).cast<float>(), fromOde(point.geometry.normal).cast<float>()});
  return contacts;
}

std::optional<DrawnPull> pullOf(const Simulation& simulation) {
  if (!simulation.pull()) return std::nullopt;
  const PullForce pull = pullForce(simulation.world(), *simulation.pull());
  return DrawnPull{pull.point_mm.cast<float>(), simulation.pull()->towards_mm.cast<float>(), pull.force_N.norm()};
}

/// The height of the ground plane (--plane).
std::optional<float> floorOf(dSpaceID space) {
  for (int i = 0; i < dSpaceGetNumGeoms(space); ++i) {
    const dGeomID geom = dSpaceGetGeom(space, i);
    if (dGeomGetClass(geom) != dPlaneClass) continue;
    dVector4 plane;
    dGeomPlaneGetParams(geom, plane);
    return static_cast<float>(plane[3]);
  }
  return std::nullopt;
}

}  // namespace

SnapshotTaker::SnapshotTaker(Simulation& simulation) : simulation_(simulation) {
  const std::vector<Color> own = simulation.robot().namedMuscleColors();
  for (int i = 0; i < simulation.robot().actuatorCount(); ++i) muscle_colors_.push_back(muscleColor(static_cast<std::size_t>(i), own));
}

/// A target height has no horizontal position; it is shown where the hand was at first.
std::optional<DrawnTarget> SnapshotTaker::target(const State& state) {
  if (!first_hand_mm_) first_hand_mm_ = state.hand_mm;
  const Controller* controller = simulation_.controller();
  if (!controller || !controller->targetMm()) return std::nullopt;
  Vector point = *controller->targetMm();
  const bool is_height = controller->targetIsHeight();
  if (is_height && first_hand_mm_) point = {first_hand_mm_->x(), point.y(), first_hand_mm_->z()};
  return DrawnTarget{point.cast<float>(), is_height};
}

Snapshot SnapshotTaker::take(const State& state) {
  Snapshot snapshot;
  snapshot.state = state;
  for (const Robot::Angle& angle : simulation_.robot().angles()) snapshot.angle_names.push_back(angle.name);
  if (const Controller* controller = simulation_.controller()) snapshot.activity = controller->activity();
  const auto& primitives = simulation_.world().primitives();
  for (std::size_t i = 0; i < primitives.size(); ++i)
    if (primitives[i]->isVisible()) snapshot.parts.push_back(partOf(*primitives[i], static_cast<int>(i)));
  for (const auto& actuator : simulation_.world().actuators())
    if (actuator->line())
      for (const Pulley& pulley : actuator->line()->pulleys()) snapshot.parts.push_back(partOf(pulley));
  const auto& muscles = simulation_.robot().actuators();
  for (std::size_t i = 0; i < muscles.size(); ++i) snapshot.hoses.push_back(hoseOf(*muscles[i], muscle_colors_[i]));
  for (const auto& element : simulation_.world().forceElements())
    if (const auto* spring = dynamic_cast<const PointSpring*>(element.get())) snapshot.springs.push_back(springOf(*spring));
  snapshot.frames = framesOf(simulation_);
  snapshot.target = target(state);
  snapshot.contacts = contactsOf(simulation_);
  snapshot.pull = pullOf(simulation_);
  snapshot.floor_mm = floorOf(simulation_.space());
  return snapshot;
}

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A box that grows around what is added.
struct GrowingBox {
  Bounds bounds{Eigen::Vector3f::Constant(infinity), Eigen::Vector3f::Constant(-infinity)};

  void add(const Eigen::Vector3f& point, float margin) {
    bounds.low = bounds.low.cwiseMin((point.array() - margin).matrix());
    bounds.high = bounds.high.cwiseMax((point.array() + margin).matrix());
  }
  void add(const DrawnPart& part) {
    const Eigen::Vector3f center = part.pose.topRightCorner<3, 1>();
    const Eigen::Vector3f axis =
        part.pose.block<3, 1>(0, 2) *
        (part.kind == Shape::Kind::capped_cylinder || part.kind == Shape::Kind::cylinder ? part.size_mm.y() / 2 : 0);
    const float margin = part.kind == Shape::Kind::box ? part.size_mm.norm() / 2 : part.size_mm.x();
    add(center + axis, margin);
    add(center - axis, margin);
  }
  void add(const std::vector<DrawnPart>& parts, const std::vector<DrawnHose>& hoses) {
    for (const DrawnPart& part : parts) add(part);
    for (const DrawnHose& hose : hoses)
      for (const auto& point : hose.points_mm) add(point, hose.radius_mm);
  }
};

}  // namespace

Bounds boundsOf(const Snapshot& snapshot) {
  GrowingBox box;
  box.add(snapshot.parts, snapshot.hoses);
  for (const DrawnSpring& spring : snapshot.springs)
    for (const auto& point : spring.points_mm) box.add(point, spring.radius_mm);
  if (snapshot.ghost) box.add(snapshot.ghost->parts, snapshot.ghost->hoses);
  return box.bounds;
}

std::optional<double> distanceOfGhostMm(const Snapshot& snapshot) {
  if (!snapshot.ghost) return std::nullopt;
  float largest = 0;
  const auto compare = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { largest = std::max(largest, (a - b).norm()); };
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
    compare(snapshot.parts[i].pose.topRightCorner<3, 1>(), snapshot.ghost->parts[i].pose.topRightCorner<3, 1>());
  if (snapshot.parts.empty())
    for (std::size_t i = 0; i < snapshot.hoses.size(); ++i) {
      compare(snapshot.hoses[i].points_mm.front(), snapshot.ghost->hoses[i].points_mm.front());
      compare(snapshot.hoses[i].points_mm.back(), snapshot.ghost->hoses[i].points_mm.back());
    }
  return static_cast<double>(largest);
}

}  // namespace musclesim
