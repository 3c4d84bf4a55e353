#include "mjcf_tendons.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "musclesim/base/text.h"

namespace musclesim {

namespace {

class TendonReader {
 public:
  TendonReader(const MjcfDocument& document, MjcfModel& model) : document_(document), model_(model), robot_(model.robot) {}

  void read() {
    for (const XmlElement* actuator : document_.section("actuator")) readActuator(*actuator);
    for (const XmlElement* tendon : document_.section("tendon")) readTendon(*tendon);
    for (const auto& [tendon, actuators] : drives_)
      note(fmt::format("actuator {}: its tendon {} is not a spatial tendon of this file", actuators.front().name, tendon));
    if (!robot_.muscles.empty())
      note("muscles: force laws, gains, filters and control ranges of actuators are not taken over; muscles have the force law of the run");
    const std::set<std::string> known = {"name", "class", "stiffness", "damping", "springlength", "rgba", "width", "group", "material"};
    if (const auto others = document_.otherAttributes("tendon", "spatial", known); !others.empty())
      note(fmt::format("<spatial>: {} not taken over", fmt::join(others, ", ")));
  }

 private:
  struct Drive {
    std::string name;
    std::optional<SourceRange> length_m;
  };

  void note(const std::string& text) { robot_.notes.push_back(text); }

  void readActuator(const XmlElement& xml) {
    const std::string kind = xml.Name();
    const MjcfElement element = document_.with(xml, kind);
    const std::string name = element.text("name", fmt::format("in line {}", xml.GetLineNum())), tendon = element.text("tendon");
    if (tendon.empty()) {
      std::string target;
      for (const char* attribute : {"joint", "jointinparent", "site", "body", "cranksite"})
        if (element.has(attribute)) target = fmt::format(" on {} {}", attribute, element.text(attribute));
      note(fmt::format("actuator {}: <{}>{} is not taken over", name, kind, target));
      return;
    }
    Drive drive{.name = name, .length_m = {}};
    const auto range = element.numbers("lengthrange", 2, 2);
    if (!range.empty() && range[0] < range[1]) drive.length_m = SourceRange{range[0], range[1]};
    drives_[tendon].push_back(drive);
  }

  void readTendon(const XmlElement& xml) {
    const MjcfElement element = document_.with(xml, "tendon");
    const std::string name = element.text("name", fmt::format("in line {}", xml.GetLineNum()));
    const auto drive = drives_.find(element.text("name"));
    const bool driven = drive != drives_.end() && std::string(xml.Name()) == "spatial";
    if (std::string(xml.Name()) != "spatial") {
      note(fmt::format("tendon {}: <{}> is not taken over", name, xml.Name()));
      return;
    }
    const std::string problem = problemOf(xml);
    if (driven && problem.empty())
      addMuscle(xml, element, drive->second);
    else if (!problem.empty())
      note(fmt::format("tendon {}: {}; not taken over", name, problem));
    else
      addSpring(xml, element, name);
    if (driven) drives_.erase(drive);
  }

  /// Why a path cannot be taken over; empty if it can. Throws BadFile for references to what is not there.
  std::string problemOf(const XmlElement& xml) const {
    const auto steps = childrenOf(xml);
    std::string problem;
    for (const XmlElement* step : steps) {
      const std::string kind = step->Name();
      if (kind == "pulley")
        problem = "it branches at a <pulley>";
      else if (kind == "site")
        siteOf(*step, "site");
      else if (kind == "geom")
        geomOf(*step);
      else
        refuse(*step, document_.file(), "must be site, geom or pulley");
    }
    if (!problem.empty()) return problem;
    if (steps.size() < 2 || std::string(steps.front()->Name()) != "site" || std::string(steps.back()->Name()) != "site")
      refuse(xml, document_.file(), "must begin and end with a site");
    for (std::size_t i = 1; i < steps.size(); ++i)
      if (std::string(steps[i]->Name()) == "geom" && std::string(steps[i - 1]->Name()) == "geom")
        refuse(*steps[i], document_.file(), "must have a site before and after it");
    return "";
  }

  const SourcePoint& siteOf(const XmlElement& step, const char* attribute) const {
    const auto found = model_.sites.find(textOf(step, attribute));
    if (found == model_.sites.end())
      refuse(step, document_.file(), fmt::format("{} = {}: there is no such site", attribute, inQuotes(textOf(step, attribute))));
    return found->second;
  }

