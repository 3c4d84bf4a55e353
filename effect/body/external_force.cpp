#include "external_force.h"

namespace musclesim {

EffectInfo ExternalForce::info() {
  return {.id = "external_force",
          .stage = Stage::body,
          .acts_on = {ComponentKind::hand},
          .summary = "a constant force on the hand",
          .equation = "F = (force_x_N, force_y_N, force_z_N) at the hand, world frame",
          .signature = "joint torques follow the hand's Jacobian; present even with vented muscles",
          .source = "definition",
          .parameters = {{"force_x_N", "N", 0, -1e4, 1e4, -10, 10, "component to the side"},
                         {"force_y_N", "N", 0, -1e4, 1e4, -10, 10, "component upward"},
                         {"force_z_N", "N", 0, -1e4, 1e4, -10, 10, "component to the front"}},
          .make = [](const EffectValues& values) {
            return std::make_unique<ExternalForce>(Vector(values["force_x_N"], values["force_y_N"], values["force_z_N"]));
          }};
}

}  // namespace musclesim
