/// New random pressures at every decision: the baseline that a controller has to beat.
#pragma once

#include "musclesim/base/random.h"
#include "musclesim/controller/attractors.h"
#include "musclesim/controller/controller.h"

namespace musclesim {

/// Draws every pressure uniformly from [0, 1) at each decision, independently of the robot's state. Stream "random.pressures".
class RandomPressuresController final : public Controller {
 public:
  explicit RandomPressuresController(const ControllerRequest& request);
  Action output(const State&) override;

 private:
  DecisionTimer timer_;
  RandomStream stream_;
  Action pressures_;
};

}  // namespace musclesim
