/// Sarosi's exponential force law.
#pragma once

#include "musclesim/robot/force_law.h"

namespace musclesim {

/// Constants of SarosiForceLaw, read from the parameters "force_law.*". The defaults reproduce Eq. 1 with the paper's constants for
/// l_min/l_max = 0.4, which is a special case of this law.
struct SarosiConstants {
  explicit SarosiConstants(Parameters& parameters);
  SarosiConstants() = default;
  /// Constants that give the force of Eq. 1 at every pressure and every length up to l_max, for the rest length l_0 = l_max.
  static SarosiConstants ofEquation1(const BraunConstants& braun, double minimum_length_ratio);
  double a1_N = -73.43013458532967;
  double a2_N = 73.43013458532967;
  double a3 = -15.339822963360964;
  double a4_N = -160.22303833144537;
  double a5_N = 96.13382299886722;
  double a6_N = 0;
};

/// An empirical law of fluidic muscles:
///     F(p, k) = max(0, (a1 p + a2) exp(a3 k) + a4 k p + a5 p + a6),    k = 1 - l / l_0
/// p pressure (fraction of full scale), k contraction, l length, l_0 rest length. Beyond l_0 the exponential continues as its tangent, 1 +
/// a3 k. A slack muscle does not push. Source: Sarosi 2012, "New approximation algorithm for the force of fluidic muscles" (six constants;
/// in that paper pressures are in kPa and k in percent).
class SarosiForceLaw final : public ForceLaw {
 public:
  /// Throws BadParameter unless the rest length is positive and all constants are finite.
  SarosiForceLaw(double rest_length_mm, const SarosiConstants& constants);
  double tensionN(double pressure_ratio, double length_mm) const override;
  double formulaN(double pressure_ratio, double length_mm) const override;
  std::string name() const override { return "sarosi"; }
  std::optional<double> restLengthMm() const override { return rest_length_mm_; }

 private:
  double rest_length_mm_;
  SarosiConstants constants_;
};

}  // namespace musclesim
