#include "description.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "../../base/toml_document.h"
#include "musclesim/base/error.h"
#include "musclesim/base/hash.h"
#include "musclesim/base/parameters.h"
#include "unit_suffix.h"

namespace musclesim::description {

namespace {

constexpr const char* format_name = "musclesim-robot-1";
constexpr const char* world = "world";

/// Groups of parameters that belong to the program; a robot of such a name would mix its parameters with theirs.
const std::set<std::string>& takenNames() {
  static const std::set<std::string> names = {"muscle", "force_law", "physics", "world", "task",
                                              "asm",    "aasm",      "effect",  "noise", "record"};
  return names;
}

bool isName(const std::string& text) {
  const auto fine = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !text.empty() && std::ranges::all_of(text, fine);
}

void requireName(const FilePlace& place, const std::string& name) {
  if (!isName(name)) place.refuse("\"" + name + "\" must consist of letters, digits, _ and -");
  if (name == world) place.refuse("\"world\" is the environment and cannot be the name of anything else");
}

double readTolerance(TableReader& table, const std::string& key) {
  const double tolerance = table.number(key);
  if (!isTolerance(tolerance))
    table.place(key).refuse(fmt::format("{} must be above 0 and at most {}, a share of the parameter", tolerance, largest_tolerance));
  return tolerance;
}

void readParameter(TableReader table, const std::string& name, Description& d) {
  ParameterEntry entry{.name = name, .unit = {}, .meaning = {}, .value = table.number("value"), .minimum = 0, .maximum = 0};
  const bool is_word = std::ranges::all_of(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
  if (name.empty() || !is_word || !std::isalpha(static_cast<unsigned char>(name[0])))
    table.place().refuse("the name of a parameter must consist of letters, digits and _ and begin with a letter");
  std::tie(entry.minimum, entry.maximum) = table.range("range");
  if (!(entry.value >= entry.minimum && entry.value <= entry.maximum))
    table.place("value").refuse(fmt::format("{} must lie in its range {} .. {}", entry.value, entry.minimum, entry.maximum));
  entry.meaning = table.optionalText("meaning").value_or("");
  entry.unit = table.optionalText("unit").value_or(unitFromSuffix(name));
  if (table.has("tolerance")) d.tolerances.push_back({d.name + "." + name, readTolerance(table, "tolerance"), table.place("tolerance")});
  table.requireNoOthers();
  d.parameters.push_back(entry);
}

/// [parameter_tolerance]; groups may be tables within it.
void readTolerances(TableReader table, const std::string& group, Description& d) {
  for (const std::string& key : table.keys()) {
    const std::string name = group + key;
    if (table.isTable(key)) {
      readTolerances(table.table(key), name + ".", d);
      continue;
    }
    const auto isGiven = [&](const ToleranceEntry& entry) { return entry.name == name; };
    if (name.starts_with(d.name + "."))
      table.place(key).refuse(
          fmt::format("is a parameter of this robot: write tolerance into [parameter.{}]", name.substr(d.name.size() + 1)));
    if (std::ranges::any_of(d.tolerances, isGiven)) table.place(key).refuse("must be given once");
    d.tolerances.push_back({name, readTolerance(table, key), table.place(key)});
  }
}

Part readPart(TableReader& table) {
  Part part;
  part.place = table.place();
  TableReader shape = table.table("shape");
  part.type = shape.choice("type", "", {"box", "sphere", "capsule", "cylinder", "none"});
  if (part.type == "box") part.size_mm = shape.vector("size_mm");
  if (part.type == "sphere" || part.type == "capsule" || part.type == "cylinder") part.radius_mm = shape.quantity("radius_mm");
  if (part.type == "capsule" || part.type == "cylinder") part.length_mm = shape.quantity("length_mm");
  shape.requireNoOthers();
  part.at_mm = table.vector("at_mm");
  part.turns = table.turns("rotate_deg");
  part.mass_g = table.optionalQuantity("mass_g");
  part.density_g_per_mm3 = table.optionalQuantity("density_g_per_mm3");
  if (part.mass_g && part.density_g_per_mm3) table.place("density_g_per_mm3").refuse("give either mass_g or density_g_per_mm3, not both");
  if (part.type == "none" && part.density_g_per_mm3)
    table.place("density_g_per_mm3").refuse("a body without a shape has no volume: give mass_g");
  part.color = table.optionalVector("color");
  return part;
}

BodyEntry readBody(TableReader table) {
  BodyEntry body;
  body.name = table.text("name");
  requireName(table.place("name"), body.name);
  table.setName(body.name);
  body.place = table.place();
  body.parts.push_back(readPart(table));
  body.inertia_g_mm2 = table.quantities("inertia_g_mm2");
  if (const std::size_t count = body.inertia_g_mm2.size(); count != 0 && count != 3 && count != 6)
    table.place("inertia_g_mm2").refuse(fmt::format("has {} numbers: must have 3 (xx, yy, zz) or 6 (xx, yy, zz, xy, xz, yz)", count));
  if (!body.inertia_g_mm2.empty() && !body.parts.front().mass_g)
    table.place("inertia_g_mm2").refuse("needs mass_g, the mass of the whole body, and not a density");
  body.center_of_mass_mm = table.optionalVector("center_of_mass_mm");
  const bool massless_parts = !body.inertia_g_mm2.empty();
  if (body.center_of_mass_mm && !massless_parts) table.place("center_of_mass_mm").refuse("needs inertia_g_mm2, which is about that point");
  body.fixed = table.flag("fixed", false);
  body.collides = table.flag("collides", true);
  body.free = table.flag("free", false);
  body.axes_of = table.optionalText("axes_of").value_or("");
  body.whole_turns = table.turns("rotate_whole_deg");
  for (TableReader& part : table.tables("part")) {
    body.parts.push_back(readPart(part));
    body.parts.back().name = part.optionalText("name").value_or("");
    part.requireNoOthers();
    const Part& added = body.parts.back();
    if (massless_parts && (added.mass_g || added.density_g_per_mm3))
      added.place.refuse("inertia_g_mm2 of the body is that of the whole: its parts must have no mass_g and no density_g_per_mm3");
    if (added.type == "none") added.place.refuse("a part must have a shape");
  }
  table.requireNoOthers();
  const auto hasName = [&](const Part& part) { return part.name == body.axes_of; };
  if (!body.axes_of.empty() && body.axes_of != body.name && std::ranges::none_of(body.parts, hasName))
    table.place("axes_of").refuse("\"" + body.axes_of + "\" must be the name of the body or of one of its parts");
  for (const Part& part : body.parts)
    if (!part.mass_g && !part.density_g_per_mm3 && !(massless_parts && &part != &body.parts.front()))
      part.place.refuse("\"mass_g\" is missing: must be a mass in g, or density_g_per_mm3 a density");
  if (body.parts.front().type == "none" && body.inertia_g_mm2.empty())
    body.place.refuse("a body without a shape needs inertia_g_mm2, three moments of inertia");
  return body;
}

JointEntry readJoint(TableReader table) {
  JointEntry joint;
  joint.name = table.text("name");
  requireName(table.place("name"), joint.name);
  table.setName(joint.name);
  joint.place = table.place();
  joint.type = table.choice("type", "", {"ball", "hinge", "hinge2", "universal", "universal1", "slider", "fixed"});
  joint.body = table.text("body");
  joint.to = table.optionalText("to").value_or(world);
  const bool slider = joint.type == "slider", turns = !slider && joint.type != "fixed";
  const bool two_axes = joint.type == "hinge2" || joint.type == "universal", ball = joint.type == "ball";
  const bool one_axis = slider || joint.type == "hinge" || joint.type == "universal1";
  if (turns) joint.at_mm = table.vector("at_mm");
  if (ball) joint.axis = table.optionalDirection("axis");
  if (one_axis || two_axes) joint.axis = table.direction("axis");
  if (two_axes) joint.axis2 = table.direction("axis2");
  if (ball && joint.axis) joint.axis3 = table.direction("axis3");
  if (slider) joint.limits = table.optionalPair("limits_mm");
  if (turns && (!ball || joint.axis)) joint.limits = table.optionalPair("limits_deg");
  if (two_axes || (ball && joint.axis)) joint.limits2 = table.optionalPair("limits2_deg");
  if (ball && joint.axis) joint.limits3 = table.optionalPair("limits3_deg");
  if (joint.limits.has_value() != joint.limits2.has_value() && two_axes)
    joint.place.refuse("give both limits_deg and limits2_deg, or none");
  if (ball && joint.axis && !(joint.limits && joint.limits2 && joint.limits3))
    joint.place.refuse("a ball joint with axes needs limits_deg, limits2_deg and limits3_deg");
  if (one_axis) {
    joint.friction = table.optionalQuantity(slider ? "friction_N" : "friction_Nm");
    joint.damping = table.optionalQuantity(slider ? "damping_Ns_per_m" : "damping_Nms_per_rad");
    joint.stiffness = table.optionalQuantity(slider ? "stiffness_N_per_mm" : "stiffness_Nm_per_rad");
    joint.rest = table.optionalQuantity(slider ? "rest_mm" : "rest_deg");
    if (joint.rest && !joint.stiffness) table.place(slider ? "rest_mm" : "rest_deg").refuse("needs a stiffness, whose rest it is");
  }
  joint.report = table.flag("report", one_axis && !slider);
  if (joint.report && !one_axis && !two_axes) table.place("report").refuse("a " + joint.type + " joint has no angle to report");
  if (joint.report && slider) table.place("report").refuse("a slider has no angle to report; report the hand instead");
  table.requireNoOthers();
  return joint;
}

PulleyEntry readPulley(TableReader table) {
  PulleyEntry pulley;
  pulley.name = table.text("name");
  requireName(table.place("name"), pulley.name);
  table.setName(pulley.name);
  pulley.place = table.place();
  pulley.body = table.optionalText("body").value_or(world);
  pulley.at_mm = table.vector("at_mm");
  pulley.axis = table.optionalDirection("axis");
  pulley.radius_mm = table.quantity("radius_mm");
  table.requireNoOthers();
  return pulley;
}

End readEnd(TableReader table) {
  End end;
  end.place = table.place();
  end.body = table.text("body");
  end.at_mm = table.vector("at_mm");
  end.lever = table.optionalDirection("lever");
  end.may_be_off = table.flag("may_be_off", true);
  table.requireNoOthers();
  return end;
}

PathPoint readPathPoint(TableReader table) {
  PathPoint point;
  point.place = table.place();
  if (table.has("pulley")) {
    point.pulley = table.text("pulley");
    point.side_mm = table.optionalVector("side_mm");
  } else {
    point.body = table.text("body");
    point.at_mm = table.vector("at_mm");
  }
  table.requireNoOthers();
  return point;
}

ForceLawEntry readForceLaw(TableReader table) {
  ForceLawEntry law;
  law.place = table.place();
  law.name = table.text("name");
  for (const std::string& key : table.keys())
    if (key != "name") law.parameters[key] = table.quantity(key);
  return law;
}

std::vector<QuantityVector> readControls(TableReader& table) {
  const std::string key = "control_mm";
  std::vector<QuantityVector> controls;
  if (!table.has(key)) return controls;
  controls = table.vectors(key);
  if (controls.size() != 2) table.place(key).refuse("must be the two inner control points of the Bezier curve");
  return controls;
}

std::array<Quantity, 2> readLengths(TableReader& table) {
  const auto lengths = table.optionalPair("length_mm");
  if (!lengths) table.place().refuse("\"length_mm\" is missing: must be [shortest, longest]");
  return *lengths;
}

void readEnds(TableReader& table, MuscleEntry& muscle, const std::string& default_name) {
  muscle.name = table.optionalText("name").value_or(default_name);
  requireName(table.place("name"), muscle.name);
  table.setName(muscle.name);
  muscle.place = table.place();
  muscle.from = readEnd(table.table("from"));
  muscle.to = readEnd(table.table("to"));
  muscle.length_mm = readLengths(table);
  muscle.rest_length_mm = table.optionalQuantity("rest_length_mm");
  muscle.color = table.optionalVector("color");
  muscle.color_name = table.optionalText("color_name").value_or("");
  if (auto law = table.optionalTable("force_law")) muscle.force_law = readForceLaw(*law);
}

MuscleEntry readMuscle(TableReader table, std::size_t number) {
  MuscleEntry muscle;
  readEnds(table, muscle, fmt::format("muscle_{}", number));
  muscle.model = table.has("model") ? table.choice("model", "", {"chain", "line"}) : "";
  muscle.control_mm = readControls(table);
  for (TableReader& point : table.tables("path")) muscle.path.push_back(readPathPoint(point));
  muscle.tendon_mm = table.optionalQuantity("tendon_mm");
  if (muscle.model != "line" && !muscle.path.empty()) table.place("path").refuse("needs model = \"line\": a chain goes from end to end");
  if (muscle.model != "line" && muscle.tendon_mm) table.place("tendon_mm").refuse("needs model = \"line\"");
  if (muscle.model == "line" && !muscle.control_mm.empty())
    table.place("control_mm").refuse("needs model = \"chain\": a line has no curve");
  table.requireNoOthers();
  return muscle;
}

MuscleEntry readActuator(TableReader table, std::size_t number) {
  MuscleEntry actuator;
  readEnds(table, actuator, fmt::format("actuator_{}", number));
  table.choice("type", "linear", {"linear"});
  actuator.force_N = table.optionalText("force_N").value_or("");
  requireShort(actuator.force_N, table.place("force_N"));
  if (!actuator.force_N.empty() && actuator.force_law) table.place("force_N").refuse("give either force_N or force_law, not both");
  actuator.commanded = table.flag("commanded", true);
  table.requireNoOthers();
  return actuator;
}

SpringEntry readSpring(TableReader table, std::size_t number) {
  SpringEntry spring;
  spring.name = table.optionalText("name").value_or(fmt::format("spring_{}", number));
  requireName(table.place("name"), spring.name);
  table.setName(spring.name);
  spring.place = table.place();
  spring.from = readEnd(table.table("from"));
  spring.to = readEnd(table.table("to"));
  spring.stiffness_N_per_mm = table.quantity("stiffness_N_per_mm");
  spring.rest_mm = table.quantity("rest_mm");
  spring.damping_Ns_per_m = table.optionalQuantity("damping_Ns_per_m");
  spring.pulls_only = table.flag("pulls_only", false);
  table.requireNoOthers();
  return spring;
}

WallEntry readWall(TableReader table) {
  WallEntry wall;
  wall.place = table.place();
  wall.body = table.optionalText("body").value_or("");
  wall.at_mm = table.vector("at_mm");
  wall.normal = table.direction("normal");
  wall.stiffness_N_per_mm = table.quantity("stiffness_N_per_mm");
  table.requireNoOthers();
  return wall;
}

HandEntry readHand(TableReader table) {
  HandEntry hand;
  hand.place = table.place();
  hand.body = table.text("body");
  hand.at_mm = table.optionalVector("at_mm");
  hand.report = table.flag("report", true);
  table.requireNoOthers();
  return hand;
}

/// Names that were given, each once, and what refers to them.
class Names {
 public:
  explicit Names(std::string kind) : kind_(std::move(kind)) {}
  void add(const std::string& name, const FilePlace& place) {
    if (std::ranges::find(names_, name) != names_.end()) place.refuse(fmt::format("there are two {} of the name \"{}\"", kind_, name));
    names_.push_back(name);
  }
  void require(const std::string& name, const FilePlace& place, bool may_be_world) const {
    if ((may_be_world && name == world) || std::ranges::find(names_, name) != names_.end()) return;
    std::vector<std::string> allowed = names_;
    if (may_be_world) allowed.emplace_back(world);
    const std::string nearest = nearestName(name, allowed);
    place.refuse(fmt::format("there is no \"{}\" among the {}{}; known: {}", name, kind_,
                             nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?", fmt::join(allowed, ", ")));
  }

 private:
  std::string kind_;
  std::vector<std::string> names_;
};

void requireReferences(const Description& d) {
  Names bodies("bodies"), joints("joints"), pulleys("pulleys"), muscles("muscles and actuators"), springs("springs");
  for (const BodyEntry& body : d.bodies) bodies.add(body.name, body.place);
  for (const JointEntry& joint : d.joints) {
    joints.add(joint.name, joint.place);
    bodies.require(joint.body, joint.place, false);
    bodies.require(joint.to, joint.place, true);
    if (joint.body == joint.to) joint.place.refuse("joins \"" + joint.body + "\" to itself");
  }
  for (const PulleyEntry& pulley : d.pulleys) {
    pulleys.add(pulley.name, pulley.place);
    bodies.require(pulley.body, pulley.place, true);
  }
  const auto requireEnds = [&](const auto& entry) {
    for (const End* end : {&entry.from, &entry.to}) bodies.require(end->body, end->place, true);
    if (entry.from.body == entry.to.body)
      entry.place.refuse(fmt::format("both ends are on \"{}\", so it can move nothing", entry.from.body));
  };
  for (const auto* list : {&d.muscles, &d.actuators})
    for (const MuscleEntry& muscle : *list) {
      muscles.add(muscle.name, muscle.place);
      requireEnds(muscle);
      for (const PathPoint& point : muscle.path)
        point.pulley.empty() ? bodies.require(point.body, point.place, true) : pulleys.require(point.pulley, point.place, false);
    }
  for (const SpringEntry& spring : d.springs) {
    springs.add(spring.name, spring.place);
    requireEnds(spring);
  }
  for (const WallEntry& wall : d.walls) {
    if (wall.body.empty() && !d.hand) wall.place.refuse("needs a body, or a [hand], which it stops");
    if (!wall.body.empty()) bodies.require(wall.body, wall.place, false);
  }
  if (d.hand) bodies.require(d.hand->body, d.hand->place, false);
}

/// Refuses bodies that no chain of joints holds, and cycles of fixed joints.
void requireHeld(const Description& d) {
  std::map<std::string, std::string> held_by, fixed_to;
  const auto root = [](std::map<std::string, std::string>& parents, std::string name) {
    for (auto next = parents.find(name); next != parents.end(); next = parents.find(name)) name = next->second;
    return name;
  };
  const auto join = [&](std::map<std::string, std::string>& parents, const std::string& a, const std::string& b) {
    const std::string x = root(parents, a), y = root(parents, b);
    if (x == y) return false;
    x == world ? parents[y] = x : parents[x] = y;
    return true;
  };
  for (const JointEntry& joint : d.joints) {
    join(held_by, joint.body, joint.to);
    if (joint.type == "fixed" && !join(fixed_to, joint.body, joint.to))
      joint.place.refuse("closes a cycle of fixed joints: what it fixes is fixed already");
  }
  const auto holdsFixedBody = [&](const JointEntry& joint) {
    return std::ranges::any_of(d.bodies, [&](const BodyEntry& b) { return b.fixed && b.name == joint.body && joint.to == world; });
  };
  for (const JointEntry& joint : d.joints)
    if (holdsFixedBody(joint)) joint.place.refuse("joins \"" + joint.body + "\" to the world, to which fixed = true fixes it already");
  for (const BodyEntry& body : d.bodies) {
    if (body.fixed && body.free) body.place.refuse("cannot be both fixed and free");
    if (body.fixed || body.free) join(held_by, body.name, world);
  }
  for (const BodyEntry& body : d.bodies)
    if (root(held_by, body.name) != world)
      body.place.refuse("nothing holds this body: join it to another one or to the world, or write free = true if it shall fall");
}

}  // namespace

Description readDescription(const std::string& text, const std::string& file) {
  const toml::table document = parseToml(text, file);
  TableReader table(document, file, "");
  if (const std::string format = table.text("format"); format != format_name)
    table.place("format").refuse(fmt::format("\"{}\" must be \"{}\"", format, format_name));
  Description d;
  d.file = file;
  Hash hash;
  hash.add(text);
  d.hash = hash.text();
  d.name = table.optionalText("name").value_or(std::filesystem::path(file).stem().string());
  requireName(table.place("name"), d.name);
  if (takenNames().contains(d.name))
    table.place("name").refuse("\"" + d.name + "\" is a group of parameters of the program: choose another name");
  d.summary = table.optionalText("description").value_or("");
  if (auto parameters = table.optionalTable("parameter"))
    for (const std::string& name : parameters->keys()) readParameter(parameters->table(name), name, d);
  if (auto tolerances = table.optionalTable("parameter_tolerance")) readTolerances(*tolerances, "", d);
  for (TableReader& body : table.tables("body")) d.bodies.push_back(readBody(body));
  for (TableReader& joint : table.tables("joint")) d.joints.push_back(readJoint(joint));
  for (TableReader& pulley : table.tables("pulley")) d.pulleys.push_back(readPulley(pulley));
  for (TableReader& muscle : table.tables("muscle")) d.muscles.push_back(readMuscle(muscle, d.muscles.size()));
  for (TableReader& actuator : table.tables("actuator")) d.actuators.push_back(readActuator(actuator, d.actuators.size()));
  for (TableReader& spring : table.tables("spring")) d.springs.push_back(readSpring(spring, d.springs.size()));
  for (TableReader& wall : table.tables("wall")) d.walls.push_back(readWall(wall));
  if (auto hand = table.optionalTable("hand")) d.hand = readHand(*hand);
  d.start_state = "built";
  if (auto start = table.optionalTable("start")) {
    d.start_state = start->choice("state", "built", {"built", "settled"});
    start->requireNoOthers();
  }
  table.requireNoOthers();
  if (d.bodies.empty()) table.place().refuse("describes no body: write at least one [[body]]");
  requireReferences(d);
  requireHeld(d);
  return d;
}

}  // namespace musclesim::description
