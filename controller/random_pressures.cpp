#include "musclesim/controller/random_pressures.h"

namespace musclesim {

RandomPressuresController::RandomPressuresController(const ControllerRequest& request)
    : timer_(request), stream_(request.seed, "random.pressures"), pressures_(static_cast<std::size_t>(request.muscle_count)) {}

Action RandomPressuresController::output(const State&) {
  if (timer_.due())
    for (auto& pressure : pressures_) pressure = stream_.uniform();
  return pressures_;
}

}  // namespace musclesim
