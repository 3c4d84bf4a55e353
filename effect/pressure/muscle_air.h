/// The balance of the air in one muscle: a valve of finite speed fills and vents it, and a leak or a change of volume acts meanwhile.
///     dp/dt = (u - p) / tau + sum over terms of (gain - loss p)
/// u delivered pressure, p pressure behind the valve (behind the first lag of a valve of three), fractions of full scale; tau is the
/// valve's time constant, loss (1/s) and gain (1/s) are those of a leak or a change of volume. Effects of this kind that follow each other
/// on one muscle share the balance and the valve of the first of them: a leak beside a valve lag is a term of the lag's equation and brings
/// no valve of its own. Behind a limited flow a balance of its own begins, since the limit is no term of the one before it. A second valve
/// lag is a lag in series.
#pragma once

#include <vector>

#include "musclesim/effect/effect_info.h"

namespace musclesim {

/// dp/dt beside the valve: gain_per_s - loss_per_s p.
struct AirRate {
  double loss_per_s = 0, gain_per_s = 0;
};

class MuscleAir : public MuscleRatioEffect {
 public:
  /// Whether it is a term that the balance of another valve can hold; a valve lag is none.
  virtual bool isTerm() const { return true; }
  /// Makes the other effect, which acts on the same muscle, a term of this one's balance. From then on it passes on what comes in.
  void takeUp(MuscleAir& other);

 protected:
  /// What this effect adds to the balance at pressure p.
  virtual AirRate ownRate(double pressure) const = 0;
  /// The pressure at the end of a step, where this effect holds the balance. The effect keeps it as its state.
  virtual double filled(double input, const StepTime& time) = 0;
  /// The pressure after `input` has been there for ever. The effect keeps it as its state, too.
  virtual double settledAir(double input) = 0;

  /// Whether it has taken up other effects.
  bool hasTerms() const { return !terms_.empty(); }
  /// Loss and gain of this effect and of all that it has taken up, summed.
  AirRate rate(double pressure) const;
  /// p, 0 at least, at the end of a step of h_s that begins at `pressure`. Exact if u, loss and gain are constant; loss and gain are those
  /// of the beginning.
  double pressureAfter(double h_s, double pressure, double u, double time_constant_s) const;
  /// p at which the valve replaces what is lost, for constant u and a muscle whose length does not change; by bisection.
  double heldPressure(double u, double time_constant_s) const;

 private:
  double output(double input, const StepTime& time) final { return is_taken_up_ ? input : filled(input, time); }
  double settled(double input) final { return is_taken_up_ ? input : settledAir(input); }

  std::vector<const MuscleAir*> terms_;
  bool is_taken_up_ = false;
};

}  // namespace musclesim
