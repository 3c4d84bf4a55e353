/// What one wants to know about a robot before the first run: its tree, its moment arms, and what is odd about it.
#pragma once

#include <string>
#include <vector>

#include "musclesim/robot/robot.h"

namespace musclesim {

/// The tree of bodies, each with mass, centre of mass and principal moments of inertia, under the joint that holds it; then the muscles
/// with their lengths, and springs between bodies. The robot must stand as built.
std::string describeRobot(const World& world, const Robot& robot);

/// Moment arms of all muscles over one joint:  r_i = -dl_i/dq,  in mm; positive: the muscle turns the joint towards greater angles. All
/// other joints stand as built. For chains l is the straight distance of the ends.
struct MomentArms {
  std::string joint;             ///< name of the reported angle
  bool turns = true;             ///< false: a slide, whose arms are numbers without a unit: the shares of the tensions that pull along it
  std::vector<double> position;  ///< deg, or mm of a slide
  std::vector<std::vector<double>> arm_mm, length_mm;  ///< per muscle and angle
};

/// One entry per reported angle, over the joint's range (-90 .. 90 degrees where it has no stops). Moves the bodies, so take a world of
/// its own.
/// Throws BadParameter for a robot whose joints close a loop.
std::vector<MomentArms> momentArms(World& world, const Robot& robot);

/// The moment arms as a figure (SVG), one diagram per joint.
std::string momentArmFigure(const std::vector<MomentArms>& arms, const Robot& robot);

/// What is odd about a robot though it can be built: muscles that are connected to nothing or leave their range within the range of a
/// joint, joints that no muscle moves, parts that overlap, nothing that is reported. One sentence each. Of a
/// robot whose joints close a loop only what does not need moment arms. Moves the bodies as momentArms
/// does.
std::vector<std::string> oddities(World& world, const Robot& robot);

}  // namespace musclesim
