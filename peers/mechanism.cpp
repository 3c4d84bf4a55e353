#include "mechanism.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "../robot/ode_vector.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/line_of_pull.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim::peers {

namespace {

/// ODE's world is in mm, g, s.
constexpr double kg_m2_per_g_mm2 = 1 / g_mm2_per_kg_m2;

class Reader {
 public:
  explicit Reader(Simulation& simulation) : world_(simulation.world()) {
    if (world_.physics().kind != PhysicsKind::si) throw BadParameter("physics", nameOf(world_.physics().kind), "be si for another engine");
    result_.gravity_m_per_s2 = world_.physics().gravity_mm_per_s2 / mm_per_m;
    for (const auto& body : world_.bodies()) addBody(body->id, body->parts.empty() ? "body" : body->parts.front()->name());
    for (const Actuator* actuator : world_.actuators())
      for (const Link& link : actuator->links())
        for (const dBodyID bead : link.bead) addBody(bead, actuator->name());
    for (const auto& joint : world_.joints()) addJoint(*joint);
    for (const Actuator* actuator : simulation.robot().actuators()) addMuscle(*actuator);
    if (!std::ranges::all_of(world_.forceElements(), [](const auto& element) { return element->onlyDampsAJoint(); }))
      throw BadParameter("springs and walls between bodies: the models of other engines have none");
    if (const Primitive* hand = simulation.robot().hand()) {
      const dBodyID body = hand->body().id;
      const Vector offset_mm = simulation.robot().handMm() - positionOf(body);
      result_.hand = {bodies_.at(body), rotationOf(body).transpose() * offset_mm / mm_per_m};
    }
    mergeBalls();
  }
  Mechanism result() { return std::move(result_); }

 private:
  int indexOf(dBodyID body) const { return body ? bodies_.at(body) : environment; }

  void addBody(dBodyID id, const std::string& name) {
    dMass mass;
    dBodyGetMass(id, &mass);
    const dReal* q = dBodyGetQuaternion(id);
    bodies_[id] = static_cast<int>(result_.bodies.size());
    result_.bodies.push_back({name, mass.mass / g_per_kg, matrixFromOde(mass.I) * kg_m2_per_g_mm2, positionOf(id) / mm_per_m,
                              Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized()});
  }

  /// How many of ODE's units are one of a coordinate (m, rad) and of its force (N, N m).
  struct AxisUnits {
    double coordinate, force;
  };
  static constexpr AxisUnits turning = {1, world_force_per_N*mm_per_m}, sliding = {mm_per_m, world_force_per_N};

  /// The axis with the coordinate `now`; `group` is ODE's group of parameters.
  template <class Get>
  static JointAxis readAxis(const Joint& joint, const Vector& direction, double now, const AxisUnits& units, int group, const Get& get) {
    JointAxis axis{.direction = direction.normalized()};
    const double low = get(dParamLoStop + group), high = get(dParamHiStop + group), most = get(dParamFMax + group);
    if (low <= high) {
      axis.low = (low - now) / units.coordinate;
      axis.high = (high - now) / units.coordinate;
    }
    // A motor at rest with a largest force is dry friction; one without is viscous friction, softened to a speed per force. The damping of
    // a joint's first axis is known even where dry friction or a stop takes the motor.
    const bool is_damped = group == 0 && joint.dampingSoftness() > 0;
    const double softness = is_damped ? joint.dampingSoftness() : std::isfinite(most) ? 0 : get(dParamCFM + group);
    if (softness > 0) axis.damping = units.coordinate / (units.force * softness);
    axis.friction = is_damped ? joint.dryFriction() / units.force : std::isfinite(most) ? most / units.force : 0;
    return axis;
  }

