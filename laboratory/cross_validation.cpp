#include "cross_validation.h"

#include "musclesim/base/error.h"
#include "point_groups.h"

namespace musclesim {

namespace {

/// Fits all points but one group and returns the error at the points of the group.
FitError errorWithout(const PointGroup& group, const LawModel& model, const StaticPoints& points, const LawFit& fit) {
  std::vector<bool> is_left_out(points.points.size(), false);
  for (const std::size_t i : group.of) is_left_out[i] = true;
  StaticPoints rest = points;
  std::vector<StaticPoint> left_out;
  rest.points.clear();
  for (std::size_t i = 0; i < points.points.size(); ++i) (is_left_out[i] ? left_out : rest.points).push_back(points.points[i]);
  return errorOf(*model.build(fitParameters(model, rest, {fit.parameters})), left_out);
}

/// Whether a group has points to predict.
bool hasMeasured(const PointGroup& group, const StaticPoints& points) {
  for (const std::size_t i : group.of)
    if (!points.points[i].censored && !points.points[i].outlier) return true;
  return false;
}

/// Adds the errors of all groups to `inner` and `outer`. Returns the number of inner groups.
int validate(const std::vector<PointGroup>& groups, const LawModel& model, const StaticPoints& points, const LawFit& fit, FitError& inner,
             FitError& outer) {
  int inner_count = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (!hasMeasured(groups[i], points)) continue;
    const bool is_inner = i > 0 && i + 1 < groups.size();
    inner_count += is_inner;
    (is_inner ? inner : outer).add(errorWithout(groups[i], model, points, fit));
  }
  return inner_count;
}

}  // namespace

FitError CrossValidation::both() const {
  FitError sum = lengths;
  sum.add(pressures);
  return sum;
}

CrossValidation crossValidate(const LawModel& model, const StaticPoints& points, const LawFit& fit) {
  CrossValidation result;
  result.length_count = validate(groupByLength(points.points), model, points, fit, result.lengths, result.outer_lengths);
  result.pressure_count = validate(groupByPressure(points.points), model, points, fit, result.pressures, result.outer_pressures);
  return result;
}

}  // namespace musclesim
