#include "robot_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"

namespace musclesim {

namespace {

/// (x, y, z) with z up becomes (x, z, -y) with y up: a quarter turn about x, back.
Eigen::Matrix3d toTarget() {
  return (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
}

/// Twelve digits: what rounding has left behind does not show, and right angles stay right to what joints ask for.
std::string number(double value, double zero = 1e-9) {
  return std::abs(value) < zero ? "0" : fmt::format("{:.12g}", value);
}

std::string list(const std::vector<double>& values, double zero = 1e-9) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(number(value, zero));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string list(const Eigen::Vector3d& vector) {
  return list(std::vector<double>{vector.x(), vector.y(), vector.z()});
}

std::string range(const SourceRange& range, double unit) {
  return list(std::vector<double>{unit * range.low, unit * range.high});
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char character : text) {
    if (character == '"' || character == '\\') out += '\\';
    if (static_cast<unsigned char>(character) < 0x20 || character == 0x7F)
      out += fmt::format("\\u{:04X}", static_cast<unsigned char>(character));
    else
      out += character;
  }
  return out + "\"";
}

/// For comments: printable ASCII in one line.
std::string oneLine(std::string text) {
  for (char& character : text)
    if (static_cast<unsigned char>(character) < 0x20 || static_cast<unsigned char>(character) > 0x7E) character = '?';
  return text;
}

/// A point of the source's world in the target's world, mm.
std::string place(const Eigen::Vector3d& point_m) {
  return list(Eigen::Vector3d(mm_per_m * (toTarget() * point_m)));
}

std::string direction(const Eigen::Vector3d& axis) {
  return list(Eigen::Vector3d((toTarget() * axis).normalized()));
}

/// One right-handed turn about an axis of the world: `[[90, "x"]]`. Empty for no turn.
std::string turn(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd angle_axis(rotation);
  double angle_deg = angle_axis.angle() * deg_per_rad;
  constexpr double no_turn_deg = 1e-9;
  if (std::abs(angle_deg) < no_turn_deg) return "";
  Eigen::Vector3d axis = angle_axis.axis();
  Eigen::Index along = 0;
  if (axis.cwiseAbs().maxCoeff(&along) < 1 - 1e-12) return fmt::format("[[{}, {}]]", number(angle_deg), list(axis));
  return fmt::format("[[{}, \"{}\"]]", number(axis(along) < 0 ? -angle_deg : angle_deg), "xyz"[along]);
}

/// Axes of a shape in the world of the target. A round shape has them with the least turn that gives it its place.
Eigen::Matrix3d axesOf(const Eigen::Matrix3d& body, const SourceShape& shape) {
  const Eigen::Matrix3d axes = toTarget() * body * shape.pose.linear();
  if (shape.kind == SourceShape::Kind::sphere) return Eigen::Matrix3d::Identity();
  const bool round = shape.kind == SourceShape::Kind::capsule || shape.kind == SourceShape::Kind::cylinder;
  return round ? turnOfZAxis(axes.col(2)) : axes;
}

std::string shapeText(const SourceShape& shape) {
  const Eigen::Vector3d size_mm = mm_per_m * shape.size_m;
  switch (shape.kind) {
    case SourceShape::Kind::box:
    case SourceShape::Kind::ellipsoid:
      return fmt::format("{{ type = \"box\", size_mm = {} }}", list(size_mm));
    case SourceShape::Kind::sphere:
      return fmt::format("{{ type = \"sphere\", radius_mm = {} }}", number(size_mm.x()));
    case SourceShape::Kind::capsule:
    case SourceShape::Kind::cylinder:
      return fmt::format("{{ type = \"{}\", radius_mm = {}, length_mm = {} }}",
                         shape.kind == SourceShape::Kind::capsule ? "capsule" : "cylinder", number(size_mm.x()), number(size_mm.y()));
  }
  return "";
}

class TomlWriter {
 public:
  explicit TomlWriter(const SourceRobot& robot) : robot_(robot) {}

  std::string text() {
    if (std::none_of(robot_.bodies.begin() + 1, robot_.bodies.end(), isWritten))
      throw BadFile(robot_.file, "describes no body beside what is fixed to the world and not drawn");
    writeHead();
    for (std::size_t body = 1; body < robot_.bodies.size(); ++body)
      if (isWritten(robot_.bodies[body])) writeBody(robot_.bodies[body]);
    for (const SourceJoint& joint : robot_.joints) writeJoint(joint);
    for (const SourcePulley& pulley : robot_.pulleys) writePulley(pulley);
    for (const SourceMuscle& muscle : robot_.muscles) writeMuscle(muscle);
    for (const SourceSpring& spring : robot_.springs) writeSpring(spring);
    return text_;
  }

