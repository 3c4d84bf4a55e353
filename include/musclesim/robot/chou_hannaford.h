/// Force law of an ideal braid, with correction terms for a real one.
#pragma once

#include "musclesim/robot/force_law.h"

namespace musclesim {

/// Constants of ChouHannafordForceLaw, read from the parameters "force_law.*". The defaults are the least-squares fit to Eq. 1 with the
/// paper's constants for l_min/l_max = 0.4, 0 <= p <= 1 (relative squared error 1.6e-2).
struct ChouHannafordConstants {
  explicit ChouHannafordConstants(Parameters& parameters);
  ChouHannafordConstants() = default;
  double braid_N = 63.531;          ///< A = 3 P l_0^2 / (4 pi n^2), P full-scale pressure, n turns of a strand
  double bore_N = -5.939;           ///< B = P b^2 / (4 pi n^2), b length of a strand
  double elastic_N = 0;             ///< C: elastic force per relative stretch
  double threshold_N = 4.913;       ///< D: force lost before the hose presses on the braid
  double stretch_N = 49.392;        ///< E: force of the stretched hose at rest length
  double stretch_exponent = 5.934;  ///< beta: rate at which the stretch force decays with contraction
};

/// The force of a braid of inextensible strands, from virtual work, with three corrections:
///     F(p, l) = max(0, p (A s^2 - B) + C (s - 1) - D + E exp(beta (s - 1))),    s = l / l_0
/// p pressure (fraction of full scale), l length, l_0 rest length. Beyond l_0 the exponential continues as its tangent, 1 + beta (s - 1). A
/// slack muscle does not push. Source: Chou and Hannaford 1996 for A and B (Eq. 10: F = P b^2 (3 cos^2 - 1) / (4 pi n^2)); the corrections
/// are the elastic, threshold and stretch forces seen in measured maps, see docs/user/laboratory.md.
class ChouHannafordForceLaw final : public ForceLaw {
 public:
  /// Throws BadParameter unless the rest length is positive, all constants are finite and beta is not negative.
  ChouHannafordForceLaw(double rest_length_mm, const ChouHannafordConstants& constants);
  double tensionN(double pressure_ratio, double length_mm) const override;
  double formulaN(double pressure_ratio, double length_mm) const override;
  std::string name() const override { return "chou-hannaford"; }
  std::optional<double> restLengthMm() const override { return rest_length_mm_; }

 private:
  double rest_length_mm_;
  ChouHannafordConstants constants_;
};

}  // namespace musclesim
