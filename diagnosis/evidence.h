/// How believable fitted explanations are: misfit, price of complexity, probabilities.
#pragma once

#include <vector>

#include "comparison.h"
#include "explanation.h"

namespace musclesim {

/// Prices in nats; docs/developer/diagnosis.md says on which plants they were found.
struct Weighing {
  double per_parameter = 1.0;   ///< of a fitted coordinate
  double per_effect = 3.1;      ///< of an effect beyond the first
  double per_same_place = 1.0;  ///< extra if it shares a place with an earlier one: it may only correct that one's law
  double per_excess = 1.0;      ///< per e-fold by which a parameter exceeds its usual range
  double shared_sensor = 4.0;   ///< extra for a fault that all sensors share
  double per_share_left = 12;     ///< ln odds of something else, per share of the misfit that the best explanation leaves
  double share_of_unknown = 0.3;  ///< share at which it is as likely as not
};

class Evidence {
 public:
  /// References must outlive the object.
  Evidence(const Comparison& comparison, const Eigen::VectorXd& nominal_residual, const Causes& causes)
      : comparison_(comparison), nominal_residual_(nominal_residual), causes_(causes) {}

  /// Price of the effects and their coordinates, in nats.
  double price(const Explanation& explanation) const;
  /// ln of the odds up to a constant: -misfit - price - sum of numbers^2 / 2; minus infinity with an inactive effect.
  double score(const Explanation& explanation) const;
  /// ln odds that something acts which the best of some explanations does not hold: the right one leaves a small share of the misfit.
  double ofSomethingElse(const std::vector<Explanation>& explanations) const;

 private:
  bool actsWhereOthersDo(const Explanation& explanation, std::size_t member) const;

  const Comparison& comparison_;
  const Eigen::VectorXd& nominal_residual_;
  const Causes& causes_;
  Weighing weighing_;
};

}  // namespace musclesim
