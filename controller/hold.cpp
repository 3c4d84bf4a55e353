#include "musclesim/controller/hold.h"

#include <fmt/format.h>

namespace musclesim {

HoldController::HoldController(const ControllerRequest& request) {
  auto& parameters = request.parameters;
  const double common = parameters.number("hold.pressure", 0.5, "", 0, 1, "pressure of all muscles, fraction of full scale");
  for (int i = 0; i < request.muscle_count; ++i)
    pressures_.push_back(parameters.number(fmt::format("hold.pressure_{}", i), common, "", 0, 1,
                                           fmt::format("pressure of muscle {}, fraction of full scale", i)));
}

}  // namespace musclesim
