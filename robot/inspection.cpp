#include "inspection.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "../log/diagram.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/line_of_pull.h"
#include "ode_vector.h"
#include "skeleton.h"
#include "springs.h"

namespace musclesim {

namespace {

constexpr double free_range_deg = 90;    ///< shown of a joint without stops
constexpr double free_range_mm = 0;      ///< looked at of a slide without stops: a load that hangs freely goes where it can
constexpr int angle_count = 37;          ///< 5 degrees apart over a half turn
constexpr double difference_rad = 1e-4;  ///< of lengths for moment arms: far above rounding, far below the curvature of any lever
constexpr double difference_mm = 1e-2;   ///< the same of a slide

const char* nameOf(Joint::Kind kind) {
  static const std::map<Joint::Kind, const char*> names = {{Joint::Kind::ball, "ball"},     {Joint::Kind::hinge, "hinge"},
                                                           {Joint::Kind::hinge2, "hinge2"}, {Joint::Kind::universal, "universal"},
                                                           {Joint::Kind::slider, "slider"}, {Joint::Kind::fixed, "fixed"}};
  return names.at(kind);
}

/// Where a chain ends, in the world; for the present poses of the bodies.
Vector endOf(const Joint* joint) {
  const dBodyID body = dJointGetBody(joint->id(), 1);
  const Vector& place = joint->reference().anchor[1];
  return body ? Vector(positionOf(body) + rotationOf(body) * place) : place;
}

/// Length of a muscle in the present pose of the bodies, whose chain need not have followed.
double lengthMm(const Actuator& actuator) {
  if (actuator.line()) return actuator.lengthMm();
  if (!actuator.startJoint() || !actuator.endJoint()) return std::nan("");
  return (endOf(actuator.endJoint()) - endOf(actuator.startJoint())).norm();
}

/// A body, the joint that holds it and what hangs on it.
class Tree {
 public:
  Tree(const World& world, const Robot& robot) : world_(world), robot_(robot) {}

  std::string text() {
    std::string out = robot_.name() + "\n";
    addHeldBy(nullptr, "  ", out);
    for (const auto& body : world_.bodies())
      if (std::ranges::find(shown_, body->id) == shown_.end()) addBody(*body, "free", "  ", out);
    for (const Actuator* actuator : world_.actuators()) addMuscle(*actuator, out);
    for (const auto& element : world_.forceElements())
      if (const auto* spring = dynamic_cast<const PointSpring*>(element.get())) addSpring(*spring, out);
    return out;
  }

 private:
  void addHeldBy(dBodyID holder, const std::string& indent, std::string& out) {
    for (const auto& joint : world_.joints()) {
      const dBodyID first = dJointGetBody(joint->id(), 0), second = dJointGetBody(joint->id(), 1);
      const dBodyID held = second == holder ? first : first == holder ? second : nullptr;
      const Body* body = bodyOf(held);
      if (!body || std::ranges::find(shown_, held) != shown_.end()) continue;
      addBody(*body, jointText(*joint), indent, out);
    }
  }

  const Body* bodyOf(dBodyID id) const {
    const auto found = std::ranges::find_if(world_.bodies(), [id](const auto& body) { return body->id == id; });
    return id && found != world_.bodies().end() ? found->get() : nullptr;
  }

  static std::string jointText(const Joint& joint) {
    std::string text = fmt::format("{} {}", nameOf(joint.kind()), joint.name());
    if (joint.kind() != Joint::Kind::hinge && joint.kind() != Joint::Kind::universal) return text;
    const auto [low, high] = joint.stopsDeg();
    return std::isfinite(low) ? text + fmt::format(", {:.4g} .. {:.4g} deg", low, high) : text;
  }

