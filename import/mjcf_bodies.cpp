#include "mjcf_bodies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "musclesim/base/text.h"

namespace musclesim {

namespace {

const std::set<std::string>& placeAttributes() {
  static const std::set<std::string> names = {"name", "class", "pos", "quat", "axisangle", "xyaxes", "zaxis", "euler"};
  return names;
}

class BodyReader {
 public:
  BodyReader(const MjcfDocument& document, MjcfModel& model)
      : document_(document), compiler_(document.compiler()), model_(model), robot_(model.robot) {}

  void read() {
    for (const XmlElement* world : childrenOf(document_.root(), "worldbody")) readContents(*world, 0, textOf(*world, "childclass"));
    finishMasses();
    noteAttributes("body", {"childclass"});
    noteAttributes("joint", {"type", "axis", "range", "limited", "damping", "frictionloss", "stiffness", "springref", "ref", "armature"});
    noteAttributes("geom", {"type", "size", "fromto", "mass", "density", "rgba", "contype", "conaffinity", "group", "mesh"});
    noteAttributes("inertial", {"mass", "diaginertia", "fullinertia"});
    noteAttributes("site", {"type", "size", "rgba", "group", "fromto"});  // how a site is drawn
  }

 private:
  void note(const std::string& text) { robot_.notes.push_back(text); }

  void noteAttributes(const std::string& kind, std::set<std::string> known) {
    known.insert(placeAttributes().begin(), placeAttributes().end());
    if (const auto others = document_.otherAttributes("worldbody", kind, known); !others.empty())
      note(fmt::format("<{}>: {} not taken over", kind, fmt::join(others, ", ")));
  }

  /// The pose of an element in the frame of its body. With global coordinates the file has poses in the world.
  Pose poseOf(const MjcfElement& element, const Pose& frame) const {
    Pose pose = Pose::Identity();
    pose.translation() = element.vector("pos", Eigen::Vector3d::Zero());
    if (const auto rotation = element.rotation()) pose.linear() = *rotation;
    return compiler_.global ? frame.inverse() * pose : pose;
  }

  /// The contents of a body: elements of its own and bodies that hang on it.
  void readContents(const XmlElement& xml, std::size_t body, const std::string& childclass) {
    std::vector<SourceJoint> joints;
    std::vector<double> armatures;
    std::optional<MassProperties> inertial;
    MassProperties of_geoms;
    for (const XmlElement* child : childrenOf(xml)) {
      const std::string kind = child->Name();
      if (kind == "inertial") {
        inertial = readInertial(document_.with(*child, kind), robot_.bodies[body].pose);
      } else if (kind == "joint" || kind == "freejoint") {
        readJoint(document_.with(*child, "joint", childclass), kind == "freejoint", body, joints, armatures);
      } else if (kind == "geom") {
        readGeom(document_.with(*child, kind, childclass), body, of_geoms);
      } else if (kind == "site") {
        readSite(document_.with(*child, kind, childclass), body);
      } else if (kind == "frame" || kind == "replicate" || kind == "composite" || kind == "attach" || kind == "flexcomp") {
        refuse(*child, document_.file(), "cannot be taken over, and bodies may depend on it");
      } else if (kind != "body") {
        const std::string name = textOf(*child, "name");
        note(fmt::format("<{}>{} in line {} is not taken over", kind, name.empty() ? "" : " " + name, child->GetLineNum()));
      }
    }
    if (body != 0) setMass(xml, body, inertial, of_geoms);
    if (body != 0) hold(body, joints, armatures);
    for (const XmlElement* child : childrenOf(xml, "body")) readBody(*child, body, childclass);
  }

  void readBody(const XmlElement& xml, std::size_t parent, const std::string& childclass) {
    const MjcfElement element = document_.with(xml, "body", childclass);
    const std::string own_class = element.text("childclass", childclass);
    const Pose parent_pose = robot_.bodies[parent].pose;
    SourceBody body;
    body.name = nameOf(xml);
    body.pose = parent_pose * poseOf(element, parent_pose);
    if (element.text("mocap") == "true") note(fmt::format("body {}: mocap is not taken over; it stays where it is", body.name));
    const std::size_t index = robot_.bodies.size();
    robot_.bodies.push_back(body);
    model_.bodies.emplace(body.name, index);
    parents_.resize(index + 1);
    parents_[index] = parent;
    constexpr std::size_t most_bodies = 1000;
    if (index > most_bodies) element.refuse(fmt::format("the file has more than {} bodies", most_bodies));
    readContents(xml, index, own_class);
  }

  /// Bodies without a name have that of their first geom or joint that has one.
  std::string nameOf(const XmlElement& xml) const {
    if (const std::string name = textOf(xml, "name"); !name.empty()) return name;
    for (const char* kind : {"geom", "joint", "freejoint"})
      for (const XmlElement* child : childrenOf(xml, kind))
        if (const std::string name = textOf(*child, "name"); !name.empty()) return name;
    return fmt::format("body_{}", robot_.bodies.size());
  }

