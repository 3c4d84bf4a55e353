#include "cross_validation.h"

#include <fmt/format.h>

#include "point_groups.h"

namespace musclesim {

namespace {

FitError missing() {
  FitError error;
  error.is_missing = true;
  return error;
}

/// Fits all points but one group and returns the error at the points of the group, or a missing one if the others are too few for a fit.
FitError errorWithout(const PointGroup& group, const LawModel& model, const StaticPoints& points, const LawFit& fit) {
  std::vector<bool> is_left_out(points.points.size(), false);
  for (const std::size_t i : group.of) is_left_out[i] = true;
  StaticPoints rest = points;
  std::vector<StaticPoint> left_out;
  rest.points.clear();
  for (std::size_t i = 0; i < points.points.size(); ++i) (is_left_out[i] ? left_out : rest.points).push_back(points.points[i]);
  if (rest.measured().size() < fewestPointsFor(model)) return missing();
  return errorOf(*model.build(fitParameters(model, rest, {fit.parameters})), left_out);
}

/// Whether a group has points to predict.
bool hasMeasured(const PointGroup& group, const StaticPoints& points) {
  for (const std::size_t i : group.of)
    if (!points.points[i].censored && !points.points[i].outlier) return true;
  return false;
}

/// The errors of inner and outer groups, their number, and a note if a group cannot be left out.
struct Validation {
  FitError inner, outer;
  int inner_count = 0;
  std::string note;
};

Validation validate(const std::string& quantity, const std::vector<PointGroup>& groups, const LawModel& model, const StaticPoints& points,
                    const LawFit& fit) {
  Validation result;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (!hasMeasured(groups[i], points)) continue;
    const bool is_inner = i > 0 && i + 1 < groups.size();
    result.inner_count += is_inner;
    FitError& sum = is_inner ? result.inner : result.outer;
    if (sum.is_missing) continue;
    sum.add(errorWithout(groups[i], model, points, fit));
    if (!sum.is_missing) continue;
    result.note = fmt::format("not cross-validated over {} {}: without the {} points of one, fewer than {} are left",
                              is_inner ? "inner" : "outer", quantity, groups[i].of.size(), fewestPointsFor(model));
  }
  return result;
}

}  // namespace

FitError CrossValidation::both() const {
  FitError sum = lengths;
  sum.add(pressures);
  return sum;
}

CrossValidation crossValidate(const LawModel& model, const StaticPoints& points, const LawFit& fit) {
  const Validation over_lengths = validate("lengths", groupByLength(points.points), model, points, fit);
  const Validation over_pressures = validate("pressures", groupByPressure(points.points), model, points, fit);
  CrossValidation result{over_lengths.inner,
                         over_pressures.inner,
                         over_lengths.outer,
                         over_pressures.outer,
                         over_lengths.inner_count,
                         over_pressures.inner_count,
                         {}};
  for (const Validation* validation : {&over_lengths, &over_pressures})
    if (!validation->note.empty()) result.notes.push_back(validation->note);
  return result;
}

}  // namespace musclesim