  void addBody(const Body& body, const std::string& held_by, const std::string& indent, std::string& out) {
    shown_.push_back(body.id);
    dMass mass;
    dBodyGetMass(body.id, &mass);
    const Vector center = positionOf(body.id);
    const Vector moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrixFromOde(mass.I)).eigenvalues();
    out += fmt::format(
        "{}{} ({})\n{}    {:.4g} g, centre of mass {:.4g}, {:.4g}, {:.4g} mm, moments of inertia {:.4g}, {:.4g}, {:.4g} g mm^2\n", indent,
        body.parts.empty() ? "body" : body.parts.front()->name(), held_by, indent, mass.mass, center.x(), center.y(), center.z(),
        moments[0], moments[1], moments[2]);
    addHeldBy(body.id, indent + "  ", out);
  }

  static void addMuscle(const Actuator& actuator, std::string& out) {
    out += fmt::format("  {} ({}): {:.4g} mm as built, {:.4g} .. {:.4g} mm; {:.4g} N at full pressure as built, friction {:.4g} N{}\n",
                       actuator.name(), actuator.line() ? "line" : fmt::format("chain of {} links", actuator.links().size()),
                       actuator.lengthMm(), actuator.minimumLengthMm(), actuator.maximumLengthMm(),
                       actuator.calculateForce(1, actuator.lengthMm()), actuator.settings().slider_friction_N,
                       actuator.line() ? "" : " in each link");
  }

  static void addSpring(const PointSpring& spring, std::string& out) {
    const PointSpringSettings& settings = spring.settings();
    const double length_mm = spring.lengthMm(), force_N = settings.stiffness_N_per_mm * (length_mm - settings.rest_mm);
    out += fmt::format("  spring: {:.4g} mm as built, {:.4g} mm at rest, {:.4g} N/mm: {:.4g} N as built\n", length_mm, settings.rest_mm,
                       settings.stiffness_N_per_mm, settings.pulls_only ? std::max(0.0, force_N) : force_N);
  }

  const World& world_;
  const Robot& robot_;
  std::vector<dBodyID> shown_;
};

/// Joints that hold one body against the other and so let them touch or overlap.
bool areJoined(const World& world, dBodyID a, dBodyID b) {
  return std::ranges::any_of(world.joints(), [&](const auto& joint) {
    const dBodyID first = dJointGetBody(joint->id(), 0), second = dJointGetBody(joint->id(), 1);
    return (first == a && second == b) || (first == b && second == a);
  });
}

void findOverlaps(const World& world, std::vector<std::string>& found) {
  const auto& parts = world.primitives();
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size(); ++j) {
      const Primitive &a = *parts[i], &b = *parts[j];
      const bool touch = dGeomGetSpace(a.geom()) && dGeomGetSpace(b.geom());
      if (!touch || &a.body() == &b.body() || areJoined(world, a.body().id, b.body().id)) continue;
      dContactGeom contact;
      if (dCollide(a.geom(), b.geom(), 1, &contact, sizeof contact) > 0)
        found.push_back(
            fmt::format("{} and {} overlap by {:.3g} mm as built and will push each other apart", a.name(), b.name(), contact.depth));
    }
}

void findLooseEnds(const Robot& robot, std::vector<std::string>& found) {
  for (const Actuator* muscle : robot.actuators()) {
    if (muscle->line()) continue;
    for (const auto& [joint, end] : {std::pair{muscle->startJoint(), "start"}, std::pair{muscle->endJoint(), "end"}})
      if (!joint) found.push_back(fmt::format("{} is connected to nothing at its {}", muscle->name(), end));
  }
}

/// Bodies whose moment of inertia needs mass far outside of their shapes: likely another unit.
void findInertias(const World& world, std::vector<std::string>& found) {
  constexpr double far_out = 2;  // times as far from the centre of mass as any point of the shapes
  for (const auto& body : world.bodies()) {
    dMass mass;
    dBodyGetMass(body->id, &mass);
    const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrixFromOde(mass.I)).eigenvalues().maxCoeff();
    const double radius_mm = std::sqrt(largest / mass.mass);
    double farthest_mm = 0;
    for (const Primitive* part : body->parts) {
      dReal box[6];  // least and greatest x, y, z
      dGeomGetAABB(part->geom(), box);
      for (int corner = 0; corner < 8; ++corner) {
        const Vector at(box[corner & 1], box[2 + (corner >> 1 & 1)], box[4 + (corner >> 2 & 1)]);
        farthest_mm = std::max(farthest_mm, (at - positionOf(body->id)).norm());
      }
    }
    if (farthest_mm > 0 && radius_mm > far_out * farthest_mm)
      found.push_back(
          fmt::format("{} has the moment of inertia of a mass {:.3g} mm away from its centre (its radius of gyration), but its shape "
                      "ends at {:.3g} mm: are mass and inertia in g and g mm^2?",
                      body->parts.front()->name(), radius_mm, farthest_mm));
  }
}

