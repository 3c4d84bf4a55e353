#include "robotic_arm_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "robotic_arm_table.h"

namespace musclesim {

namespace {

using robotic_arm::Kind;
using robotic_arm::MuscleRow;
using robotic_arm::OperationRow;
using robotic_arm::PrimitiveRow;
using robotic_arm::Triple;

constexpr std::size_t paper_muscle_count = 10;

std::string vectorText(const Triple& t) {
  return fmt::format("[{}, {}, {}]", t[0], t[1], t[2]);
}

/// Primitives that form one body, and how it is turned and held.
struct Group {
  std::vector<const PrimitiveRow*> parts;
  std::string axes_of;  ///< the part that gives the body its axes
  std::string whole_turns;
  bool composed = false, fixed = false;
  const std::string name() const { return parts.front()->name; }
};

/// Follows the operations of the table.
class ArmWriter {
 public:
  ArmWriter() {
    for (const PrimitiveRow& row : robotic_arm::primitives()) groups_.push_back({{&row}, row.name, "", false, false});
    for (const OperationRow& row : robotic_arm::operations()) perform(row);
  }

  std::string text() const {
    std::string out =
        "# The arm of M. Braun, Simulating Artificial Muscles for Controlling a Robotic Arm with Fluctuation, Osaka University, 2007.\n"
        "format = \"musclesim-robot-1\"\nname = \"arm\"\ndescription = \"shoulder, elbow, wrist and ten muscles\"\n";
    for (const Group& group : groups_) out += bodyText(group);
    out += joints_;
    for (std::size_t i = 0; i < paper_muscle_count; ++i) out += muscleText(robotic_arm::muscles()[i]);
    return out + fmt::format("\n[hand]\nbody = \"{}\"\n", groupOf("medius").name());
  }

 private:
  const Group& groupOf(std::string_view primitive) const {
    return *std::ranges::find_if(groups_, [&](const Group& group) {
      return std::ranges::any_of(group.parts, [&](const PrimitiveRow* row) { return row->name == primitive; });
    });
  }
  Group& groupOf(std::string_view primitive) { return const_cast<Group&>(std::as_const(*this).groupOf(primitive)); }
  std::string bodyNamed(const char* primitive) const { return primitive ? groupOf(primitive).name() : "world"; }

  void perform(const OperationRow& row) {
    Group& group = groupOf(row.primitive);
    const std::string turn = fmt::format("[{}, \"{}\"]", row.angle_deg, row.axis);
    if (row.kind == Kind::rotate) {
      std::string& turns = group.composed ? group.whole_turns : turns_[row.primitive];
      turns += (turns.empty() ? "" : ", ") + turn;
    } else if (row.kind == Kind::fix) {
      group.fixed = true;
    } else if (row.kind == Kind::composite) {
      compose(row);
    } else {
      addJoint(row);
    }
  }

  void compose(const OperationRow& row) {
    Group whole{{}, row.primitive, "", true, false};
    for (const PrimitiveRow& primitive : robotic_arm::primitives())  // in the order in which they are made
      if (std::ranges::any_of(row.partNames(), [&](const char* name) { return std::string_view(name) == primitive.name; }))
        whole.parts.push_back(&primitive);
    std::erase_if(groups_, [&](const Group& group) { return group.parts.front() != whole.parts.front() && isPart(group, whole); });
    groupOf(whole.parts.front()->name) = whole;
  }

  static bool isPart(const Group& group, const Group& whole) {
    return std::ranges::find(whole.parts, group.parts.front()) != whole.parts.end();
  }

  void addJoint(const OperationRow& row) {
    const bool ball = row.kind == Kind::ball;
    const std::string_view bone = row.primitive;
    const std::string name = bone == "ulna" ? "elbow" : bone == "pollex" ? "wrist" : fmt::format("ball_{}", ++ball_count_);
    joints_ += fmt::format("\n[[joint]]\nname = \"{}\"\ntype = \"{}\"\nbody = \"{}\"\nto = \"{}\"\nat_mm = {}\n", name,
                           ball ? "ball" : "hinge", bodyNamed(row.primitive), bodyNamed(row.other), vectorText(row.anchor_mm));
    if (!ball) joints_ += fmt::format("axis = \"{}\"\nlimits_deg = [{}, {}]\n", row.axis, row.low_deg, row.high_deg);
  }

  std::string partText(const PrimitiveRow& row) const {
    const auto [a, b, c] = row.size_mm;
    const std::string shape = row.shape == robotic_arm::Shape::box ? fmt::format("type = \"box\", size_mm = [{}, {}, {}]", a, b, c)
                              : row.shape == robotic_arm::Shape::sphere
                                  ? fmt::format("type = \"sphere\", radius_mm = {}", a)
                                  : fmt::format("type = \"capsule\", radius_mm = {}, length_mm = {}", a, b);
    std::string out =
        fmt::format("name = \"{}\"\nat_mm = {}\nshape = {{ {} }}\nmass_g = {}\n", row.name, vectorText(row.position_mm), shape, row.mass_g);
    if (const auto turns = turns_.find(row.name); turns != turns_.end()) out += fmt::format("rotate_deg = [{}]\n", turns->second);
    return out;
  }

  std::string bodyText(const Group& group) const {
    std::string out = "\n[[body]]\n" + partText(*group.parts.front());
    if (group.parts.size() > 1 && group.axes_of != group.name()) out += fmt::format("axes_of = \"{}\"\n", group.axes_of);
    if (!group.whole_turns.empty()) out += fmt::format("rotate_whole_deg = [{}]\n", group.whole_turns);
    if (group.fixed) out += "fixed = true\n";
    for (std::size_t i = 1; i < group.parts.size(); ++i) out += "\n[[body.part]]\n" + partText(*group.parts[i]);
    return out;
  }

  std::string muscleText(const MuscleRow& row) const {
    return fmt::format(
        "\n[[muscle]]\nfrom = {{ body = \"{}\", at_mm = {} }}\nto = {{ body = \"{}\", at_mm = {} }}\ncontrol_mm = [{}, {}]\n"
        "length_mm = [{}, {}]\ncolor = {}\ncolor_name = \"{}\"\n",
        bodyNamed(row.connect_start_to), vectorText(row.start_mm), bodyNamed(row.connect_end_to), vectorText(row.end_mm),
        vectorText(row.start_control_mm), vectorText(row.end_control_mm), row.minimum_length_mm, row.maximum_length_mm,
        vectorText(row.cap_rgb), row.color_name);
  }

  std::vector<Group> groups_;
  std::map<std::string, std::string> turns_;  ///< of single primitives
  std::string joints_;
  int ball_count_ = 0;
};

}  // namespace

std::string roboticArmFile() {
  return ArmWriter().text();
}

}  // namespace musclesim
