/// How fast a muscle's length changes.
#pragma once

#include "musclesim/robot/actuator.h"

namespace musclesim {

/// Rate of a muscle's length over the last internal step:
///     v = (l - l_before) / h
class LengthRate {
 public:
  explicit LengthRate(const Actuator& actuator) : actuator_(&actuator) {}
  /// The length now is that at the beginning of an internal step of h_s seconds.
  void beginStep(double h_s) {
    length_before_mm_ = actuator_->lengthMm();
    step_s_ = h_s;
  }
  /// The muscle has been at rest until now.
  void reset() { step_s_ = 0; }
  /// Positive: it gets longer. 0 before the first step.
  double mmPerS() const { return step_s_ > 0 ? (actuator_->lengthMm() - length_before_mm_) / step_s_ : 0; }

 private:
  const Actuator* actuator_;
  double length_before_mm_ = 0, step_s_ = 0;
};

}  // namespace musclesim
