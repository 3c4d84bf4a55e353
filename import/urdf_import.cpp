/// URDF, as https://wiki.ros.org/urdf/XML describes it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "formats.h"
#include "musclesim/base/text.h"
#include "musclesim/base/units.h"
#include "xml_values.h"

namespace musclesim {

namespace {

class UrdfReader {
 public:
  UrdfReader(const XmlElement& root, const std::string& file) : root_(root) {
    robot_.file = file;
    robot_.format = "URDF";
    robot_.name = textOf(root, "name");
  }

  SourceRobot read() {
    for (const XmlElement* material : childrenOf(root_, "material")) readMaterial(*material);
    for (const XmlElement* link : childrenOf(root_, "link")) readLink(*link);
    if (links_.empty()) refuse(root_, robot_.file, "has no link");
    constexpr std::size_t most_links = 1000;
    if (links_.size() > most_links)
      refuse(root_, robot_.file, fmt::format("has {} links; must have {} at most", links_.size(), most_links));
    for (const XmlElement* joint : childrenOf(root_, "joint")) noteParent(*joint);
    for (const XmlElement* link : childrenOf(root_, "link")) placeLink(textOf(*link, "name"));
    for (const XmlElement* joint : childrenOf(root_, "joint")) readJoint(*joint);
    for (const auto& [name, body] : links_)
      if (!parent_joints_.contains(name)) holdRoot(body);
    noteRest();
    return std::move(robot_);
  }

 private:
  void note(const std::string& text) { robot_.notes.push_back(text); }

  Pose originOf(const XmlElement& element) const {
    const XmlElement* origin = element.FirstChildElement("origin");
    Pose pose = Pose::Identity();
    if (!origin) return pose;
    const Eigen::Vector3d rpy = vectorOf(*origin, "rpy", Eigen::Vector3d::Zero(), robot_.file);
    pose.translation() = vectorOf(*origin, "xyz", Eigen::Vector3d::Zero(), robot_.file);
    pose.linear() = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    return pose;
  }

  std::optional<std::array<double, 3>> readMaterial(const XmlElement& material) {
    const std::string name = textOf(material, "name");
    if (const XmlElement* color = material.FirstChildElement("color")) {
      const auto rgba = numbersIn(textOf(*color, "rgba"), 3, 4, *color, "rgba", robot_.file);
      std::array<double, 3> rgb{};
      for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = std::clamp(rgba[i], 0.0, 1.0);
      colors_[name] = rgb;
    }
    if (material.FirstChildElement("texture")) note(fmt::format("material {}: its texture is not taken over", name));
    const auto found = colors_.find(name);
    return found == colors_.end() ? std::nullopt : std::optional(found->second);
  }

  std::string nameOf(const XmlElement& element) const {
    const std::string name = textOf(element, "name");
    if (name.empty()) refuse(element, robot_.file, "must have a name");
    return name;
  }

  void readLink(const XmlElement& link) {
    SourceBody body;
    body.name = nameOf(link);
    if (!links_.emplace(body.name, robot_.bodies.size()).second)
      refuse(link, robot_.file, fmt::format("there is another link {}", inQuotes(body.name)));
    if (const XmlElement* inertial = link.FirstChildElement("inertial")) body.mass = readInertial(*inertial);
    readShapes(link, body);
    for (const XmlElement* child : childrenOf(link))
      if (const std::string name = child->Name(); name != "inertial" && name != "visual" && name != "collision")
        note(fmt::format("link {}: <{}> is not taken over", body.name, name));
    if (body.name == "world" && body.shapes.empty() && body.mass.mass_kg == 0)
      links_["world"] = 0;
    else
      robot_.bodies.push_back(std::move(body));
  }

  MassProperties readInertial(const XmlElement& inertial) const {
    const XmlElement *mass = inertial.FirstChildElement("mass"), *inertia = inertial.FirstChildElement("inertia");
    MassProperties properties;
    if (!mass) refuse(inertial, robot_.file, "must have a <mass>");
    properties.mass_kg = numberOf(*mass, "value", 0, robot_.file);
    if (properties.mass_kg < 0) refuse(*mass, robot_.file, fmt::format("value = {}: must not be negative", properties.mass_kg));
    if (inertia) {
      const auto moment = [&](const char* name) { return numberOf(*inertia, name, 0, robot_.file); };
      const double xx = moment("ixx"), yy = moment("iyy"), zz = moment("izz");
      const double xy = moment("ixy"), xz = moment("ixz"), yz = moment("iyz");
      properties.inertia_kg_m2 << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    }
    return properties.seenFrom(originOf(inertial));
  }

