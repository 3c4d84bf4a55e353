/// The verdict: whether the best explanation holds on held-out data and beats the controls.
#pragma once

#include "../search/search.h"
#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// Nats by which an explanation is clearly ahead of another model; about 12 to 1.
inline constexpr double clearly = 2.5;

/// The held-out rows and what the unchanged model leaves of them. References must outlive the object.
struct HeldOut {
  const Comparison& comparison;
  const Eigen::VectorXd& before;
  /// Gap reduction by a model that leaves this residual.
  double reductionPercent(const Eigen::VectorXd& residual) const;
};

/// What is reported, believed or not: an explanation, and the residual on the held-out rows with it; both empty if nothing is offered.
struct Offer {
  Explanation explanation;
  Eigen::VectorXd after;
};

/// Predicts the held-out rows with the chosen explanation, measures the controls, and writes the verdict, the gap reduction and its
/// interval, or the attempt that is not believed. Without an effect that explains more than the tolerances of the model's numbers, the gap
/// with these numbers.
Offer judge(const Search& search, const HeldOut& held_out, const DiagnosisOptions& options, const OnSimulation& on_simulation,
            Diagnosis& diagnosis);

}  // namespace musclesim