std::optional<std::size_t> coordinateOf(const Skeleton& skeleton, const Joint& joint, int axis) {
  const auto& all = skeleton.coordinates();
  const auto place = std::ranges::find_if(all, [&](const Coordinate& c) { return c.joint == &joint && c.axis == axis; });
  if (place == all.end()) return std::nullopt;
  return static_cast<std::size_t>(place - all.begin());
}

/// Lengths of all muscles, and how far they pull a coordinate, over its range; all other coordinates stand as built.
MomentArms armsOver(Skeleton& skeleton, const Robot& robot, std::size_t coordinate, const std::string& name) {
  const Coordinate& moved = skeleton.coordinates()[coordinate];
  const double per_unit = moved.turns ? rad_per_deg : 1, difference = moved.turns ? difference_rad : difference_mm;
  const double free_range = moved.turns ? free_range_deg : free_range_mm;
  const double low = std::isfinite(moved.low) ? moved.low / per_unit : -free_range;
  const double high = std::isfinite(moved.high) ? moved.high / per_unit : free_range;
  MomentArms arms{name, moved.turns, {}, {}, {}};
  arms.arm_mm.resize(robot.actuators().size());
  arms.length_mm.resize(robot.actuators().size());
  Eigen::VectorXd q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(skeleton.coordinates().size()));
  const auto lengthAt = [&](std::size_t muscle, double value) {
    q[static_cast<Eigen::Index>(coordinate)] = value;
    skeleton.setPose(q);
    skeleton.placeBodies();
    return lengthMm(*robot.actuators()[muscle]);
  };
  for (int i = 0; i < angle_count; ++i) {
    arms.position.push_back(low + (high - low) * i / (angle_count - 1));
    const double at = arms.position.back() * per_unit;
    for (std::size_t muscle = 0; muscle < arms.arm_mm.size(); ++muscle) {
      const double shorter = lengthAt(muscle, at + difference), longer = lengthAt(muscle, at - difference);
      arms.arm_mm[muscle].push_back((longer - shorter) / (2 * difference));
      arms.length_mm[muscle].push_back(lengthAt(muscle, at));
    }
  }
  return arms;
}

/// The same of the robot's slides with stops, where the arm is the share of the tension that pulls along the slide. Others, such as a load
/// that hangs freely, are looked at in the pose as built alone.
std::vector<MomentArms> slideArms(World& world, const Robot& robot) {
  Skeleton skeleton(world);
  std::vector<MomentArms> all;
  for (const Robot::Slide& slide : robot.slides())
    if (const auto coordinate = coordinateOf(skeleton, *slide.joint, 0)) all.push_back(armsOver(skeleton, robot, *coordinate, slide.name));
  return all;
}

/// Muscles whose force is not that of a muscle, as when a length was given in metres.
void findForces(const Robot& robot, std::vector<std::string>& found) {
  constexpr double largest_N = 2e4;  // a muscle of 40 mm diameter pulls with 6 kN at most (Festo DMSP-40)
  for (const Actuator* actuator : robot.actuators())
    if (const double pull_N = actuator->calculateForce(1, actuator->lengthMm()); pull_N > largest_N)
      found.push_back(
          fmt::format("{} pulls with {:.3g} N at full pressure as built: are its lengths in mm, the numbers of its force law right?",
                      actuator->name(), pull_N));
}

