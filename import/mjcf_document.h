/// MuJoCo's XML (MJCF) with includes, compiler settings and defaults, as MuJoCo 2.2 documents it: https://mujoco.readthedocs.io, XML
/// reference.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "source_shape.h"
#include "xml_values.h"

namespace musclesim {

/// What <compiler> says.
struct MjcfCompiler {
  enum class Inertia { from_inertial, from_geoms, automatic };
  double angle_unit = 0;  ///< radians
  bool global = false, autolimits = false, balance_inertia = false;
  Inertia inertia = Inertia::automatic;
  std::string euler_sequence = "xyz";
  double least_mass_kg = 0, least_inertia_kg_m2 = 0;
  std::optional<double> total_mass_kg;
  int first_inertia_group = 0, last_inertia_group = 5;  ///< groups of geoms that count for inertia
};

class MjcfDocument;

/// An element with the defaults that apply to it.
class MjcfElement {
 public:
  const XmlElement& xml() const { return *levels_.front(); }
  bool has(const char* attribute) const { return find(attribute) != nullptr; }
  std::string text(const char* attribute, const std::string& default_value = "") const;
  double number(const char* attribute, double default_value) const;
  Eigen::Vector3d vector(const char* attribute, const Eigen::Vector3d& default_value) const;
  /// All numbers of an attribute, `least` to `most` of them; empty if there is none.
  std::vector<double> numbers(const char* attribute, std::size_t least, std::size_t most) const;
  /// Throws BadFile unless the value is true or false.
  bool flag(const char* attribute, bool default_value) const;
  /// Orientation by quat, axisangle, xyaxes, zaxis or euler; none of them: no value.
  std::optional<Eigen::Matrix3d> rotation() const;
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  friend class MjcfDocument;
  MjcfElement(const MjcfDocument& document, std::vector<const XmlElement*> levels) : document_(&document), levels_(std::move(levels)) {}
  const XmlElement* find(const char* attribute) const;
  static Eigen::Matrix3d fromEuler(const Eigen::Vector3d& angles, const std::string& sequence);

  const MjcfDocument* document_;
  std::vector<const XmlElement*> levels_;  ///< the element itself, then defaults, the most special first
};

class MjcfDocument {
 public:
  /// Throws BadFile with the line.
  MjcfDocument(const std::string& text, const std::string& file);
  MjcfDocument(const MjcfDocument&) = delete;
  MjcfDocument& operator=(const MjcfDocument&) = delete;

  const XmlElement& root() const { return *xml_.RootElement(); }
  const MjcfCompiler& compiler() const { return compiler_; }
  const std::string& file() const { return file_; }

  /// An element with its defaults: its class, else `childclass`, else those of all; `kind` is the name that defaults have for it.
  MjcfElement with(const XmlElement& element, const std::string& kind, const std::string& childclass = "") const;

  /// All children of the sections of that name below the root: a file may have a section several times.
  std::vector<const XmlElement*> section(const char* name) const;

  /// Attributes of elements of a kind in a section and in defaults that are not among the known ones.
  std::set<std::string> otherAttributes(const char* section, const std::string& kind, const std::set<std::string>& known) const;

 private:
  struct Class {
    std::string parent;
    std::map<std::string, std::vector<const XmlElement*>> elements;  ///< by kind, in the order of the file
  };
  struct IncludedFile {
    tinyxml2::XMLDocument xml;
    std::string file;
  };
  void include(XmlElement& parent, const std::string& folder);
  void readCompiler();
  void readDefaults(const XmlElement& element, const std::string& name, const std::string& parent);
  void collectAttributes(const XmlElement& element, const std::string& kind, std::set<std::string>& names) const;

  tinyxml2::XMLDocument xml_;
  std::string file_;
  std::vector<std::unique_ptr<IncludedFile>> included_;
  MjcfCompiler compiler_;
  std::map<std::string, Class> classes_;
};

}  // namespace musclesim
