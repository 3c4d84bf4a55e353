/// SDF, read by libsdformat.
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sdf/sdf.hh>
#include <set>

#include "formats.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "musclesim/base/units.h"
#include "xml_values.h"

namespace musclesim {

namespace {

Eigen::Vector3d toEigen(const ignition::math::Vector3d& v) {
  return {v.X(), v.Y(), v.Z()};
}

Pose toEigen(const ignition::math::Pose3d& pose) {
  Pose result = Pose::Identity();
  const auto& q = pose.Rot();
  result.linear() = Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized().toRotationMatrix();
  result.translation() = toEigen(pose.Pos());
  return result;
}

/// Sends what is written to standard error nowhere as long as it lives: libsdformat tries a file that is no valid SDF as URDF, and the
/// library that reads URDF writes its complaints there.
class QuietStandardError {
 public:
  QuietStandardError() : kept_(dup(STDERR_FILENO)), nowhere_(open("/dev/null", O_WRONLY | O_CLOEXEC)) {
    if (kept_ >= 0 && nowhere_ >= 0) dup2(nowhere_, STDERR_FILENO);
  }
  ~QuietStandardError() {
    if (kept_ >= 0) dup2(kept_, STDERR_FILENO);
    for (const int descriptor : {kept_, nowhere_})
      if (descriptor >= 0) close(descriptor);
  }
  QuietStandardError(const QuietStandardError&) = delete;
  QuietStandardError& operator=(const QuietStandardError&) = delete;

 private:
  int kept_, nowhere_;
};

/// Looks through an SDF file and what it includes before libsdformat does. That takes almost a megabyte for a link, follows circles of
/// includes until the memory ends, and looks for files in other folders.
class SdfInspection {
 public:
  explicit SdfInspection(const std::string& file) : file_(file), folder_(std::filesystem::path(file).parent_path()) {}

  /// Throws BadFile if there is too much, or if something else than files in the folder or below is included.
  void inspect() { inspect(file_); }

  /// The path of an included file or of a model's folder; empty if there is none.
  static std::string find(const std::filesystem::path& folder, const std::string& uri) {
    const auto path = folder / nameIn(uri);
    return std::filesystem::exists(path) ? path.string() : "";
  }

 private:
  static std::string nameIn(const std::string& uri) {
    constexpr std::string_view scheme = "model://";
    return uri.starts_with(scheme) ? uri.substr(scheme.size()) : uri;
  }

  void inspect(const std::string& file) {
    constexpr std::size_t limit_bytes = 8 << 20;
    tinyxml2::XMLDocument document;
    parseXml(document, readTextFile(file, limit_bytes), file);
    inspect(*document.RootElement());
  }

  void inspect(const XmlElement& element) {
    constexpr int most_links = 250, most_elements = 20'000;
    const std::string kind = element.Name();
    link_count_ += kind == "link";
    if (++element_count_ > most_elements || link_count_ > most_links)
      throw BadFile(file_, fmt::format("has, with what it includes, more than {} links or {} elements", most_links, most_elements));
    for (const XmlElement* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
      const char* text = kind == "include" && std::string(child->Name()) == "uri" ? child->GetText() : nullptr;
      if (text) include(text);
      inspect(*child);
    }
  }

  void include(const std::string& uri) {
    constexpr int most_includes = 50;
    if (!isWithin(folder_.string(), nameIn(uri)))
      throw BadFile(file_, fmt::format("includes {}: must lie in its folder or below, and be no link that leads elsewhere", inQuotes(uri)));
    if (++include_count_ > most_includes)
      throw BadFile(file_, fmt::format("includes more than {} models; does one include itself?", most_includes));
    const std::string path = find(folder_, uri);
    if (path.empty()) throw BadFile(file_, fmt::format("includes {}, which is not in its folder", inQuotes(uri)));
    std::error_code ignored;  // libsdformat looks in the working directory first
    if (std::filesystem::exists(uri) && !std::filesystem::equivalent(uri, path, ignored))
      throw BadFile(file_, fmt::format("includes {}, of which the working directory has another", inQuotes(uri)));
    if (!std::filesystem::is_directory(path)) return inspect(path);
    for (const auto& entry : std::filesystem::directory_iterator(path))
      if (entry.path().extension() == ".sdf") inspect(entry.path().string());
  }

  std::string file_;
  std::filesystem::path folder_;
  int include_count_ = 0, link_count_ = 0, element_count_ = 0;
};

class SdfReader {
 public:
  explicit SdfReader(const std::string& file) {
    robot_.file = file;
    robot_.format = "SDF";
  }

