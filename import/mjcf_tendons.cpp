#include "mjcf_tendons.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "muscle_path.h"
#include "musclesim/base/text.h"

namespace musclesim {

namespace {

class TendonReader {
 public:
  TendonReader(const MjcfDocument& document, MjcfModel& model) : document_(document), model_(model), robot_(model.robot) {}

  void read() {
    for (const XmlElement* actuator : document_.section("actuator")) readActuator(*actuator);
    findDrivenSliders();
    for (const XmlElement* tendon : document_.section("tendon")) extendSlider(*tendon);
    for (const XmlElement* tendon : document_.section("tendon")) readTendon(*tendon);
    for (const auto& [joint, text] : joint_drives_) note(text);
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

  /// A body on a slider that an actuator drives: the place where a muscle ends and its tendon begins.
  struct Slider {
    std::string actuator, joint;
    std::size_t to = 0;                                     ///< the body along which it slides
    const XmlElement *muscle = nullptr, *tendon = nullptr;  ///< the straight tendon that stands for the muscle, if any; the tendon
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
      const std::string text = fmt::format("actuator {}: <{}>{} is not taken over", name, kind, target);
      if (element.has("joint"))
        joint_drives_.emplace_back(element.text("joint"), text), joint_actuators_.emplace(element.text("joint"), name);
      else
        note(text);
      return;
    }
    Drive drive{.name = name, .length_m = {}};
    const auto range = element.numbers("lengthrange", 2, 2);
    if (!range.empty() && range[0] < range[1]) drive.length_m = SourceRange{range[0], range[1]};
    drives_[tendon].push_back(drive);
  }

  bool isStill(std::size_t body) const {
    if (body == 0) return true;
    const auto joint = std::find_if(robot_.joints.begin(), robot_.joints.end(), [&](const auto& j) { return j.body == body; });
    return joint != robot_.joints.end() && joint->kind == SourceJoint::Kind::fixed && isStill(joint->to);
  }

  /// Bodies that hang on one driven slider at what does not move, and that carry no other body.
  void findDrivenSliders() {
    for (const SourceJoint& joint : robot_.joints) {
      const auto actuator = joint_actuators_.find(joint.name);
      const bool carries =
          std::any_of(robot_.joints.begin(), robot_.joints.end(), [&](const SourceJoint& other) { return other.to == joint.body; });
      if (joint.kind == SourceJoint::Kind::slider && actuator != joint_actuators_.end() && isStill(joint.to) && !carries)
        sliders_[joint.body] = {.actuator = actuator->second, .joint = joint.name, .to = joint.to};
    }
    std::map<std::size_t, int> elastic;
    for (const XmlElement* tendon : document_.section("tendon"))
      if (const auto body = sliderOf(*tendon)) noteEnd(*tendon, *body, elastic[*body]);
    std::erase_if(sliders_, [&](const auto& slider) { return elastic[slider.first] != 1; });
  }

  /// The slider's body on which one end of a tendon without an actuator of its own lies.
  std::optional<std::size_t> sliderOf(const XmlElement& tendon) const {
    const auto steps = childrenOf(tendon, "site");
    if (std::string(tendon.Name()) != "spatial" || steps.empty() || drives_.contains(textOf(tendon, "name"))) return {};
    for (const XmlElement* end : {steps.front(), steps.back()})
      if (const auto site = model_.sites.find(textOf(*end, "site")); site != model_.sites.end() && sliders_.contains(site->second.body))
        return site->second.body;
    return {};
  }

  /// A tendon with stiffness is the cable of the slider; a straight one without leads to the other end of the muscle.
  void noteEnd(const XmlElement& tendon, std::size_t body, int& elastic_count) {
    if (!problemOf(tendon).empty()) return;
    if (document_.with(tendon, "tendon").number("stiffness", 0) > 0) {
      sliders_[body].tendon = &tendon;
      ++elastic_count;
    } else if (childrenOf(tendon).size() == 2) {
      sliders_[body].muscle = &tendon;
    }
  }

  /// Writes a driven slider and its cable as one muscle with a cable in series; the slider's body goes.
  void extendSlider(const XmlElement& xml) {
    const auto body = sliderOf(xml);
    if (!body || sliders_.at(*body).tendon != &xml) return;
    const Slider slider = sliders_.at(*body);
    const MjcfElement element = document_.with(xml, "tendon");
    addMuscle(xml, element, {});
    SourceMuscle& muscle = robot_.muscles.back();
    if (muscle.path.front().point->body != *body) muscle.path = {muscle.path.rbegin(), muscle.path.rend()};
    muscle.name = slider.actuator;
    const SourcePoint joint_of_both{slider.to, robot_.bodies[slider.to].pose.inverse() * robot_.inWorld(*muscle.path.front().point)};
    muscle.path.front().point = joint_of_both;
    if (slider.muscle) {
      muscle.tendon_m = pathLengthM(robot_, muscle);
      const auto sites = childrenOf(*slider.muscle, "site");
      const SourcePoint &first = siteOf(*sites[0], "site"), &last = siteOf(*sites[1], "site");
      std::vector<SourceStation> path(1);
      path[0].point = first.body == *body ? last : first;
      path.insert(path.end(), muscle.path.begin(), muscle.path.end());
      muscle.path = path;
      consumed_.insert(slider.muscle);
    }
    consumed_.insert(&xml);
    note(fmt::format("muscle {}: stands for body {} on its slider {} with its actuator and for the tendon {}{}", muscle.name,
                     robot_.bodies[*body].name, slider.joint, element.text("name"),
                     slider.muscle ? ", which is a cable that does not stretch here" : ""));
    robot_.bodies[*body].gone = true;
    std::erase_if(robot_.joints, [&](const SourceJoint& joint) { return joint.body == *body; });
    std::erase_if(joint_drives_, [&](const auto& drive) { return drive.first == slider.joint; });
    sliders_.erase(*body);
  }

  void readTendon(const XmlElement& xml) {
    if (consumed_.contains(&xml)) return;
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
  std::map<std::string, std::vector<Drive>> drives_;               ///< by the name of the tendon
  std::vector<std::pair<std::string, std::string>> joint_drives_;  ///< joint, and the note that its actuator is left out
  std::map<std::string, std::string> joint_actuators_;             ///< by the name of the joint
  std::map<std::size_t, Slider> sliders_;                          ///< by body
  std::set<const XmlElement*> consumed_;                           ///< tendons that are muscles with a slider
  std::map<std::size_t, std::size_t> pulleys_;                     ///< of geoms
};

}  // namespace

void readMjcfTendons(const MjcfDocument& document, MjcfModel& model) {
  TendonReader(document, model).read();
}

}  // namespace musclesim