/// Muscles that the motion of a joint takes out of their range, and joints that no muscle moves.
void findMotions(const std::vector<MomentArms>& arms, const Robot& robot, std::vector<std::string>& found) {
  constexpr double still_mm = 0.01, still_share = 0.02;  // what is below this moves nothing
  for (const MomentArms& joint : arms) {
    // Hinges may stand in a dead centre as built; a muscle across a slide pulls along it only where it stands oblique.
    const auto as_built = std::ranges::min_element(joint.position, {}, [](double position) { return std::abs(position); });
    const auto moves = [&](const std::vector<double>& arm) {
      if (!joint.turns) return std::abs(arm[static_cast<std::size_t>(as_built - joint.position.begin())]) > still_share;
      return std::ranges::any_of(arm, [&](double one) { return std::abs(one) > still_mm; });
    };
    const char* unit = joint.turns ? "deg" : "mm";
    bool moved = false;
    for (std::size_t m = 0; m < joint.arm_mm.size(); ++m) {
      const Actuator& muscle = *robot.actuators()[m];
      moved = moved || moves(joint.arm_mm[m]);
      const auto [shortest, longest] = std::ranges::minmax_element(joint.length_mm[m]);
      const auto positionAt = [&](auto place) { return joint.position[static_cast<std::size_t>(place - joint.length_mm[m].begin())]; };
      if (*shortest < muscle.minimumLengthMm())
        found.push_back(fmt::format("{} would be {:.4g} mm long at {} = {:.3g} {}, shorter than its shortest length, {:.4g} mm",
                                    muscle.name(), *shortest, joint.joint, positionAt(shortest), unit, muscle.minimumLengthMm()));
      if (*longest > muscle.maximumLengthMm())
        found.push_back(
            fmt::format("{} would be {:.4g} mm long at {} = {:.3g} {}, longer than its longest length, {:.4g} mm: it stops the joint",
                        muscle.name(), *longest, joint.joint, positionAt(longest), unit, muscle.maximumLengthMm()));
    }
    if (!moved)
      found.push_back(fmt::format("no muscle moves {}: {}", joint.joint, joint.turns ? "all moment arms are zero" : "none pulls along it"));
  }
}

}  // namespace

std::string describeRobot(const World& world, const Robot& robot) {
  return Tree(world, robot).text();
}

std::vector<MomentArms> momentArms(World& world, const Robot& robot) {
  Skeleton skeleton(world);
  std::vector<MomentArms> all;
  for (const Robot::Angle& angle : robot.angles())
    if (const auto coordinate = coordinateOf(skeleton, *angle.joint, angle.axis))
      all.push_back(armsOver(skeleton, robot, *coordinate, angle.name));
  return all;
}

std::string momentArmFigure(const std::vector<MomentArms>& arms, const Robot& robot) {
  std::vector<Diagram> diagrams;
  for (const MomentArms& joint : arms) {
    Diagram diagram{joint.joint, "angle [deg]", "moment arm [mm]", {}};
    for (std::size_t muscle = 0; muscle < joint.arm_mm.size(); ++muscle)
      diagram.series.push_back(
          {robot.actuators()[muscle]->name(), muscleColor(muscle, robot.namedMuscleColors()), joint.position, joint.arm_mm[muscle]});
    diagrams.push_back(std::move(diagram));
  }
  constexpr int most_columns = 2;
  return diagramsSvg("Moment arms of " + robot.name(), diagrams, std::min(most_columns, static_cast<int>(diagrams.size())));
}

std::vector<std::string> oddities(World& world, const Robot& robot) {
  std::vector<std::string> found;
  if (robot.actuators().empty()) found.emplace_back("there is no muscle: no command can move this robot");
  if (robot.angles().empty() && !robot.getState().hand_mm)
    found.emplace_back("neither an angle nor a hand is reported: recordings hold pressures, forces and lengths only");
  findLooseEnds(robot, found);
  findOverlaps(world, found);
  findInertias(world, found);
  findForces(robot, found);
  try {
    if (robot.actuators().empty()) return found;
    findMotions(momentArms(world, robot), robot, found);
    findMotions(slideArms(world, robot), robot, found);
  } catch (const BadParameter& problem) {
    found.push_back(fmt::format("not checked whether the joints take muscles out of their ranges: {}", problem.what()));
  }
  return found;
}

}  // namespace musclesim