  void addJoint(const Joint& joint) {
    const dJointID id = joint.id();
    BodyJoint result{.kind = joint.kind(),
                     .first = indexOf(dJointGetBody(id, 0)),
                     .second = indexOf(dJointGetBody(id, 1)),
                     .anchor_m = Vector::Zero(),
                     .axes = {},
                     .source = &joint};
    if (result.first == environment) throw BadParameter("joint " + joint.name() + ": its first body is the environment");
    joints_[&joint] = static_cast<int>(result_.joints.size());
    dVector3 anchor = {}, axis = {};
    const auto hinge = [id](int which) { return dJointGetHingeParam(id, which); };
    const auto slider = [id](int which) { return dJointGetSliderParam(id, which); };
    const auto universal = [id](int which) { return dJointGetUniversalParam(id, which); };
    switch (joint.kind()) {
      case Joint::Kind::ball:
        dJointGetBallAnchor(id, anchor);
        break;
      case Joint::Kind::hinge:
        dJointGetHingeAnchor(id, anchor);
        dJointGetHingeAxis(id, axis);
        result.coordinate_as_built = dJointGetHingeAngle(id);
        result.axes.push_back(readAxis(joint, fromOde(axis), dJointGetHingeAngle(id), turning, 0, hinge));
        break;
      case Joint::Kind::slider:
        dJointGetSliderAxis(id, axis);
        result.coordinate_as_built = dJointGetSliderPosition(id) / mm_per_m;
        result.axes.push_back(readAxis(joint, fromOde(axis), dJointGetSliderPosition(id), sliding, 0, slider));
        break;
      case Joint::Kind::universal:
        dJointGetUniversalAnchor(id, anchor);
        dJointGetUniversalAxis1(id, axis);
        result.coordinate_as_built = dJointGetUniversalAngle1(id);
        result.axes.push_back(readAxis(joint, fromOde(axis), dJointGetUniversalAngle1(id), turning, 0, universal));
        dJointGetUniversalAxis2(id, axis);
        result.axes.push_back(readAxis(joint, fromOde(axis), dJointGetUniversalAngle2(id), turning, dParamGroup2, universal));
        break;
      case Joint::Kind::fixed:
        break;
      case Joint::Kind::hinge2:
        throw BadParameter("joint " + joint.name() + ": the models of other engines have no two-axis hinges");
    }
    result.anchor_m = fromOde(anchor) / mm_per_m;
    result_.joints.push_back(result);
  }

  BodyPoint pointOf(dBodyID body, const Vector& place_mm) const { return {indexOf(body), place_mm / mm_per_m}; }

  void addMuscle(const Actuator& actuator) {
    MuscleParts muscle{.actuator = &actuator, .length_m = actuator.lengthMm() / mm_per_m};
    for (const Link& link : actuator.links()) muscle.sliders.push_back(joints_.at(link.slider));
    for (const Joint* hinge : actuator.hinges()) muscle.hinges.push_back(joints_.at(hinge));
    if (actuator.startJoint()) muscle.start_joint = joints_.at(actuator.startJoint());
    if (actuator.endJoint()) muscle.end_joint = joints_.at(actuator.endJoint());
    if (const LineOfPull* line = actuator.line()) {
      for (const auto& point : line->points()) muscle.points.push_back(pointOf(point.body, point.place));
      for (const auto& mounted : line->mountedPulleys()) {
        auto& pulley = muscle.pulleys.emplace_back();
        if (!mounted) continue;
        pulley = WrappingPulley{
            pointOf(mounted->body, mounted->pulley.center_mm), mounted->pulley.axis, mounted->pulley.radius_mm / mm_per_m, {}};
        if (mounted->pulley.side_mm) pulley->side_m = *mounted->pulley.side_mm / mm_per_m;
      }
    }
    result_.muscles.push_back(std::move(muscle));
  }

  /// The second of two balls between the same bodies becomes part of the first; it keeps its place in the list, without bodies.
  void mergeBalls() {
    for (auto a = result_.joints.begin(); a != result_.joints.end(); ++a)
      for (auto b = a + 1; b != result_.joints.end(); ++b) {
        if (a->kind != Joint::Kind::ball || b->kind != Joint::Kind::ball) continue;
        if (std::minmax(a->first, a->second) != std::minmax(b->first, b->second)) continue;
        a->kind = Joint::Kind::hinge;
        a->axes = {JointAxis{.direction = (b->anchor_m - a->anchor_m).normalized()}};
        b->first = b->second = environment;
      }
  }

  World& world_;
  Mechanism result_;
  std::map<dBodyID, int> bodies_;
  std::map<const Joint*, int> joints_;
};

}  // namespace

Vector Mechanism::inWorld(const BodyPoint& point) const {
  if (point.body == environment) return point.place_m;
  const RigidBody& body = bodies[static_cast<std::size_t>(point.body)];
  return body.position_m + body.rotation * point.place_m;
}

Mechanism mechanismOf(Simulation& simulation) {
  return Reader(simulation).result();
}

}  // namespace musclesim::peers
