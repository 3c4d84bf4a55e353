#include "file_robot.h"

#include <fmt/format.h>
#include <muParser.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "../joint_limits.h"
#include "../springs.h"
#include "../vector_checks.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/force_law_choice.h"
#include "musclesim/robot/linear_actuator.h"
#include "musclesim/robot/muscle.h"

namespace musclesim::description {

namespace {

/// A linear actuator whose tension is an expression over p, l_mm and the file's parameters.
class ExpressionActuator final : public LinearActuator {
 public:
  ExpressionActuator(World& world, dSpaceID space, const Vector& start, const Vector& end, const std::array<double, 2>& length_mm,
                     const Quantity& force_N, const Expressions& names)
      : LinearActuator(world, space, start, end, length_mm[0], length_mm[1]), place_(force_N.place) {
    parser_.EnableOptimizer(false);  // it rearranges sums, which changes the last digits
    try {
      parser_.DefineConst("pi", std::numbers::pi);
      for (const auto& [name, number] : names.names()) parser_.DefineConst(name, number);
      parser_.DefineVar("p", &pressure_);
      parser_.DefineVar("l_mm", &length_mm_);
      parser_.SetExpr(force_N.expression);
      int value_count = 0;
      parser_.Eval(value_count);
      if (value_count != 1) place_.refuse("\"" + force_N.expression + "\" must be one number");
    } catch (const mu::Parser::exception_type& error) {
      place_.refuse("force_N = \"" + force_N.expression + "\": " + problemOf(error, names.names()) +
                    "; p and l_mm are the pressure and the length");
    }
    ready_ = true;
  }
  double calculateForce(double pressure_ratio, double length_mm) const override {
    if (!ready_) return 0;
    pressure_ = pressure_ratio;
    length_mm_ = length_mm;
    return parser_.Eval();
  }