 private:
  void line(const std::string& key, const std::string& value) { text_ += key + " = " + value + "\n"; }
  void lineUnlessZero(const std::string& key, double value) {
    if (value != 0) line(key, number(value, 0));
  }
  void table(const std::string& name) { text_ += "\n[[" + name + "]]\n"; }

  /// A fixed body that is not drawn is nothing but the world.
  static bool isWritten(const SourceBody& body) { return !body.gone && !(body.fixed && body.shapes.empty()); }

  const std::string& nameOf(std::size_t body) const { return robot_.bodies[body].name; }

  void writeHead() {
    const std::string source = std::filesystem::path(robot_.file).filename().string();
    text_ += fmt::format("# Imported from {} ({}). The source's (x, y, z) is (x, z, -y) here.\n", oneLine(source), robot_.format);
    if (!robot_.notes.empty()) text_ += "#\n# Not taken over, or taken over in another way:\n";
    for (const std::string& note : robot_.notes) text_ += "# - " + oneLine(note) + "\n";
    text_ += "\n";
    line("format", "\"musclesim-robot-1\"");
    line("name", quoted(robot_.name));
    text_ += "\n[start]\nstate = \"built\"\n";
  }

  void writeColor(const std::optional<std::array<double, 3>>& color) {
    if (color) line("color", list(std::vector<double>(color->begin(), color->end())));
  }

  void writeBody(const SourceBody& body) {
    const Eigen::Vector3d center = body.pose * body.mass.center_m;
    Eigen::Vector3d at = center;
    Eigen::Matrix3d axes = toTarget() * body.pose.linear() * principalInertia(body.mass.inertia_kg_m2).axes;
    if (!body.shapes.empty()) {
      at = body.pose * body.shapes[0].pose.translation();
      axes = axesOf(body.pose.linear(), body.shapes[0]);
    }
    table("body");
    line("name", quoted(body.name));
    line("at_mm", place(at));
    if (const std::string rotation = turn(axes); !rotation.empty()) line("rotate_deg", rotation);
    line("shape", body.shapes.empty() ? "{ type = \"none\" }" : shapeText(body.shapes[0]));
    if (body.fixed)
      writeDensity();
    else
      writeMass(body, at, axes);
    if (!body.shapes.empty()) writeColor(body.shapes[0].color);
    if (body.fixed) line("fixed", "true");
    if (body.free) line("free", "true");
    line("collides", body.collides ? "true" : "false");
    for (std::size_t part = 1; part < body.shapes.size(); ++part) writePart(body, body.shapes[part]);
  }

  void writeMass(const SourceBody& body, const Eigen::Vector3d& at, const Eigen::Matrix3d& axes) {
    const Eigen::Vector3d center = body.pose * body.mass.center_m;
    line("mass_g", number(g_per_kg * body.mass.mass_kg, 0));
    const Eigen::Matrix3d turned = axes.transpose() * toTarget() * body.pose.linear();
    const Eigen::Matrix3d inertia = g_mm2_per_kg_m2 * (turned * body.mass.inertia_kg_m2 * turned.transpose());
    const double zero = 1e-12 * inertia.cwiseAbs().maxCoeff();  // rounding
    std::vector<double> values{inertia(0, 0), inertia(1, 1), inertia(2, 2)};
    const std::vector<double> products{inertia(0, 1), inertia(0, 2), inertia(1, 2)};
    if (std::any_of(products.begin(), products.end(), [&](double value) { return std::abs(value) > zero; }))
      values.insert(values.end(), products.begin(), products.end());
    line("inertia_g_mm2", list(values, zero));
    constexpr double same_place_m = 1e-12;
    if ((center - at).norm() > same_place_m) line("center_of_mass_mm", place(center));
  }

  /// What does not move has a mass without effect.
  void writeDensity() { line("density_g_per_mm3", "0.001"); }

  void writePart(const SourceBody& body, const SourceShape& shape) {
    table("body.part");
    line("shape", shapeText(shape));
    line("at_mm", place(body.pose * shape.pose.translation()));
    if (const std::string rotation = turn(axesOf(body.pose.linear(), shape)); !rotation.empty()) line("rotate_deg", rotation);
    if (body.fixed) writeDensity();
    writeColor(shape.color);
  }

