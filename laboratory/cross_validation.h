/// How well a law predicts lengths and pressures that it was not fitted to.
#pragma once

#include <string>
#include <vector>

#include "law_fit.h"

namespace musclesim {

/// Cross-validated errors; missing where the points outside of one of the groups are too few for a fit. Each group, all points of one
/// length or of one pressure, is predicted by a fit to all other points. The outermost lengths and pressures are counted separately,
/// because there the fit must extrapolate.
struct CrossValidation {
  FitError lengths, pressures;              ///< inner groups
  FitError outer_lengths, outer_pressures;  ///< the shortest and the longest, the lowest and the highest
  int length_count = 0, pressure_count = 0;
  std::vector<std::string> notes;  ///< why errors are missing

  /// Inner lengths and inner pressures together.
  FitError both() const;
};

/// All fits start from the fit to all points.
CrossValidation crossValidate(const LawModel& model, const StaticPoints& points, const LawFit& fit);

}  // namespace musclesim
