#include "mjcf_document.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>

#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "musclesim/base/units.h"

namespace musclesim {

namespace {

constexpr const char* top_class = "main";

}  // namespace

const XmlElement* MjcfElement::find(const char* attribute) const {
  const auto found = std::find_if(levels_.begin(), levels_.end(), [&](const XmlElement* level) { return level->Attribute(attribute); });
  return found == levels_.end() ? nullptr : *found;
}

std::string MjcfElement::text(const char* attribute, const std::string& default_value) const {
  const XmlElement* level = find(attribute);
  return level ? textOf(*level, attribute) : default_value;
}

std::vector<double> MjcfElement::numbers(const char* attribute, std::size_t least, std::size_t most) const {
  const XmlElement* level = find(attribute);
  if (!level) return {};
  return numbersIn(textOf(*level, attribute), least, most, *level, attribute, document_->file());
}

double MjcfElement::number(const char* attribute, double default_value) const {
  const XmlElement* level = find(attribute);
  return level ? numberOf(*level, attribute, default_value, document_->file()) : default_value;
}

Eigen::Vector3d MjcfElement::vector(const char* attribute, const Eigen::Vector3d& default_value) const {
  const XmlElement* level = find(attribute);
  return level ? vectorOf(*level, attribute, default_value, document_->file()) : default_value;
}

bool MjcfElement::flag(const char* attribute, bool default_value) const {
  const XmlElement* level = find(attribute);
  if (!level) return default_value;
  const std::string value = textOf(*level, attribute);
  if (value != "true" && value != "false")
    musclesim::refuse(*level, document_->file(), fmt::format("{} = {}: must be true or false", attribute, inQuotes(value)));
  return value == "true";
}

void MjcfElement::refuse(const std::string& what) const {
  musclesim::refuse(xml(), document_->file(), what);
}

Eigen::Matrix3d MjcfElement::fromEuler(const Eigen::Vector3d& angles, const std::string& sequence) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const char letter = sequence[static_cast<std::size_t>(i)];
    const bool fixed = letter < 'a';  // capital letters: axes of the frame around, small ones: of the frame that turns
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angles(i), Eigen::Vector3d::Unit(letter - (fixed ? 'X' : 'x'))).toRotationMatrix();
    rotation = fixed ? turn * rotation : rotation * turn;
  }
  return rotation;
}

std::optional<Eigen::Matrix3d> MjcfElement::rotation() const {
  const double unit = document_->compiler().angle_unit;
  const auto requireDirection = [&](const Eigen::Vector3d& v, const char* attribute) {
    if (v.norm() == 0) refuse(fmt::format("{}: must have a direction", attribute));
  };
  // An attribute of the element itself hides another way to say the same in its defaults.
  for (const XmlElement* level : levels_) {
    const MjcfElement element(*document_, {level});
    if (const auto q = element.numbers("quat", 4, 4); !q.empty()) {
      if (Eigen::Vector4d(q.data()).norm() == 0) refuse("quat = 0 0 0 0: must not be zero");
      return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    }
    if (const auto a = element.numbers("axisangle", 4, 4); !a.empty()) {
      requireDirection({a[0], a[1], a[2]}, "axisangle");
      return Eigen::AngleAxisd(unit * a[3], Eigen::Vector3d(a[0], a[1], a[2]).normalized()).toRotationMatrix();
    }
    if (const auto a = element.numbers("xyaxes", 6, 6); !a.empty()) {
      const Eigen::Vector3d x(a.data()), y(a.data() + 3);
      const Eigen::Vector3d z = x.cross(y);
      requireDirection(z, "xyaxes");
      Eigen::Matrix3d rotation;
      rotation << x.normalized(), z.cross(x).normalized(), z.normalized();
      return rotation;
    }
    if (const auto z = element.numbers("zaxis", 3, 3); !z.empty()) {
      requireDirection(Eigen::Vector3d(z.data()), "zaxis");
      return turnOfZAxis(Eigen::Vector3d(z.data()));
    }
    if (const auto e = element.numbers("euler", 3, 3); !e.empty())
      return fromEuler(unit * Eigen::Vector3d(e.data()), document_->compiler().euler_sequence);
  }
  return std::nullopt;
}

MjcfDocument::MjcfDocument(const std::string& text, const std::string& file) : file_(file) {
  parseXml(xml_, text, file);
  include(*xml_.RootElement(), std::filesystem::path(file).parent_path().string());
  readCompiler();
  classes_[top_class];
  for (const XmlElement* section : childrenOf(root(), "default")) {
    const std::string name = textOf(*section, "class");
    readDefaults(*section, name.empty() ? top_class : name, "");
    if (!name.empty() && name != top_class) classes_[top_class] = classes_[name];
  }
}

/// Reads included files; childrenOf() puts their contents in the place of <include>.
void MjcfDocument::include(XmlElement& parent, const std::string& folder) {
  for (XmlElement* child = parent.FirstChildElement(); child; child = child->NextSiblingElement()) {
    if (std::string(child->Name()) != "include") {
      include(*child, folder);
      continue;
    }
    const std::string name = textOf(*child, "file");
    if (name.empty()) refuse(*child, file_, "must have a file");
    const std::string path = (std::filesystem::path(folder) / name).lexically_normal().string();
    for (const auto& earlier : included_)
      if (earlier->file == path) refuse(*child, file_, fmt::format("{} is included twice", path));
    constexpr std::size_t limit_bytes = 8 << 20, most_files = 200;
    if (!isWithin(std::filesystem::path(file_).parent_path().string(), name))
      refuse(*child, file_,
             fmt::format("file = {}: must lie in the folder of {} or below, and be no link that leads elsewhere", inQuotes(name), file_));
    if (included_.size() >= most_files) refuse(*child, file_, fmt::format("more than {} files are included", most_files));
    auto included = std::make_unique<IncludedFile>();
    included->file = path;
    parseXml(included->xml, readTextFile(path, limit_bytes), path);
    included->xml.SetUserData(&included->file);
    child->SetUserData(included->xml.RootElement());
    included_.push_back(std::move(included));
    include(*included_.back()->xml.RootElement(), folder);
  }
}