  SourceRobot read() {
    SdfInspection(robot_.file).inspect();
    const QuietStandardError quiet;
    sdf::Console::Instance()->SetQuiet(true);
    sdf::ParserConfig config;
    config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
    config.SetFindCallback(
        [folder = std::filesystem::path(robot_.file).parent_path()](const std::string& uri) { return SdfInspection::find(folder, uri); });
    sdf::Root root;
    check(root.Load(robot_.file, config));
    if (const sdf::Model* model = root.Model()) {
      robot_.name = model->Name();
      readModel(*model, toEigen(model->RawPose()), "");
    }
    for (std::uint64_t i = 0; i < root.WorldCount(); ++i) readWorld(*root.WorldByIndex(i));
    if (robot_.bodies.size() < 2) throw BadFile(robot_.file, "there is no model with a link");
    setFree();
    return std::move(robot_);
  }

 private:
  void note(const std::string& text) { robot_.notes.push_back(text); }

  void check(const sdf::Errors& errors) const {
    if (errors.empty()) return;
    const auto& first = errors.front();
    if (first.Code() == sdf::ErrorCode::FILE_READ) throw BadFile(robot_.file, "is not valid SDF; ~/.sdformat/sdformat.log says why");
    throw BadFile(robot_.file, first.LineNumber().value_or(0), 0, first.Message());
  }

  Pose resolved(const sdf::SemanticPose& pose, const std::string& frame) const {
    ignition::math::Pose3d result;
    check(pose.Resolve(result, frame));
    return toEigen(result);
  }

  /// Notes the children of an element that are in the file and that no reader here knows.
  void noteOthers(const std::string& owner, const sdf::ElementPtr& element, const std::set<std::string>& known) {
    if (!element) return;
    for (auto child = element->GetFirstElement(); child; child = child->GetNextElement()) {
      const std::string kind = child->GetName();
      if (known.contains(kind) || !child->GetExplicitlySetInFile()) continue;
      const std::string name = child->HasAttribute("name") ? child->Get<std::string>("name") : "";
      note(fmt::format("{}: <{}>{} is not taken over", owner, kind, name.empty() ? "" : " " + name));
    }
  }

  void readWorld(const sdf::World& world) {
    if (robot_.name.empty()) robot_.name = world.Name();
    for (std::uint64_t i = 0; i < world.ModelCount(); ++i) {
      const sdf::Model& model = *world.ModelByIndex(i);
      readModel(model, resolved(model.SemanticPose(), ""), world.ModelCount() > 1 ? model.Name() + "::" : "");
    }
    const Eigen::Vector3d gravity = toEigen(world.Gravity()), usual(0, 0, -gravity_m_per_s2);
    constexpr double same_m_per_s2 = 1e-6;
    if ((gravity - usual).norm() > same_m_per_s2)
      note(fmt::format("world {}: gravity ({:g}, {:g}, {:g}) m/s^2 is not taken over; it is {:g} m/s^2 downwards", world.Name(),
                       gravity.x(), gravity.y(), gravity.z(), gravity_m_per_s2));
    noteOthers("world " + world.Name(), world.Element(), {"model", "include", "gravity", "frame"});
  }

  void readModel(const sdf::Model& model, const Pose& pose, const std::string& scope) {
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) readLink(*model.LinkByIndex(i), pose, scope, model.Static());
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
      const sdf::Model& nested = *model.ModelByIndex(i);
      readModel(nested, pose * resolved(nested.SemanticPose(), "__model__"), scope + nested.Name() + "::");
    }
    for (std::uint64_t i = 0; i < model.JointCount(); ++i) readJoint(*model.JointByIndex(i), pose, scope);
    noteOthers("model " + model.Name(), model.Element(), {"link", "joint", "frame", "model", "include", "pose", "static"});
  }