  static const char* typeOf(SourceJoint::Kind kind) {
    switch (kind) {
      case SourceJoint::Kind::fixed:
        return "fixed";
      case SourceJoint::Kind::hinge:
        return "hinge";
      case SourceJoint::Kind::slider:
        return "slider";
      case SourceJoint::Kind::universal:
        return "universal";
      case SourceJoint::Kind::ball:
        return "ball";
    }
    return "";
  }

  void writeLimits(const std::string& key, const std::optional<SourceRange>& limits, double unit) {
    if (limits) line(key, range(*limits, unit));
  }

  void writeJoint(const SourceJoint& joint) {
    const Pose& pose = robot_.bodies[joint.body].pose;
    const bool slides = joint.kind == SourceJoint::Kind::slider, ball = joint.kind == SourceJoint::Kind::ball;
    table("joint");
    line("name", quoted(joint.name));
    line("type", quoted(typeOf(joint.kind)));
    line("body", quoted(nameOf(joint.body)));
    line("to", quoted(nameOf(joint.to)));
    if (!slides) line("at_mm", place(pose * joint.anchor_m));
    if (!ball) line("axis", direction(pose.linear() * joint.axis));
    if (joint.kind == SourceJoint::Kind::universal) line("axis2", direction(robot_.bodies[joint.to].pose.linear() * joint.axis2));
    writeLimits(slides ? "limits_mm" : "limits_deg", joint.limits, slides ? mm_per_m : deg_per_rad);
    writeLimits("limits2_deg", joint.limits2, deg_per_rad);
    lineUnlessZero(slides ? "friction_N" : "friction_Nm", joint.friction);
    lineUnlessZero(slides ? "damping_Ns_per_m" : "damping_Nms_per_rad", joint.damping);
    lineUnlessZero(slides ? "stiffness_N_per_mm" : "stiffness_Nm_per_rad", slides ? joint.stiffness / mm_per_m : joint.stiffness);
    if (joint.stiffness != 0) lineUnlessZero(slides ? "rest_mm" : "rest_deg", joint.rest * (slides ? mm_per_m : deg_per_rad));
    if (joint.kind == SourceJoint::Kind::hinge || joint.kind == SourceJoint::Kind::universal) line("report", "true");
  }

  void writePulley(const SourcePulley& pulley) {
    const Pose pose = robot_.bodies[pulley.body].pose * pulley.pose;
    table("pulley");
    line("name", quoted(pulley.name));
    line("body", quoted(nameOf(pulley.body)));
    line("at_mm", place(pose.translation()));
    if (!pulley.sphere) line("axis", direction(pose.linear().col(2)));
    line("radius_mm", number(mm_per_m * pulley.radius_m));
  }

  std::string end(const SourcePoint& point) const {
    return fmt::format("{{ body = {}, at_mm = {} }}", quoted(nameOf(point.body)), place(robot_.inWorld(point)));
  }

  std::string station(const SourceStation& station) const {
    if (!station.pulley) return end(*station.point);
    const std::string& pulley = robot_.pulleys[*station.pulley].name;
    if (!station.point) return fmt::format("{{ pulley = {} }}", quoted(pulley));
    return fmt::format("{{ pulley = {}, side_mm = {} }}", quoted(pulley), place(robot_.inWorld(*station.point)));
  }

  void writeMuscle(const SourceMuscle& muscle) {
    table("muscle");
    line("name", quoted(muscle.name));
    line("model", "\"line\"");
    line("from", end(*muscle.path.front().point));
    line("to", end(*muscle.path.back().point));
    if (muscle.length_m) line("length_mm", range(*muscle.length_m, mm_per_m));
    lineUnlessZero("tendon_mm", mm_per_m * muscle.tendon_m);
    if (muscle.path.size() > 2) {
      text_ += "path = [\n";
      for (std::size_t i = 1; i + 1 < muscle.path.size(); ++i) text_ += "  " + station(muscle.path[i]) + ",\n";
      text_ += "]\n";
    }
    writeColor(muscle.color);
  }

  void writeSpring(const SourceSpring& spring) {
    table("spring");
    line("name", quoted(spring.name));
    line("from", end(spring.from));
    line("to", end(spring.to));
    line("stiffness_N_per_mm", number(spring.stiffness / mm_per_m, 0));
    const double built_m = (robot_.inWorld(spring.to) - robot_.inWorld(spring.from)).norm();
    line("rest_mm", number(mm_per_m * spring.rest_m.value_or(built_m)));
    lineUnlessZero("damping_Ns_per_m", spring.damping);
  }

  const SourceRobot& robot_;
  std::string text_;
};

}  // namespace

std::string robotToml(const SourceRobot& robot) {
  return TomlWriter(robot).text();
}

}  // namespace musclesim