void MjcfDocument::readCompiler() {
  compiler_.angle_unit = rad_per_deg;
  for (const XmlElement* xml : childrenOf(root(), "compiler")) {
    const MjcfElement element(*this, {xml});
    const auto choose = [&](const char* attribute, const std::string& current, const std::set<std::string>& allowed) {
      const std::string value = element.text(attribute, current);
      if (!allowed.contains(value)) element.refuse(fmt::format("{} = {}: is not known", attribute, inQuotes(value)));
      return value;
    };
    const std::string angle = choose("angle", compiler_.angle_unit == 1 ? "radian" : "degree", {"radian", "degree"});
    compiler_.angle_unit = angle == "radian" ? 1 : rad_per_deg;
    compiler_.global = choose("coordinate", compiler_.global ? "global" : "local", {"local", "global"}) == "global";
    compiler_.autolimits = element.flag("autolimits", compiler_.autolimits);
    compiler_.balance_inertia = element.flag("balanceinertia", compiler_.balance_inertia);
    const std::string inertia = choose("inertiafromgeom", "auto", {"true", "false", "auto"});
    if (element.has("inertiafromgeom"))
      compiler_.inertia = inertia == "true"    ? MjcfCompiler::Inertia::from_geoms
                          : inertia == "false" ? MjcfCompiler::Inertia::from_inertial
                                               : MjcfCompiler::Inertia::automatic;
    compiler_.euler_sequence = element.text("eulerseq", compiler_.euler_sequence);
    if (compiler_.euler_sequence.size() != 3 || compiler_.euler_sequence.find_first_not_of("xyzXYZ") != std::string::npos)
      element.refuse(fmt::format("eulerseq = {}: must be three letters of xyzXYZ", inQuotes(compiler_.euler_sequence)));
    compiler_.least_mass_kg = element.number("boundmass", compiler_.least_mass_kg);
    compiler_.least_inertia_kg_m2 = element.number("boundinertia", compiler_.least_inertia_kg_m2);
    if (const double total = element.number("settotalmass", -1); total > 0) compiler_.total_mass_kg = total;
    if (const auto groups = element.numbers("inertiagrouprange", 2, 2); !groups.empty()) {
      compiler_.first_inertia_group = static_cast<int>(groups[0]);
      compiler_.last_inertia_group = static_cast<int>(groups[1]);
    }
  }
}

void MjcfDocument::readDefaults(const XmlElement& element, const std::string& name, const std::string& parent) {
  Class& own = classes_[name];
  own.parent = parent;
  for (const XmlElement* child : childrenOf(element)) {
    if (std::string(child->Name()) != "default") {
      own.elements[child->Name()].push_back(child);
      continue;
    }
    const std::string below = textOf(*child, "class");
    if (below.empty()) refuse(*child, file_, "a nested default must have a class");
    if (classes_.contains(below)) refuse(*child, file_, fmt::format("there is another class {}", inQuotes(below)));
    readDefaults(*child, below, name);
  }
}

MjcfElement MjcfDocument::with(const XmlElement& element, const std::string& kind, const std::string& childclass) const {
  std::string name = textOf(element, "class");
  if (!name.empty() && !classes_.contains(name)) refuse(element, file_, fmt::format("class = {}: there is no such class", inQuotes(name)));
  if (name.empty()) name = childclass.empty() ? top_class : childclass;
  std::vector<const XmlElement*> levels{&element};
  while (!name.empty()) {
    const Class& own = classes_.at(name);
    if (const auto found = own.elements.find(kind); found != own.elements.end())
      levels.insert(levels.end(), found->second.rbegin(), found->second.rend());
    name = own.parent;
  }
  return {*this, levels};
}

std::vector<const XmlElement*> MjcfDocument::section(const char* name) const {
  std::vector<const XmlElement*> all;
  for (const XmlElement* section : childrenOf(root(), name))
    for (const XmlElement* child : childrenOf(*section)) all.push_back(child);
  return all;
}

void MjcfDocument::collectAttributes(const XmlElement& element, const std::string& kind, std::set<std::string>& names) const {
  if (kind == element.Name())
    for (const tinyxml2::XMLAttribute* attribute = element.FirstAttribute(); attribute; attribute = attribute->Next())
      names.insert(attribute->Name());
  for (const XmlElement* child : childrenOf(element)) collectAttributes(*child, kind, names);
}

std::set<std::string> MjcfDocument::otherAttributes(const char* section, const std::string& kind,
                                                    const std::set<std::string>& known) const {
  std::set<std::string> names;
  for (const char* place : {"default", section})
    for (const XmlElement* element : childrenOf(root(), place)) collectAttributes(*element, kind, names);
  for (const std::string& name : known) names.erase(name);
  return names;
}

}  // namespace musclesim