  MassProperties readInertial(const MjcfElement& element, const Pose& frame) const {
    MassProperties mass;
    mass.mass_kg = element.number("mass", -1);
    if (!(mass.mass_kg >= 0)) element.refuse("must have a mass that is not negative");
    if (const auto full = element.numbers("fullinertia", 6, 6); !full.empty())
      mass.inertia_kg_m2 << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
    else
      mass.inertia_kg_m2 = element.vector("diaginertia", Eigen::Vector3d::Zero()).asDiagonal();
    return mass.seenFrom(poseOf(element, frame));
  }

  void setMass(const XmlElement& xml, std::size_t body, const std::optional<MassProperties>& inertial, const MassProperties& of_geoms) {
    MassProperties& mass = robot_.bodies[body].mass;
    switch (compiler_.inertia) {
      case MjcfCompiler::Inertia::from_geoms:
        if (inertial)
          note(fmt::format("body {}: inertia from its geoms, as inertiafromgeom says, not from <inertial>", robot_.bodies[body].name));
        mass = of_geoms;
        break;
      case MjcfCompiler::Inertia::from_inertial:
        if (!inertial && !childrenOf(xml, "joint").empty())
          refuse(xml, document_.file(), "must have <inertial>, since inertiafromgeom is false");
        mass = inertial.value_or(MassProperties());
        break;
      case MjcfCompiler::Inertia::automatic:
        mass = inertial.value_or(of_geoms);
        break;
    }
  }

  void readSite(const MjcfElement& element, std::size_t body) {
    const std::string name = element.text("name");
    if (name.empty()) return;  // nothing can refer to it
    Eigen::Vector3d position = poseOf(element, robot_.bodies[body].pose).translation();
    if (const auto ends = element.numbers("fromto", 6, 6); !ends.empty()) {
      position = (Eigen::Vector3d(ends.data()) + Eigen::Vector3d(ends.data() + 3)) / 2;
      if (compiler_.global) position = robot_.bodies[body].pose.inverse() * position;
    }
    if (!model_.sites.emplace(name, SourcePoint{body, position}).second)
      element.refuse(fmt::format("there is another site {}", inQuotes(name)));
  }

  static bool limitsApply(const MjcfElement& element, const MjcfCompiler& compiler) {
    const std::string limited = element.text("limited", "auto");
    if (limited != "true" && limited != "false" && limited != "auto")
      element.refuse(fmt::format("limited = {}: must be true, false or auto", inQuotes(limited)));
    return limited == "true" || (limited == "auto" && compiler.autolimits && element.has("range"));
  }

  void readJoint(const MjcfElement& element, bool free, std::size_t body, std::vector<SourceJoint>& joints,
                 std::vector<double>& armatures) {
    SourceJoint joint;
    joint.name = element.text("name");
    if (joint.name.empty()) joint.name = fmt::format("{}_joint", robot_.bodies[body].name);
    const std::string type = free ? "free" : element.text("type", "hinge");
    if (type == "free") {
      if (parents_[body] != 0) element.refuse("a free joint must belong to a body of the world");
      robot_.bodies[body].free = true;
      return;
    }
    if (type != "hinge" && type != "slide" && type != "ball")
      element.refuse(fmt::format("type = {}: must be hinge, slide, ball or free", inQuotes(type)));
    joint.kind = type == "hinge" ? SourceJoint::Kind::hinge : type == "slide" ? SourceJoint::Kind::slider : SourceJoint::Kind::ball;
    const Pose to_body = compiler_.global ? robot_.bodies[body].pose.inverse() : Pose::Identity();
    joint.anchor_m = to_body * element.vector("pos", Eigen::Vector3d::Zero());
    joint.axis = to_body.linear() * element.vector("axis", Eigen::Vector3d::UnitZ());
    if (joint.axis.norm() == 0) element.refuse("axis: must have a direction");
    joint.axis.normalize();
    readMechanics(element, joint);
    model_.body_of_joint.emplace(joint.name, body);
    joints.push_back(joint);
    armatures.push_back(element.number("armature", 0));
  }