 private:
  FilePlace place_;
  bool ready_ = false;
  mutable double pressure_ = 0, length_mm_ = 0;
  mu::Parser parser_;
};

/// Turns complaints of what is built into complaints about the entry that asked for it.
template <class Build>
auto at(const FilePlace& place, const Build& build) {
  try {
    return build();
  } catch (const BadParameter& problem) {
    place.refuse(problem.what());
  }
}

constexpr double marker_radius_mm = 1;  ///< of the sphere that stands for a body without a shape; it is not drawn

}  // namespace

FileRobot::FileRobot(World& world, std::shared_ptr<const Description> description)
    : Robot(world), description_(std::move(description)), value_(declareParameters()) {
  for (const BodyEntry& body : description_->bodies) at(body.place, [&] { buildBody(body); });
  // Composites first: a body with a joint cannot become part of another.
  const auto buildJoints = [&](bool of_two_bodies) {
    for (const JointEntry& joint : description_->joints)
      if ((joint.type == "fixed" && joint.to != "world") == of_two_bodies) at(joint.place, [&] { buildJoint(joint); });
  };
  buildJoints(true);
  for (const BodyEntry& body : description_->bodies)
    if (body.fixed) at(body.place, [&] { bodies_.at(body.name)->fix(); });
  buildJoints(false);
  for (const PulleyEntry& pulley : description_->pulleys)
    if (const double radius_mm = value_(pulley.radius_mm); !(radius_mm > 0))
      pulley.radius_mm.place.refuse(fmt::format("{} must be positive", radius_mm));
  for (const MuscleEntry& muscle : description_->muscles) addActuator(at(muscle.place, [&] { return buildMuscle(muscle); }));
  for (const MuscleEntry& entry : description_->actuators) {
    Actuator* actuator = at(entry.place, [&] { return buildActuator(entry); });
    if (entry.commanded) addActuator(actuator);
  }
  for (const SpringEntry& spring : description_->springs) at(spring.place, [&] { buildSpring(spring); });
  if (description_->hand) at(description_->hand->place, [&] { buildHand(*description_->hand); });
  for (const WallEntry& wall : description_->walls) at(wall.place, [&] { buildWall(wall); });
}

std::map<std::string, double> FileRobot::parameterTolerances() const {
  std::map<std::string, double> tolerances;
  for (const ToleranceEntry& entry : description_->tolerances) tolerances[entry.name] = entry.tolerance;
  return tolerances;
}

void FileRobot::requireTolerances() const {
  for (const ToleranceEntry& entry : description_->tolerances) at(entry.place, [&] { requireTolerance(entry.name); });
}

Expressions FileRobot::declareParameters() const {
  std::map<std::string, double> values;
  for (const ParameterEntry& p : description_->parameters)
    values[p.name] = parameter(description_->name + "." + p.name, p.value, p.unit, p.minimum, p.maximum, p.meaning);
  return Expressions(std::move(values));
}

Primitive* FileRobot::find(const std::string& name) const {
  const auto found = bodies_.find(name);
  return found == bodies_.end() ? nullptr : found->second;
}

Primitive* FileRobot::buildPart(const Part& part, bool massless, bool collides) const {
  const Vector center_mm = value_(part.at_mm);
  // A part without a mass of its own gets one until the mass of the whole is set.
  const double mass_g = part.mass_g ? value_(*part.mass_g) : massless ? 1 : 0;
  const double density = part.density_g_per_mm3 ? value_(*part.density_g_per_mm3) : 0;
  const dSpaceID touching = collides && part.type != "none" ? space() : nullptr;
  Primitive* made = nullptr;
  const auto size = [&](const Quantity& quantity) {
    const double number = value_(quantity);
    if (!(number > 0)) quantity.place.refuse(fmt::format("{} must be positive", number));
    return number;
  };
  if (part.mass_g) size(*part.mass_g);
  if (part.type == "box") {
    const Vector edges_mm(size(part.size_mm[0]), size(part.size_mm[1]), size(part.size_mm[2]));
    made = new Box(world(), touching, center_mm, mass_g, density, edges_mm.x(), edges_mm.y(), edges_mm.z());
  } else if (part.type == "capsule") {
    made = new CappedCylinder(world(), touching, center_mm, mass_g, density, size(part.radius_mm), size(part.length_mm));
  } else if (part.type == "cylinder") {
    made = new Cylinder(world(), touching, center_mm, mass_g, density, size(part.radius_mm), size(part.length_mm));
  } else {
    const double radius_mm = part.type == "sphere" ? size(part.radius_mm) : marker_radius_mm;
    made = new Sphere(world(), touching, center_mm, mass_g, density, radius_mm);
    if (part.type == "none") made->setVisible(false);
  }
  if (part.color) {
    const Vector color = value_(*part.color);
    at(part.color->front().place, [&] { made->setColor(color.x(), color.y(), color.z()); });
  }
  return made;
}

void FileRobot::buildBody(const BodyEntry& entry) {
  const bool whole = !entry.inertia_g_mm2.empty();
  std::vector<Primitive*> parts;
  for (const Part& part : entry.parts) {
    parts.push_back(at(part.place, [&] { return buildPart(part, whole, entry.collides); }));
    parts.back()->setName(parts.size() == 1 ? entry.name : part.name.empty() ? fmt::format("{}.{}", entry.name, parts.size()) : part.name);
    for (const auto& [angle_deg, axis] : part.turns) parts.back()->rotate(value_(angle_deg), value_(axis));
  }
  const auto named = [&](const Primitive* part) { return part->name() == entry.axes_of; };
  const auto axes_of = std::ranges::find_if(parts, named);
  if (parts.size() > 1) Primitive::compositePrimitives(parts, axes_of == parts.end() ? parts.front() : *axes_of);
  if (whole) setMassProperties(entry, *parts.front());
  for (const auto& [angle_deg, axis] : entry.whole_turns) parts.front()->rotate(value_(angle_deg), value_(axis));
  bodies_[entry.name] = parts.front();
}

void FileRobot::setMassProperties(const BodyEntry& entry, Primitive& body) const {
  std::vector<double> moments;
  for (const Quantity& quantity : entry.inertia_g_mm2) moments.push_back(value_(quantity));
  moments.resize(6, 0);
  Eigen::Matrix3d inertia;
  inertia << moments[0], moments[3], moments[4], moments[3], moments[1], moments[5], moments[4], moments[5], moments[2];
  const double mass_g = value_(entry.parts.front().mass_g.value());
  const Vector center_mm = entry.center_of_mass_mm ? value_(*entry.center_of_mass_mm) : value_(entry.parts.front().at_mm);
  body.setMassProperties(mass_g, center_mm, inertia);
}

Joint* FileRobot::attach(const JointEntry& entry, Primitive& body, Primitive* other) const {
  const auto limits = [&](const std::optional<std::array<Quantity, 2>>& pair) {
    const std::array<double, 2> values = value_(pair.value());
    const Limits limits_deg{values[0], values[1]};
    const bool middle = entry.type == "ball" && &pair == &entry.limits2;
    at(pair->front().place,
       [&] { requireLimits("joint " + entry.name, limits_deg, middle ? farthest_middle_stop_deg : farthest_stop_deg); });
    return limits_deg;
  };
  const auto direction = [&](const std::optional<QuantityVector>& axis) {
    const Vector vector = value_(axis.value());
    at(axis->front().place, [&] { requireDirection("axis of joint " + entry.name, vector); });
    return vector;
  };
  if (entry.type == "slider") {
    Joint* slider = body.attachSlider(other, direction(entry.axis));
    if (entry.limits) slider->setSliderStopsMm(value_(*entry.limits)[0], value_(*entry.limits)[1]);
    return slider;
  }
  const Vector anchor_mm = value_(entry.at_mm);
  if (entry.type == "ball" && entry.axis)
    return body.attachBall(other, anchor_mm, direction(entry.axis), direction(entry.axis3), limits(entry.limits), limits(entry.limits2),
                           limits(entry.limits3));
  if (entry.type == "ball") return body.attachBall(other, anchor_mm);
  const Vector axis = direction(entry.axis);
  if (entry.type == "hinge" && entry.limits)
    return body.attachHinge(other, anchor_mm, axis, limits(entry.limits).low_deg, limits(entry.limits).high_deg);
  if (entry.type == "hinge") return body.attachHinge(other, anchor_mm, axis);
  if (entry.type == "universal1" && entry.limits)
    return body.attachUniversal(other, anchor_mm, axis, limits(entry.limits).low_deg, limits(entry.limits).high_deg);
  if (entry.type == "universal1") return body.attachUniversal(other, anchor_mm, axis);
  const Vector axis2 = direction(entry.axis2);
  if (entry.type == "hinge2")
    return entry.limits ? body.attachHinge(other, anchor_mm, axis, axis2, limits(entry.limits), limits(entry.limits2))
                        : body.attachHinge(other, anchor_mm, axis, axis2);
  return entry.limits ? body.attachUniversal(other, anchor_mm, axis, axis2, limits(entry.limits), limits(entry.limits2))
                      : body.attachUniversal(other, anchor_mm, axis, axis2);
}

void FileRobot::buildJoint(const JointEntry& entry) {
  Primitive &body = *bodies_.at(entry.body), *other = find(entry.to);
  if (entry.type == "fixed") return other ? other->compositeWithPrimitive(&body) : body.fix();
  Joint* joint = attach(entry, body, other);
  joint->setName(entry.name);
  joints_[entry.name] = joint;
  if (entry.type == "slider") addSlide(entry.name, joint);
  if (entry.report && (entry.type == "hinge2" || entry.type == "universal")) {
    addAngle(entry.name + "_1", joint, 0);
    addAngle(entry.name + "_2", joint, 1);
  } else if (entry.report) {
    addAngle(entry.name, joint);
  }
  addMechanics(entry, *joint);
}

void FileRobot::addMechanics(const JointEntry& entry, Joint& joint) const {
  const auto valueOf = [&](const std::optional<Quantity>& quantity) {
    const double number = quantity ? value_(*quantity) : 0;
    if (number < 0) quantity->place.refuse(fmt::format("{} must not be negative", number));
    return number;
  };
  const JointMechanics mechanics{.friction = valueOf(entry.friction),
                                 .damping = valueOf(entry.damping),
                                 .stiffness = valueOf(entry.stiffness),
                                 .rest = entry.rest ? value_(*entry.rest) : 0};
  addJointMechanics(world(), joint, mechanics);
}

/// From the joint of the body on which the muscle pulls to the straight line between the muscle's ends, perpendicular to it.
Vector FileRobot::leverOf(const MuscleEntry& entry, const End& end) const {
  if (end.lever) return value_(*end.lever);
  const Vector start_mm = value_(entry.from.at_mm), along = (value_(entry.to.at_mm) - start_mm).normalized();
  for (const std::string& body : {entry.to.body, entry.from.body})
    for (const JointEntry& joint : description_->joints) {
      if (joint.body != body || joint.type == "slider" || joint.type == "fixed") continue;
      const Vector from_joint = start_mm - value_(joint.at_mm), lever = from_joint - along.dot(from_joint) * along;
      if (lever.norm() > 0) return lever;
    }
  return along.unitOrthogonal();
}

std::unique_ptr<ForceLaw> FileRobot::forceLaw(const MuscleEntry& entry, double shortest_mm, double longest_mm) const {
  const double rest_mm = entry.rest_length_mm ? value_(*entry.rest_length_mm) : longest_mm;
  if (!entry.force_law) return entry.rest_length_mm ? makeForceLaw(world().parameters(), shortest_mm, rest_mm) : nullptr;
  return at(entry.force_law->place, [&] {
    Parameters own;
    own.set("force_law.name", entry.force_law->name, "name");
    for (const auto& [name, quantity] : entry.force_law->parameters) own.set("force_law." + name, value_(quantity), name);
    auto law = makeForceLaw(own, shortest_mm, rest_mm);
    own.requireAllKnown();
    return law;
  });
}

Actuator* FileRobot::buildMuscle(const MuscleEntry& entry) {
  const std::array<double, 2> length_mm = value_(entry.length_mm);
  const Vector given_end_mm = value_(entry.to.at_mm), given_start_mm = value_(entry.from.at_mm);
  const Vector end_mm = entry.to.may_be_off ? mountedEnd(given_end_mm, leverOf(entry, entry.to)) : given_end_mm;
  const Vector start_mm = entry.from.may_be_off ? mountedStart(given_start_mm, leverOf(entry, entry.from)) : given_start_mm;
  Vector control_mm[2] = {start_mm + (end_mm - start_mm) / 3, start_mm + (end_mm - start_mm) * 2 / 3};
  for (std::size_t i = 0; i < entry.control_mm.size(); ++i) control_mm[i] = value_(entry.control_mm[i]);
  const MuscleModel model = entry.model == "chain"  ? MuscleModel::chain
                            : entry.model == "line" ? MuscleModel::line
                                                    : MuscleModel::by_parameter;
  auto* muscle = at(entry.length_mm[0].place, [&] {
    return new Muscle(world(), space(), start_mm, control_mm[0], control_mm[1], end_mm, length_mm[0], length_mm[1], model);
  });
  finish(entry, *muscle);
  buildPath(entry, *muscle);
  return muscle;
}

void FileRobot::buildPath(const MuscleEntry& entry, Actuator& muscle) const {
  for (const PathPoint& point : entry.path)
    at(point.place, [&] {
      if (point.pulley.empty()) return muscle.addViaPoint(find(point.body), value_(*point.at_mm));
      const auto pulley = std::ranges::find(description_->pulleys, point.pulley, &PulleyEntry::name);
      const Vector axis = pulley->axis ? value_(*pulley->axis) : Vector::Zero();
      const auto side_mm = point.side_mm ? std::optional(value_(*point.side_mm)) : std::nullopt;
      muscle.addPulley(find(pulley->body), value_(pulley->at_mm), axis, value_(pulley->radius_mm), side_mm);
    });
  if (entry.tendon_mm) muscle.setTendonMm(value_(*entry.tendon_mm));
  at(entry.length_mm[0].place, [&] { muscle.finishPath(); });
}

Actuator* FileRobot::buildActuator(const MuscleEntry& entry) {
  const auto [shortest_mm, longest_mm] = value_(entry.length_mm);
  const Vector start_mm = value_(entry.from.at_mm), end_mm = value_(entry.to.at_mm);
  LinearActuator* actuator = nullptr;
  if (entry.force_N.empty())
    actuator = new LinearActuator(world(), space(), start_mm, end_mm, shortest_mm, longest_mm);
  else
    actuator =
        new ExpressionActuator(world(), space(), start_mm, end_mm, {shortest_mm, longest_mm}, {0, entry.force_N, entry.place}, value_);
  finish(entry, *actuator);
  return actuator;
}

void FileRobot::finish(const MuscleEntry& entry, Actuator& actuator) {
  actuator.setName(entry.name);
  if (auto law = forceLaw(entry, actuator.minimumLengthMm(), actuator.maximumLengthMm())) actuator.setForceLaw(std::move(law));
  if (entry.color) {
    const Vector color = value_(*entry.color);
    actuator.setColor(color.x(), color.y(), color.z(), entry.color_name);
  }
  actuator.connectStartTo(find(entry.from.body));
  actuator.connectEndTo(find(entry.to.body));
}

void FileRobot::buildSpring(const SpringEntry& entry) const {
  world().addForceElement(std::make_unique<PointSpring>(
      world(), Attachment{find(entry.from.body), value_(entry.from.at_mm)}, Attachment{find(entry.to.body), value_(entry.to.at_mm)},
      PointSpringSettings{.stiffness_N_per_mm = value_(entry.stiffness_N_per_mm),
                          .rest_mm = value_(entry.rest_mm),
                          .damping_Ns_per_m = entry.damping_Ns_per_m ? value_(*entry.damping_Ns_per_m) : 0,
                          .pulls_only = entry.pulls_only}));
}

void FileRobot::buildHand(const HandEntry& entry) {
  Primitive* body = bodies_.at(entry.body);
  const Vector offset_mm =
      entry.at_mm ? Vector(body->getRotation().transpose() * (value_(*entry.at_mm) - body->getPosition())) : Vector::Zero();
  entry.report ? setHand(body, offset_mm) : setLoad(body, offset_mm);
}

void FileRobot::buildWall(const WallEntry& entry) const {
  const bool stops_hand = entry.body.empty() || (description_->hand && description_->hand->body == entry.body);
  Primitive* body = stops_hand ? bodies_.at(description_->hand->body) : bodies_.at(entry.body);
  const Vector point_mm = stops_hand ? handMm() : body->getPosition();
  world().addForceElement(std::make_unique<Wall>(world(), Attachment{body, point_mm}, value_(entry.at_mm), value_(entry.normal),
                                                 value_(entry.stiffness_N_per_mm)));
}

}  // namespace musclesim::description
