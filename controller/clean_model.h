/// The clean model of a robot, without effects, in a world of its own: for controllers that ask what it would do.
#pragma once

#include <memory>

#include "musclesim/effect/effect_chain.h"
#include "musclesim/robot/robot.h"

namespace musclesim {

class CleanModel {
 public:
  /// Builds the robot again by its name or file, with the parameters of its world. Throws BadParameter or BadFile if it cannot be built so.
  explicit CleanModel(const Robot& robot);

  World& world() { return world_; }
  Robot& robot() { return *robot_; }
  /// Sets the pressures as if the command had been held for ever.
  void setPressures(const Action& command) { effects_.settlePressures(command); }

 private:
  World world_;
  EffectChain effects_;
  std::unique_ptr<Robot> robot_;
};

}  // namespace musclesim
