/// Static force laws of a muscle: tension from pressure and length.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "musclesim/base/parameters.h"

namespace musclesim {

/// F(p, l) of one muscle.
class ForceLaw {
 public:
  virtual ~ForceLaw() = default;
  /// Tension in N, pulling positive, at pressure `pressure_ratio` (fraction of full scale) and length `length_mm`.
  virtual double tensionN(double pressure_ratio, double length_mm) const = 0;
  /// The law's formula in N. Unlike tensionN it may be negative for a slack muscle; a fit compares it with measurements.
  virtual double formulaN(double pressure_ratio, double length_mm) const { return tensionN(pressure_ratio, length_mm); }
  /// dF/dl in N/mm. The default is a central difference over 0.02 mm.
  virtual double stiffnessNPerMm(double pressure_ratio, double length_mm) const;
  virtual std::string name() const = 0;
  /// Length in mm to which the law refers, that of the muscle at rest: s = 1, or r = 1 in Eq. 1. The default: none.
  virtual std::optional<double> restLengthMm() const { return {}; }
  /// Length in mm at which a muscle under full pressure has stopped pulling: the zero of formulaN(1, l) next below the rest length, 0 where
  /// there is none. None without a rest length.
  virtual std::optional<double> contractedLengthMm() const;
};

/// Constants of Eq. 1, read from the parameters "force_law.*". A fit to a real muscle may give a and b of either sign.
struct BraunConstants {
  explicit BraunConstants(Parameters& parameters);
  BraunConstants() = default;
  double a = 7.687724845623249e-5;      ///< share of the vented muscle's rubber force
  double b = 9.203893778016578;         ///< exponent of that force
  double c_kgf = 9.799574209874333;     ///< force at full length and full pressure, kilogram-force
  double pressure_maximum_ratio = 1.0;  ///< p_max, in the unit of p
};

/// The paper's fitted law:
///     F(p, l) = c (p/p_max r + a (1 - p/p_max) exp(b r)),    r = (l - l_min) / (l_max - l_min)    (Eq. 1)
/// p pressure, l length, l_min and l_max the muscle's shortest and longest length. The fitted loads were masses, so c is in kilogram-force
/// and the tension in N is 9.81 F. Valid for 0 <= p <= p_max and l_min <= l <= l_max; outside this range the formula is evaluated
/// unchanged. Source: Braun 2007, Section 3.2; constants of the published program.
class BraunForceLaw final : public ForceLaw {
 public:
  /// Throws BadParameter unless 0 <= minimum < maximum length, all constants are finite and p_max is not 0.
  BraunForceLaw(double minimum_length_mm, double maximum_length_mm, const BraunConstants& constants = {});
  double tensionN(double pressure_ratio, double length_mm) const override;
  double stiffnessNPerMm(double pressure_ratio, double length_mm) const override;
  std::string name() const override { return "braun"; }
  std::optional<double> restLengthMm() const override { return l_max_mm_; }
  /// l_min, where r = 0.
  std::optional<double> contractedLengthMm() const override { return l_min_mm_; }

 private:
  double l_min_mm_, l_max_mm_;
  BraunConstants constants_;
};

}  // namespace musclesim