  /// Positions count from `ref`, the position as built.
  void readMechanics(const MjcfElement& element, SourceJoint& joint) {
    const double unit = joint.kind == SourceJoint::Kind::slider ? 1 : compiler_.angle_unit, ref = unit * element.number("ref", 0);
    joint.damping = element.number("damping", 0);
    joint.friction = element.number("frictionloss", 0);
    joint.stiffness = element.number("stiffness", 0);
    joint.rest = unit * element.number("springref", 0) - ref;
    const auto range = element.numbers("range", 2, 2);
    const bool limited = limitsApply(element, compiler_) && !range.empty();
    if (joint.kind == SourceJoint::Kind::ball) {
      if (limited) note(fmt::format("joint {}: its limit of {:g} is not taken over", joint.name, range[1]));
      if (joint.damping != 0 || joint.friction != 0 || joint.stiffness != 0)
        note(fmt::format("joint {}: damping, friction and stiffness of ball joints are not taken over", joint.name));
      joint.damping = joint.friction = joint.stiffness = 0;
      return;
    }
    if (!limited && !range.empty() && element.text("limited") != "false")
      note(fmt::format("joint {}: its range is no limit, since neither limited nor autolimits says so", joint.name));
    if (!limited) return;
    if (range[0] > range[1]) element.refuse(fmt::format("range = {} {}: must be in order", range[0], range[1]));
    joint.limits = SourceRange{unit * range[0] - ref, unit * range[1] - ref};
  }

  /// Rotor inertia is exactly an inertia of the body if its only joint is a hinge at what does not move. Such a body turns about that axis
  /// only, so that every axis may have it, as those of bodies can.
  void hold(std::size_t body, std::vector<SourceJoint>& joints, const std::vector<double>& armatures) {
    SourceBody& held = robot_.bodies[body];
    if (held.free) {
      if (!joints.empty()) refuseBody(body, "has a free joint and others");
      return;
    }
    const std::size_t parent = parents_[body];
    moves_.resize(robot_.bodies.size());
    moves_[body] = moves_[parent] || !joints.empty();
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (armatures[i] == 0) continue;
      if (joints.size() == 1 && joints[0].kind == SourceJoint::Kind::hinge && !moves_[parent] && !robot_.bodies[parent].free)
        held.mass.inertia_kg_m2 += armatures[i] * Eigen::Matrix3d::Identity();
      else
        note(fmt::format("joint {}: its armature {:g} is not taken over", joints[i].name, armatures[i]));
    }
    robot_.join(parent, body, joints);
  }

  [[noreturn]] void refuseBody(std::size_t body, const std::string& what) const {
    throw BadFile(document_.file(), fmt::format("body {}: {}", robot_.bodies[body].name, what));
  }

  void readGeom(const MjcfElement& element, std::size_t body, MassProperties& sum) {
    MjcfGeom geom;
    geom.name = element.text("name");
    geom.body = body;
    const std::string type = element.text("type", element.has("mesh") ? "mesh" : "sphere");
    const std::string label = geom.name.empty() ? fmt::format("geom in line {}", element.xml().GetLineNum()) : "geom " + geom.name;
    if (type == "plane" || type == "hfield") {
      note(fmt::format("{}: a {} is not taken over", label, type == "plane" ? "plane" : "height field"));
      return;
    }
    geom.shape = readShape(element, type, body);
    if (type == "mesh") {
      readMesh(element, label, geom);
    } else {
      geom.has_shape = true;
      if (type == "ellipsoid") note(fmt::format("{}: an ellipsoid, drawn as a box of its half axes", label));
    }
    if (const auto rgba = element.numbers("rgba", 4, 4); !rgba.empty())
      geom.shape.color = {{std::clamp(rgba[0], 0.0, 1.0), std::clamp(rgba[1], 0.0, 1.0), std::clamp(rgba[2], 0.0, 1.0)}};
    const bool touches = element.number("contype", 1) != 0 || element.number("conaffinity", 1) != 0;
    robot_.bodies[body].collides = robot_.bodies[body].collides || touches;
    const int group = static_cast<int>(element.number("group", 0));
    if (group >= compiler_.first_inertia_group && group <= compiler_.last_inertia_group) sum.add(solid(geom.shape, massOf(element, geom)));
    model_.geoms.push_back(geom);
  }

  static double massOf(const MjcfElement& element, const MjcfGeom& geom) {
    constexpr double water_kg_per_m3 = 1000;
    if (!element.has("mass") && !geom.has_shape) return 0;
    const double mass_kg =
        element.has("mass") ? element.number("mass", 0) : element.number("density", water_kg_per_m3) * volumeM3(geom.shape);
    if (!(mass_kg >= 0)) element.refuse(fmt::format("mass = {}: must not be negative", mass_kg));
    return mass_kg;
  }

  /// Without its file a mesh has no volume: it counts as a cube of its mass and density at its place.
  void readMesh(const MjcfElement& element, const std::string& label, MjcfGeom& geom) {
    constexpr double water_kg_per_m3 = 1000;
    const double density = element.number("density", water_kg_per_m3), mass_kg = element.number("mass", 0);
    geom.shape.kind = SourceShape::Kind::box;
    geom.shape.size_m.setConstant(mass_kg > 0 && density > 0 ? std::cbrt(mass_kg / density) : 0);
    geom.has_shape = mass_kg > 0;
    note(fmt::format("{}: the mesh {} is not taken over; it {}", label, element.text("mesh"),
                     mass_kg > 0 ? "counts as a cube of its mass at its place" : "has no mass of its own and counts for nothing"));
  }