  /// The shapes of one <visual> or <collision>; none for a mesh.
  std::optional<SourceShape> readShape(const XmlElement& element) {
    const XmlElement* geometry = element.FirstChildElement("geometry");
    const XmlElement* form = geometry ? geometry->FirstChildElement() : nullptr;
    if (!form) refuse(element, robot_.file, "must have a <geometry> with a shape");
    SourceShape shape;
    shape.pose = originOf(element);
    const std::string name = form->Name();
    const auto size = [&](const char* attribute) {
      const double value = numberOf(*form, attribute, 0, robot_.file);
      if (!(value > 0)) refuse(*form, robot_.file, fmt::format("{} = {}: must be positive", attribute, value));
      return value;
    };
    if (name == "box") {
      shape.kind = SourceShape::Kind::box;
      shape.size_m = vectorOf(*form, "size", Eigen::Vector3d::Zero(), robot_.file);
      if (!(shape.size_m.minCoeff() > 0)) refuse(*form, robot_.file, "size: must be three positive numbers");
    } else if (name == "sphere") {
      shape.size_m = {size("radius"), 0, 0};
    } else if (name == "cylinder" || name == "capsule") {
      shape.kind = name == "capsule" ? SourceShape::Kind::capsule : SourceShape::Kind::cylinder;
      shape.size_m = {size("radius"), size("length"), 0};
    } else if (name == "mesh") {
      return std::nullopt;
    } else {
      refuse(*form, robot_.file, "is no shape of URDF; must be box, sphere, cylinder, capsule or mesh");
    }
    if (const XmlElement* material = element.FirstChildElement("material")) shape.color = readMaterial(*material);
    return shape;
  }

  void readShapes(const XmlElement& link, SourceBody& body) {
    LinkShapes shapes;
    const auto read = [&](const char* name, std::vector<SourceShape>& solids) {
      for (const XmlElement* element : childrenOf(link, name)) {
        if (const auto shape = readShape(*element))
          solids.push_back(*shape);
        else
          ++shapes.mesh_count;
      }
    };
    read("collision", shapes.touching);
    read("visual", shapes.seen);
    body.collides = link.FirstChildElement("collision") != nullptr;
    giveShapes(robot_, body, shapes);
  }

  const XmlElement& childOf(const XmlElement& joint, const char* name) const {
    const XmlElement* child = joint.FirstChildElement(name);
    if (!child || !links_.contains(textOf(*child, "link")))
      refuse(joint, robot_.file, fmt::format("{} = {}: must be a link of this file", name, inQuotes(child ? textOf(*child, "link") : "")));
    return *child;
  }

  void noteParent(const XmlElement& joint) {
    nameOf(joint);
    childOf(joint, "parent");
    const std::string child = textOf(childOf(joint, "child"), "link");
    if (!parent_joints_.emplace(child, &joint).second)
      refuse(joint, robot_.file, fmt::format("link {} is the child of two joints", inQuotes(child)));
  }

  /// Sets the pose of a link from that of its parent, which it sets first.
  void placeLink(const std::string& name) {
    if (!placed_.insert(name).second) return;
    const auto found = parent_joints_.find(name);
    if (found == parent_joints_.end()) return;
    const XmlElement& joint = *found->second;
    std::vector<std::string> line{name};
    for (auto up = found; up != parent_joints_.end(); up = parent_joints_.find(line.back())) {
      line.push_back(textOf(childOf(*up->second, "parent"), "link"));
      if (line.back() == name) refuse(joint, robot_.file, fmt::format("link {} is its own ancestor", inQuotes(name)));
      if (line.size() > links_.size()) return;  // a circle further up, which its own links name
    }
    placeLink(line[1]);
    robot_.bodies[links_.at(name)].pose = robot_.bodies[links_.at(line[1])].pose * originOf(joint);
  }

