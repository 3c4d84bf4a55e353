/// Constant pressures.
#pragma once

#include "musclesim/controller/controller.h"

namespace musclesim {

/// Commands the same pressures at all times, whatever the robot does.
/// Declares hold.pressure (0.5, fraction of full scale, 0..1) and, per muscle, hold.pressure_<i> with hold.pressure as default.
class HoldController final : public Controller {
 public:
  explicit HoldController(const ControllerRequest& request);
  Action output(const State&) override { return pressures_; }

 private:
  Action pressures_;
};

}  // namespace musclesim