  std::size_t geomOf(const XmlElement& step) const {
    const std::string name = textOf(step, "geom");
    for (std::size_t geom = 0; geom < model_.geoms.size(); ++geom) {
      if (model_.geoms[geom].name != name || name.empty()) continue;
      const auto kind = model_.geoms[geom].shape.kind;
      if (kind != SourceShape::Kind::sphere && kind != SourceShape::Kind::cylinder)
        refuse(step, document_.file(), fmt::format("geom = {}: must be a sphere or a cylinder", inQuotes(name)));
      return geom;
    }
    refuse(step, document_.file(), fmt::format("geom = {}: there is no such sphere or cylinder", inQuotes(name)));
  }

  void addMuscle(const XmlElement& xml, const MjcfElement& element, const std::vector<Drive>& drives) {
    SourceMuscle muscle;
    muscle.name = element.text("name");
    for (const XmlElement* step : childrenOf(xml)) {
      if (std::string(step->Name()) == "site")
        muscle.path.push_back({.pulley = {}, .point = siteOf(*step, "site")});
      else
        addWrap(*step, muscle);
    }
    for (const Drive& drive : drives)
      if (drive.length_m) muscle.length_m = drive.length_m;
    if (drives.size() > 1) note(fmt::format("tendon {}: {} actuators drive it; they are one muscle", muscle.name, drives.size()));
    if (element.number("stiffness", 0) != 0 || element.number("damping", 0) != 0)
      note(fmt::format("tendon {}: its stiffness and damping are not taken over", muscle.name));
    if (const auto rgba = element.numbers("rgba", 4, 4); !rgba.empty())
      muscle.color = {{std::clamp(rgba[0], 0.0, 1.0), std::clamp(rgba[1], 0.0, 1.0), std::clamp(rgba[2], 0.0, 1.0)}};
    robot_.muscles.push_back(std::move(muscle));
  }

  void addWrap(const XmlElement& step, SourceMuscle& muscle) {
    SourceStation station{.pulley = pulleyOf(geomOf(step)), .point = {}};
    if (step.Attribute("sidesite")) station.point = siteOf(step, "sidesite");
    muscle.path.push_back(station);
  }

  std::size_t pulleyOf(std::size_t geom) {
    if (const auto found = pulleys_.find(geom); found != pulleys_.end()) return found->second;
    MjcfGeom& wrapped = model_.geoms[geom];
    wrapped.is_pulley = true;
    robot_.pulleys.push_back({.name = wrapped.name,
                              .body = wrapped.body,
                              .pose = wrapped.shape.pose,
                              .radius_m = wrapped.shape.size_m.x(),
                              .sphere = wrapped.shape.kind == SourceShape::Kind::sphere});
    return pulleys_[geom] = robot_.pulleys.size() - 1;
  }

  void addSpring(const XmlElement& xml, const MjcfElement& element, const std::string& name) {
    const auto steps = childrenOf(xml);
    const double stiffness = element.number("stiffness", 0), damping = element.number("damping", 0);
    if (steps.size() != 2) {
      note(fmt::format("tendon {}: no actuator drives it; it is not taken over", name));
      return;
    }
    const SourcePoint &from = siteOf(*steps[0], "site"), &to = siteOf(*steps[1], "site");
    if ((stiffness == 0 && damping == 0) || from.body == to.body) {
      note(fmt::format("tendon {}: it has no effect and is not taken over", name));
      return;
    }
    SourceSpring spring{.name = element.text("name"), .from = from, .to = to, .stiffness = stiffness, .damping = damping, .rest_m = {}};
    const auto rest = element.numbers("springlength", 1, 2);
    if (!rest.empty() && rest[0] >= 0) spring.rest_m = rest[0];
    robot_.springs.push_back(spring);
  }

  const MjcfDocument& document_;
  MjcfModel& model_;
  SourceRobot& robot_;
  std::map<std::string, std::vector<Drive>> drives_;  ///< by the name of the tendon
  std::map<std::size_t, std::size_t> pulleys_;        ///< of geoms
};

}  // namespace

void readMjcfTendons(const MjcfDocument& document, MjcfModel& model) {
  TendonReader(document, model).read();
}

}  // namespace musclesim