  void readJoint(const XmlElement& element) {
    SourceJoint joint;
    joint.name = textOf(element, "name");
    const std::string type = textOf(element, "type");
    const std::size_t parent = links_.at(textOf(childOf(element, "parent"), "link"));
    const std::size_t child = links_.at(textOf(childOf(element, "child"), "link"));
    if (const XmlElement* axis = element.FirstChildElement("axis"))
      joint.axis = vectorOf(*axis, "xyz", Eigen::Vector3d::UnitX(), robot_.file);
    else
      joint.axis = Eigen::Vector3d::UnitX();
    if (joint.axis.norm() == 0) refuse(element, robot_.file, "axis: must have a direction");
    joint.axis.normalize();
    if (type == "floating") {
      robot_.bodies[child].free = true;
    } else if (type == "fixed") {
      robot_.join(parent, child, {joint});
    } else if (type == "planar") {
      robot_.join(parent, child, planar(joint));
      note(fmt::format("joint {}: planar, written as two sliders and a hinge; what else it has is not taken over", joint.name));
    } else {
      joint.kind = type == "prismatic" ? SourceJoint::Kind::slider : SourceJoint::Kind::hinge;
      if (type != "revolute" && type != "continuous" && type != "prismatic")
        refuse(element, robot_.file,
               fmt::format("type = {}: must be revolute, continuous, prismatic, fixed, floating or planar", inQuotes(type)));
      readDynamics(element, joint, type != "continuous");
      robot_.join(parent, child, {joint});
    }
    for (const char* name : {"mimic", "safety_controller", "calibration"})
      if (element.FirstChildElement(name)) note(fmt::format("joint {}: <{}> is not taken over", joint.name, name));
  }

  void readDynamics(const XmlElement& element, SourceJoint& joint, bool has_limits) {
    const XmlElement *limit = element.FirstChildElement("limit"), *dynamics = element.FirstChildElement("dynamics");
    if (has_limits && !limit) refuse(element, robot_.file, "must have a <limit>");
    if (limit) {
      const SourceRange range{numberOf(*limit, "lower", 0, robot_.file), numberOf(*limit, "upper", 0, robot_.file)};
      if (range.low > range.high)
        refuse(*limit, robot_.file, fmt::format("lower = {}: must not be above upper = {}", range.low, range.high));
      if (has_limits) joint.limits = range;
      std::vector<std::string> ignored;
      for (const char* name : {"effort", "velocity"})
        if (limit->Attribute(name)) ignored.push_back(fmt::format("{} {}", name, textOf(*limit, name)));
      if (!ignored.empty()) note(fmt::format("joint {}: limits of {} are not taken over", joint.name, fmt::join(ignored, " and ")));
    }
    if (dynamics) {
      joint.friction = numberOf(*dynamics, "friction", 0, robot_.file);
      joint.damping = numberOf(*dynamics, "damping", 0, robot_.file);
    }
  }

  static std::vector<SourceJoint> planar(const SourceJoint& joint) {
    const Eigen::Vector3d u = joint.axis.unitOrthogonal();
    std::vector<SourceJoint> series(3, joint);
    series[0].kind = series[1].kind = SourceJoint::Kind::slider;
    series[0].name += "_slide_1";
    series[1].name += "_slide_2";
    series[0].axis = u;
    series[1].axis = joint.axis.cross(u);
    series[2].kind = SourceJoint::Kind::hinge;
    return series;
  }

  /// URDF does not say whether the root moves; arms stand.
  void holdRoot(std::size_t body) {
    if (body == 0 || robot_.bodies[body].free) return;
    robot_.join(0, body, {});
    const std::string& name = robot_.bodies[body].name;
    if (robot_.bodies[body].mass.mass_kg > 0)
      note(fmt::format("link {}: the root is fixed to the world; give it free = true and joints to it instead of the world to let it go",
                       name));
  }

  void noteRest() {
    for (const XmlElement* element : childrenOf(root_)) {
      const std::string name = element->Name();
      if (name == "link" || name == "joint" || name == "material") continue;
      const std::string what = textOf(*element, name == "gazebo" ? "reference" : "name");
      note(fmt::format("<{}>{} in line {} is not taken over", name, what.empty() ? "" : " " + inQuotes(what), element->GetLineNum()));
    }
  }

  const XmlElement& root_;
  SourceRobot robot_;
  std::map<std::string, std::size_t> links_;
  std::map<std::string, const XmlElement*> parent_joints_;  ///< of a link
  std::map<std::string, std::array<double, 3>> colors_;
  std::set<std::string> placed_;
};

}  // namespace

SourceRobot readUrdf(const std::string& text, const std::string& file) {
  tinyxml2::XMLDocument document;
  parseXml(document, text, file);
  return UrdfReader(*document.RootElement(), file).read();
}

}  // namespace musclesim
