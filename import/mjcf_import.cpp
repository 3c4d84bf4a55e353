/// MJCF, the format of MuJoCo.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "formats.h"
#include "mjcf_bodies.h"
#include "mjcf_document.h"
#include "mjcf_tendons.h"
#include "musclesim/base/units.h"

namespace musclesim {

namespace {

void noteGravity(const MjcfDocument& document, SourceRobot& robot) {
  for (const XmlElement* option : childrenOf(document.root(), "option")) {
    const Eigen::Vector3d usual(0, 0, -gravity_m_per_s2), gravity = vectorOf(*option, "gravity", usual, document.file());
    constexpr double same_m_per_s2 = 1e-6;
    if ((gravity - usual).norm() > same_m_per_s2)
      robot.notes.push_back(fmt::format("gravity ({:g}, {:g}, {:g}) m/s^2 is not taken over; it is {:g} m/s^2 along -z of the source",
                                        gravity.x(), gravity.y(), gravity.z(), gravity_m_per_s2));
    for (const XmlElement* flag : childrenOf(*option, "flag"))
      for (const tinyxml2::XMLAttribute* attribute = flag->FirstAttribute(); attribute; attribute = attribute->Next())
        if (std::string(attribute->Value()) == "disable")
          robot.notes.push_back(fmt::format("flag {} = disable is not taken over", attribute->Name()));
  }
}

/// Only pairs collide if the file says so.
void applyPredefinedPairs(const MjcfDocument& document, MjcfModel& model) {
  bool predefined = false;
  for (const XmlElement* option : childrenOf(document.root(), "option"))
    if (option->Attribute("collision")) predefined = textOf(*option, "collision") == "predefined";
  if (!predefined) return;
  std::set<std::string> geoms;
  for (const XmlElement* pair : document.section("contact"))
    for (const char* attribute : {"geom1", "geom2"}) geoms.insert(textOf(*pair, attribute));
  for (SourceBody& body : model.robot.bodies) body.collides = false;
  for (const MjcfGeom& geom : model.geoms)
    if (!geom.name.empty() && geoms.contains(geom.name)) model.robot.bodies[geom.body].collides = true;
  model.robot.notes.push_back("only bodies of geoms in <pair> collide, but with everything that collides, not with their partner alone");
}

/// Every element of a section that is not read.
void noteSections(const MjcfDocument& document, SourceRobot& robot) {
  const std::set<std::string> read = {"compiler", "default", "worldbody", "tendon", "actuator", "size", "visual", "statistic", "asset"};
  for (const XmlElement* section : childrenOf(document.root())) {
    if (read.contains(section->Name())) continue;
    std::vector<std::string> others;
    for (const tinyxml2::XMLAttribute* attribute = section->FirstAttribute(); attribute; attribute = attribute->Next())
      if (std::string(attribute->Name()) != "gravity") others.push_back(attribute->Name());
    if (!others.empty()) robot.notes.push_back(fmt::format("<{}>: {} not taken over", section->Name(), fmt::join(others, ", ")));
    for (const XmlElement* child : childrenOf(*section)) {
      std::string what;
      for (const char* attribute : {"name", "joint1", "joint", "body1", "geom1", "site", "tendon1"})
        if (what.empty() && child->Attribute(attribute)) what = " " + textOf(*child, attribute);
      if (std::string(child->Name()) != "flag")
        robot.notes.push_back(
            fmt::format("<{}>: <{}>{} in line {} is not taken over", section->Name(), child->Name(), what, child->GetLineNum()));
    }
  }
  const std::set<std::string> known = {"angle",     "coordinate",   "inertiafromgeom", "autolimits",        "balanceinertia", "eulerseq",
                                       "boundmass", "boundinertia", "settotalmass",    "inertiagrouprange", "meshdir",        "texturedir"};
  if (const auto others = document.otherAttributes("compiler", "compiler", known); !others.empty())
    robot.notes.push_back(fmt::format("<compiler>: {} not taken over", fmt::join(others, ", ")));
}

}  // namespace

SourceRobot readMjcf(const std::string& text, const std::string& file) {
  const MjcfDocument document(text, file);
  MjcfModel model;
  model.robot.file = file;
  model.robot.format = "MJCF";
  model.robot.name = textOf(document.root(), "model");
  readMjcfBodies(document, model);
  applyPredefinedPairs(document, model);
  readMjcfTendons(document, model);
  drawGeoms(model);
  noteGravity(document, model.robot);
  noteSections(document, model.robot);
  return std::move(model.robot);
}

}  // namespace musclesim
