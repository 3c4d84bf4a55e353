#include "base_tilt.h"

#include <Eigen/Geometry>

#include "musclesim/base/units.h"
#include "musclesim/robot/world.h"

namespace musclesim {

EffectInfo BaseTilt::info() {
  return {.id = "base_tilt",
          .stage = Stage::body,
          .acts_on = {ComponentKind::base},
          .summary = "the robot does not stand upright",
          .equation = "g' = R_z(tilt_z_deg) R_x(tilt_x_deg) g    g gravity, R rotations about the world's axes",
          .signature = "error of a gravity torque shifted in angle, the same shift for all joints",
          .source = "definition",
          .parameters = {{"tilt_x_deg", "deg", 0, -180, 180, -8, 8, "rotation of gravity about x"},
                         {"tilt_z_deg", "deg", 0, -180, 180, -8, 8, "rotation of gravity about z"}},
          .make = [](const EffectValues& values) { return std::make_unique<BaseTilt>(values["tilt_x_deg"], values["tilt_z_deg"]); },
          .variants = Variants::strengths};
}

void BaseTilt::attach(const EffectPlace& place) {
  const Vector g = Eigen::AngleAxisd(tilt_z_deg_ * rad_per_deg, Vector::UnitZ()) *
                   (Eigen::AngleAxisd(tilt_x_deg_ * rad_per_deg, Vector::UnitX()) * place.world.gravityMmPerS2());
  dWorldSetGravity(place.world, g.x(), g.y(), g.z());
}

}  // namespace musclesim
