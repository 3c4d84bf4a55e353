#include "robot_template.h"

#include <fmt/format.h>

#include "musclesim/base/error.h"
#include "musclesim/robot/robot_file.h"

namespace musclesim::command_line {

namespace {

constexpr const char* template_text =
    R"(# {0}: a lever between two muscles. Change what is different on your machine; docs/reference/robot_format.md lists all keys.
#
#     musclesim robot check {0}.toml       says what is wrong or odd
#     musclesim robot show {0}.toml        draws it, with the moment arms of the muscles
#     musclesim --robot {0}.toml           opens the window
#
# Lengths in mm, masses in g, angles in degrees, forces in N. The world is right-handed, y up. All places are given in the world, in the
# pose in which the robot is built; that pose has the angle 0 at every joint. A number may be an expression over the parameters, in quotes.
format = "musclesim-robot-1"
name = "{0}"
description = "a lever between two muscles"

# Numbers that you may want to change from outside: --set {0}.lever_mm=70, --tune {0}.lever_mm.
[parameter.lever_mm]
value = 80
range = [20, 200]
meaning = "distance of the muscles' ends from the hinge"

[parameter.bar_kg]
value = 0.4
range = [0.01, 10]
meaning = "mass of the bar"
# tolerance = 0.02                                     # what the scales are off, as a share: a diagnosis leaves the mass that much room

# A rigid body. Weigh it, or estimate its mass; the moments of inertia are those of the shape unless inertia_g_mm2 gives them.
[[body]]
name = "bar"
at_mm = [0, 0, 0]                                    # centre of the shape
shape = {{ type = "box", size_mm = [200, 20, 20] }}    # or sphere, capsule, cylinder (along z; turn with rotate_deg = [[90, "x"]]), none
mass_g = "bar_kg * 1000"

[[joint]]
name = "lever"                                       # recorded as angle_lever_deg
type = "hinge"                                       # or ball, hinge2, universal, universal1, slider, fixed
body = "bar"
to = "world"                                         # or another body
at_mm = [0, 0, 0]
axis = "z"                                           # positive angles turn right-handed about it
limits_deg = [-40, 40]
# friction_Nm = 0.05                                 # dry friction of the bearing
# damping_Nms_per_rad = 0.01

# Muscles are numbered in the order of the file: command_0, pressure_0, ... in recordings.
[[muscle]]
name = "right"
from = {{ body = "world", at_mm = ["lever_mm", -260, 0] }}
to = {{ body = "bar", at_mm = ["lever_mm", -10, 0] }}
length_mm = [150, 320]                               # shortest (full pressure, no load) and longest (stretched)

[[muscle]]
name = "left"
from = {{ body = "world", at_mm = ["-lever_mm", -260, 0] }}
to = {{ body = "bar", at_mm = ["-lever_mm", -10, 0] }}
length_mm = [150, 320]

# The point whose position is recorded (hand_x_mm ...), and to which loads and targets refer.
[hand]
body = "bar"
at_mm = [100, 0, 0]

[start]
state = "settled"                                    # runs begin at rest under their first command; or "built"
)";

}  // namespace

std::string robotTemplate(const std::string& name) {
  std::string result = fmt::format(fmt::runtime(template_text), name);
  try {
    checkRobotText(result, name + ".toml");
  } catch (const BadFile& problem) {
    throw BadParameter("name of the robot", name, std::string("be a name: ") + problem.what());
  }
  return result;
}

}  // namespace musclesim::command_line