  void readLink(const sdf::Link& link, const Pose& model_pose, const std::string& scope, bool is_static) {
    SourceBody body;
    body.name = scope + link.Name();
    body.pose = model_pose * resolved(link.SemanticPose(), "__model__");
    const auto& inertial = link.Inertial();
    const ignition::math::Matrix3d moi = inertial.Moi();
    body.mass.mass_kg = inertial.MassMatrix().Mass();
    body.mass.center_m = toEigen(inertial.Pose().Pos());
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) body.mass.inertia_kg_m2(row, column) = moi(row, column);
    if (!link.Element() || !link.Element()->HasElement("inertial"))
      note(fmt::format("body {}: has no <inertial>; SDF gives it 1 kg and 1 kg m^2 about every axis", body.name));
    LinkShapes shapes;
    for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) addShape(*link.CollisionByIndex(i), body.name, shapes, shapes.touching);
    for (std::uint64_t i = 0; i < link.VisualCount(); ++i) addShape(*link.VisualByIndex(i), body.name, shapes, shapes.seen);
    body.collides = link.CollisionCount() > 0;
    giveShapes(robot_, body, shapes);
    noteOthers("body " + body.name, link.Element(), {"pose", "inertial", "collision", "visual"});
    bodies_.emplace(body.name, robot_.bodies.size());
    robot_.bodies.push_back(std::move(body));
    if (is_static) robot_.join(0, robot_.bodies.size() - 1, {});
  }

  static std::optional<std::array<double, 3>> colorOf(const sdf::Visual& visual) {
    if (!visual.Material()) return std::nullopt;
    const auto color = visual.Material()->Diffuse();
    return std::array<double, 3>{color.R(), color.G(), color.B()};
  }
  static std::optional<std::array<double, 3>> colorOf(const sdf::Collision&) { return std::nullopt; }

  template <class Element>
  void addShape(const Element& element, const std::string& body, LinkShapes& shapes, std::vector<SourceShape>& solids) {
    SourceShape shape;
    shape.color = colorOf(element);
    shape.pose = resolved(element.SemanticPose(), "");
    const sdf::Geometry& geometry = *element.Geom();
    switch (geometry.Type()) {
      case sdf::GeometryType::BOX:
        shape.kind = SourceShape::Kind::box;
        shape.size_m = toEigen(geometry.BoxShape()->Size());
        break;
      case sdf::GeometryType::SPHERE:
        shape.size_m.x() = geometry.SphereShape()->Radius();
        break;
      case sdf::GeometryType::CYLINDER:
        shape.kind = SourceShape::Kind::cylinder;
        shape.size_m = {geometry.CylinderShape()->Radius(), geometry.CylinderShape()->Length(), 0};
        break;
      case sdf::GeometryType::CAPSULE:
        shape.kind = SourceShape::Kind::capsule;
        shape.size_m = {geometry.CapsuleShape()->Radius(), geometry.CapsuleShape()->Length(), 0};
        break;
      case sdf::GeometryType::ELLIPSOID:
        shape.kind = SourceShape::Kind::ellipsoid;
        shape.size_m = toEigen(geometry.EllipsoidShape()->Radii());
        note(fmt::format("body {}: the ellipsoid {} is drawn as a box of its half axes", body, element.Name()));
        break;
      case sdf::GeometryType::MESH:
        ++shapes.mesh_count;
        return;
      default:
        note(fmt::format("body {}: the shape of {} is not taken over", body, element.Name()));
        return;
    }
    requirePositive(shape, body, element.Name());
    solids.push_back(shape);
  }

  void requirePositive(const SourceShape& shape, const std::string& body, const std::string& name) const {
    const bool round = shape.kind == SourceShape::Kind::capsule || shape.kind == SourceShape::Kind::cylinder;
    const int count = shape.kind == SourceShape::Kind::sphere ? 1 : round ? 2 : 3;
    if (!(shape.size_m.head(count).minCoeff() > 0))
      throw BadFile(robot_.file, fmt::format("body {}: the sizes of {} must be positive", body, name));
  }

  std::size_t bodyOf(const std::string& name, const std::string& scope, const std::string& joint) const {
    if (name == "world") return 0;
    const auto found = bodies_.find(scope + name);
    if (found == bodies_.end()) throw BadFile(robot_.file, fmt::format("joint {}: there is no link {}", joint, inQuotes(name)));
    return found->second;
  }

  void readJoint(const sdf::Joint& element, const Pose& model_pose, const std::string& scope) {
    const std::string name = scope + element.Name();
    std::string parent_name, child_name;
    check(element.ResolveParentLink(parent_name));
    check(element.ResolveChildLink(child_name));
    const std::size_t parent = bodyOf(parent_name, scope, name), child = bodyOf(child_name, scope, name);
    const Pose to_body = robot_.bodies[child].pose.inverse() * model_pose;
    const Pose pose = to_body * resolved(element.SemanticPose(), "__model__");
    std::vector<SourceJoint> series(axisCount(element, name));
    for (std::size_t i = 0; i < series.size(); ++i) {
      series[i].name = series.size() > 1 ? fmt::format("{}_{}", name, i + 1) : name;
      series[i].anchor_m = pose.translation();
      if (const sdf::JointAxis* axis = element.Axis(static_cast<unsigned>(i))) readAxis(*axis, to_body, element.Type(), series[i]);
    }
    if (element.Type() == sdf::JointType::BALL) series[0].kind = SourceJoint::Kind::ball;
    robot_.join(parent, child, series);
    noteOthers("joint " + name, element.Element(), {"pose", "parent", "child", "axis", "axis2"});
  }

  std::size_t axisCount(const sdf::Joint& joint, const std::string& name) const {
    switch (joint.Type()) {
      case sdf::JointType::FIXED:
        return 0;
      case sdf::JointType::BALL:
      case sdf::JointType::CONTINUOUS:
      case sdf::JointType::PRISMATIC:
      case sdf::JointType::REVOLUTE:
        return 1;
      case sdf::JointType::REVOLUTE2:
      case sdf::JointType::UNIVERSAL:
        return 2;
      default:
        throw BadFile(robot_.file, fmt::format("joint {}: must be revolute, continuous, prismatic, ball, universal, revolute2 or fixed; a "
                                               "screw or gearbox cannot be taken over",
                                               name));
    }
  }

  void readAxis(const sdf::JointAxis& axis, const Pose& to_body, sdf::JointType type, SourceJoint& joint) {
    ignition::math::Vector3d direction;
    check(axis.ResolveXyz(direction, "__model__"));
    joint.kind = type == sdf::JointType::PRISMATIC ? SourceJoint::Kind::slider : SourceJoint::Kind::hinge;
    joint.axis = (to_body.linear() * toEigen(direction)).normalized();
    joint.friction = axis.Friction();
    joint.damping = axis.Damping();
    joint.stiffness = axis.SpringStiffness();
    joint.rest = axis.SpringReference();
    constexpr double no_limit = 1e15;  // SDF's default is 1e16
    const bool low = axis.Lower() > -no_limit, high = axis.Upper() < no_limit;
    if (type != sdf::JointType::CONTINUOUS && (low || high)) setLimits(joint, axis, low && high);
    std::vector<std::string> ignored;
    if (std::isfinite(axis.Effort()) && axis.Effort() >= 0) ignored.push_back(fmt::format("effort {:g}", axis.Effort()));
    if (std::isfinite(axis.MaxVelocity()) && axis.MaxVelocity() >= 0) ignored.push_back(fmt::format("velocity {:g}", axis.MaxVelocity()));
    if (!ignored.empty()) note(fmt::format("joint {}: limits of {} are not taken over", joint.name, fmt::join(ignored, " and ")));
  }

  void setLimits(SourceJoint& joint, const sdf::JointAxis& axis, bool both) const {
    if (both && axis.Lower() > axis.Upper())
      throw BadFile(robot_.file, fmt::format("joint {}: lower = {}: must not be above upper = {}", joint.name, axis.Lower(), axis.Upper()));
    joint.limits = SourceRange{axis.Lower(), axis.Upper()};
    if (both) return;
    // The other bound is out of reach.
    constexpr double out_of_reach_m = 1000, out_of_reach_rad = 1000;
    const double far = joint.kind == SourceJoint::Kind::slider ? out_of_reach_m : out_of_reach_rad;
    joint.limits = SourceRange{std::max(axis.Lower(), -far), std::min(axis.Upper(), far)};
  }

  /// A group of bodies that no joint connects to the world is free; one of its bodies says so.
  void setFree() {
    std::vector<std::size_t> group(robot_.bodies.size());
    for (std::size_t i = 0; i < group.size(); ++i) group[i] = i;
    for (bool changed = true; changed;) {
      changed = false;
      for (const SourceJoint& joint : robot_.joints) {
        const std::size_t least = std::min(group[joint.body], group[joint.to]);
        changed = changed || group[joint.body] != least || group[joint.to] != least;
        group[joint.body] = group[joint.to] = least;
      }
    }
    for (std::size_t i = 1; i < group.size(); ++i) robot_.bodies[i].free = group[i] == i;
  }

  SourceRobot robot_;
  std::map<std::string, std::size_t> bodies_;
};

}  // namespace

SourceRobot readSdf(const std::string& file) {
  try {
    return SdfReader(file).read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& problem) {  // of libsdformat
    throw BadFile(file, fmt::format("is not valid SDF ({})", problem.what()));
  }
}

}  // namespace musclesim
