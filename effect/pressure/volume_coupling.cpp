#include "volume_coupling.h"

#include <algorithm>
#include <cmath>

#include "atmosphere.h"
#include "musclesim/robot/actuator.h"

namespace musclesim {

EffectInfo VolumeCoupling::info() {
  return {.id = "volume_coupling",
          .stage = Stage::pressure,
          .acts_on = {ComponentKind::muscle},
          .summary = "stretching a muscle compresses the air in it",
          .equation =
              "dp/dt = (u - p) / tau - n (p + p_atm) (dV/dt) / V, V ~ 1 + v_0 - r^2, r = (l - l_c) / (l_0 - l_c)    u delivered, p actual, "
              "l length, l_0 rest length of the force law, l_c where it stops pulling at full pressure; with a valve lag or a leak on the "
              "muscle, the second term is one of that effect's equation",
          .signature = "pushing the joint at constant command changes the pressure",
          .source = "polytropic gas in a changing volume; volume from virtual work as in Chou and Hannaford 1996",
          .parameters = {{"polytropic_exponent", "", 0, 0, 2, 1, 1.4, "n; 1: isothermal, 1.4: adiabatic"},
                         {"regulator_time_constant_s", "s", 0.1, 1e-4, 10, 0.02, 0.5,
                          "tau, where neither a valve lag nor a leak acts on the muscle", true},
                         {"rest_volume_ratio", "", 1, 0.05, 100, 0.5, 3,
                          "v_0, volume at rest length over the change of volume from l_c to rest length", true}},
          .make = [](const EffectValues& values) {
            return std::make_unique<VolumeCoupling>(values["polytropic_exponent"], values["regulator_time_constant_s"],
                                                    values["rest_volume_ratio"]);
          }};
}

void VolumeCoupling::attach(const EffectPlace& place) {
  MuscleAir::attach(place);
  contracted_mm_ = actuator().contractedLengthMm();
  range_mm_ = actuator().restLengthMm() - contracted_mm_;
}

double VolumeCoupling::relativeVolumeRatePerS() const {
  const double r = std::clamp((actuator().lengthMm() - contracted_mm_) / range_mm_, 0.0, 1.0);
  return -2 * r * lengthRateMmPerS() / range_mm_ / (1 + rest_volume_ratio_ - r * r);
}

AirRate VolumeCoupling::ownRate(double) const {
  const double squeeze_per_s = exponent_ * relativeVolumeRatePerS();
  return {squeeze_per_s, -squeeze_per_s * atmosphere_ratio};
}

double VolumeCoupling::filled(double input, const StepTime& time) {
  return pressure_ = pressureAfter(time.h_s, pressure_, input, regulator_s_);
}

}  // namespace musclesim
