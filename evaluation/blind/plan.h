/// A plant before its causes: robot, kind, commands, sensors.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "excitation.h"
#include "kind.h"
#include "musclesim/base/random.h"
#include "musclesim/log/recording.h"

namespace musclesim {
class Robot;
}

namespace musclesim::blind {

struct Plan {
  std::string name, robot;
  Kind kind;
  std::string size;  ///< of each cause: weak, clear or strong; "none" without causes
  std::vector<Excitation> excitations;
  std::vector<Recording> recordings;  ///< commands only
  std::vector<std::string> signals;   ///< the measured ones
  std::map<std::string, double> noise_std;
};

/// Draws a plan for any robot from what the robot says of itself: its muscles, joints, stops and signals. Motions are made smaller until
/// the clean model stays off the stops that it does not touch at rest. A signal that never moves is not measured. `robot_name`: a name or a
/// robot file. `duration_s`: of a recording; half of it for robots of many muscles.
Plan drawPlan(const std::string& name, const std::string& robot_name, const Robot& robot, const std::vector<std::string>& kinds,
              double duration_s, RandomStream& random);

}  // namespace musclesim::blind
