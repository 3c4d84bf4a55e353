/// How well a law predicts lengths and pressures that it was not fitted to.
#pragma once

#include "law_fit.h"

namespace musclesim {

/// Errors at points of whole lengths and whole pressures, each predicted by a fit to all other points. The outermost lengths and pressures
/// are apart: there a law has to extrapolate, which no map of the others can tell it.
struct CrossValidation {
  FitError lengths, pressures;              ///< the inner ones
  FitError outer_lengths, outer_pressures;  ///< the shortest and the longest, the lowest and the highest
  int length_count = 0, pressure_count = 0;

  /// Inner lengths and inner pressures together.
  FitError both() const;
};

/// Fits start from the fit to all points.
CrossValidation crossValidate(const LawModel& model, const StaticPoints& points, const LawFit& fit);

}  // namespace musclesim
