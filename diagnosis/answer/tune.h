/// Fits parameters of the model that nobody measured, before the gap is diagnosed.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "../model/plant.h"
#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

struct Tuning {
  std::vector<TunedParameter> parameters;
  long simulation_count = 0;
  double simulated_s = 0;
};

/// Fits options.tune to the fitting part of the recordings (never to held-out data) without any effect, stores the values in
/// options.model.parameters and returns them. Throws BadParameter for a name that is no number of the model, or whose value is 0.
Tuning tune(const std::vector<Recording>& recordings, DiagnosisOptions& options);

/// The plant's tuned parameters at coordinates eta, with 95 % intervals from the half widths; `start` is the value that the user gave.
std::vector<TunedParameter> tunedParameters(const Plant& plant, const Eigen::VectorXd& eta, const Eigen::VectorXd& half_width);

}  // namespace musclesim