  /// Half lengths of MuJoCo become lengths. Two ends replace the pose.
  SourceShape readShape(const MjcfElement& element, const std::string& type, std::size_t body) const {
    SourceShape shape;
    shape.pose = poseOf(element, robot_.bodies[body].pose);
    if (type == "mesh") return shape;
    const std::set<std::string> types = {"sphere", "capsule", "ellipsoid", "cylinder", "box"};
    if (!types.contains(type))
      element.refuse(fmt::format("type = {}: must be plane, hfield, sphere, capsule, ellipsoid, cylinder, box or mesh", inQuotes(type)));
    auto size = element.numbers("size", 0, 3);
    size.resize(3, 0);
    const auto ends = element.numbers("fromto", 6, 6);
    const bool round = type == "capsule" || type == "cylinder";
    if (!ends.empty()) {
      if (type == "sphere") element.refuse("a sphere has no fromto");
      const double half_m = placeBetween(element, Eigen::Vector3d(ends.data()), Eigen::Vector3d(ends.data() + 3), body, shape.pose);
      if (round) size[1] = half_m;
      if (!round) size[1] = size[0], size[2] = half_m;  // across they are square or round
    }
    const std::size_t needed = type == "sphere" ? 1 : round ? 2 : 3;
    for (std::size_t i = 0; i < needed; ++i)
      if (!(size[i] > 0)) element.refuse(fmt::format("size: must be {} positive numbers", needed));
    if (type == "sphere") {
      shape.size_m = {size[0], 0, 0};
    } else if (round) {
      shape.kind = type == "capsule" ? SourceShape::Kind::capsule : SourceShape::Kind::cylinder;
      shape.size_m = {size[0], 2 * size[1], 0};
    } else {
      shape.kind = type == "box" ? SourceShape::Kind::box : SourceShape::Kind::ellipsoid;
      shape.size_m = (type == "box" ? 2 : 1) * Eigen::Vector3d(size.data());
    }
    return shape;
  }

  /// Puts a shape between two points with its z axis from the second to the first; half their distance.
  double placeBetween(const MjcfElement& element, const Eigen::Vector3d& from, const Eigen::Vector3d& to, std::size_t body,
                      Pose& pose) const {
    const Eigen::Vector3d along = from - to;
    if (along.norm() == 0) element.refuse("fromto: must be two different points");
    Pose between = Pose::Identity();
    between.linear() = turnOfZAxis(along);
    between.translation() = (from + to) / 2;
    pose = compiler_.global ? robot_.bodies[body].pose.inverse() * between : between;
    return along.norm() / 2;
  }

  /// boundmass, boundinertia, balanceinertia and settotalmass of the compiler.
  void finishMasses() {
    double total_kg = 0;
    for (std::size_t body = 1; body < robot_.bodies.size(); ++body) {
      MassProperties& mass = robot_.bodies[body].mass;
      const auto [moments, axes] = principalInertia(mass.inertia_kg_m2);
      mass.mass_kg = std::max(mass.mass_kg, compiler_.least_mass_kg);
      Eigen::Vector3d changed = moments.cwiseMax(compiler_.least_inertia_kg_m2);
      if (compiler_.balance_inertia && changed(2) > changed(0) + changed(1)) changed.setConstant(changed.mean());
      if (changed != moments) mass.inertia_kg_m2 = axes * changed.asDiagonal() * axes.transpose();
      total_kg += mass.mass_kg;
    }
    if (!compiler_.total_mass_kg || !(total_kg > 0)) return;
    for (SourceBody& body : robot_.bodies) body.mass = body.mass.scaled(*compiler_.total_mass_kg / total_kg);
  }

  const MjcfDocument& document_;
  const MjcfCompiler& compiler_;
  MjcfModel& model_;
  SourceRobot& robot_;
  std::vector<std::size_t> parents_{0};
  std::vector<bool> moves_{false};  ///< against the world
};

}  // namespace

void readMjcfBodies(const MjcfDocument& document, MjcfModel& model) {
  BodyReader(document, model).read();
}

void drawGeoms(MjcfModel& model) {
  for (const MjcfGeom& geom : model.geoms)
    if (geom.has_shape && !geom.is_pulley) model.robot.bodies[geom.body].shapes.push_back(geom.shape);
  SourceBody& world = model.robot.bodies[0];
  if (world.shapes.empty()) return;
  SourceBody surroundings{.name = "surroundings", .collides = world.collides, .fixed = true};
  std::swap(surroundings.shapes, world.shapes);
  model.robot.bodies.push_back(std::move(surroundings));
}

}  // namespace musclesim
