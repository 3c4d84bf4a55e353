#include "contact.h"

#include <algorithm>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

enum Side { automatic, beyond, below };

}  // namespace

EffectInfo Contact::info() {
  return {.id = "contact",
          .stage = Stage::body,
          .acts_on = {ComponentKind::joint, ComponentKind::hand},
          .summary = "a joint, the hand or the load meets a wall",
          .equation = "torque or force = -k max(0, s (x - x_w)) s    x angle or coordinate of the hand, x_w plane, s side",
          .signature = "a one-sided, local error away from the joint's own stops",
          .source = "penalty contact",
          .parameters = {{"stiffness_Nm_per_deg", "N m/deg", 0, 0, 1000, 0.05, 2, "k at a joint"},
                         {"stiffness_N_per_mm", "N/mm", 0, 0, 1e5, 0.5, 20, "k at the hand or load"},
                         {"plane_deg", "deg", 20, -360, 360, -40, 40, "x_w at a joint", true},
                         {"plane_mm", "mm", -240, -1e5, 1e5, -300, 300, "x_w at the hand or load", true},
                         {"axis", "", 1, 0, 2, 0, 2, "coordinate of the hand or load", true, {"x", "y", "z"}},
                         {"side",
                          "",
                          0,
                          0,
                          2,
                          0,
                          2,
                          "side of x_w on which the wall is; auto: given by the sign of x_w",
                          true,
                          {"auto", "beyond", "below"}}},
          .make = [](const EffectValues& values) { return std::make_unique<Contact>(values); },
          .variants = Variants::sides};
}

double Wall::push(double coordinate) const {
  return beyond ? -stiffness * std::max(0.0, coordinate - plane) : stiffness * std::max(0.0, plane - coordinate);
}

Wall Contact::wallAt(const std::string& plane, const std::string& stiffness) const {
  const auto side = static_cast<Side>(values_["side"]);
  return {values_[plane], values_[stiffness], side == beyond || (side == automatic && values_[plane] >= 0)};
}

void Contact::attach(const EffectPlace& place) {
  const bool at_joint = place.kind == ComponentKind::joint;
  const std::string stiffness = at_joint ? "stiffness_Nm_per_deg" : "stiffness_N_per_mm";
  if (values_[stiffness] == 0) throw BadParameter("contact on " + place.component + ": it needs " + stiffness);
  if (at_joint)
    contact_ = std::make_unique<JointContact>(wallAt("plane_deg", stiffness));
  else
    contact_ = std::make_unique<HandContact>(wallAt("plane_mm", stiffness), Vector::Unit(static_cast<int>(values_["axis"])));
  contact_->attach(place);
}

}  // namespace musclesim
