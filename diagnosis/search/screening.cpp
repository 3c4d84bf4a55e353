// Screening: one or a few simulations of every hypothesis decide which ones are fitted.
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "../../base/parallel.h"
#include "musclesim/base/error.h"
#include "search.h"

namespace musclesim {

namespace {

constexpr std::size_t many_hypotheses = 240;  ///< with more hypotheses, most are screened on the first screening segment only
constexpr std::size_t nearest_count = 80;     ///< number of them that are then screened on all segments
constexpr std::size_t per_effect_count = 3;   ///< and at least this many of every effect

}  // namespace

Comparison Search::firstScreeningSegment() const {
  Comparison result(plant_, {screening_.segments().front()}, Comparison::Derived::with);
  const Eigen::VectorXd nominal = result.predicted(Model{});
  result.goCoarse(nominal, Comparison::Purpose::screening);
  result.setGap(result.measured() - nominal);
  return result;
}

/// Keeps, of variants without a strength (numbers of bits), the two of each component with the least misfit on the screening segments,
/// chosen from the six best on the first segment and those as good as the sixth. Simulating all of them everywhere would take as long as
/// the rest of the diagnosis, and one segment alone may hardly distinguish them.
void Search::keepNearestVariants() {
  keepNearestVariants(firstScreeningSegment(), 6, Ties::kept);
  keepNearestVariants(screening_, 2, Ties::dropped);
}

void Search::keepNearestVariants(const Comparison& comparison, std::size_t kept, Ties ties) {
  std::vector<Hypothesis>& all = causes_.hypotheses;
  std::map<std::string, std::vector<std::size_t>> variants;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].coordinateCount() == 0) variants[all[i].label()].push_back(i);
  std::vector<double> misfit(all.size(), 0);
  std::vector<std::size_t> tried;
  for (const auto& [label, members] : variants)
    if (members.size() > kept) tried.insert(tried.end(), members.begin(), members.end());
  parallelFor(static_cast<int>(tried.size()), options_.job_count, [&](int i) {
    const std::size_t index = tried[static_cast<std::size_t>(i)];
    if (plant_.interrupted()) return;
    misfit[index] = comparison.misfit(comparison.residualOf(Model{{all[index].at({})}, {}}));
    on_simulation_();
  });
  std::set<std::size_t> dropped;
  for (auto& [label, members] : variants) {
    std::ranges::stable_sort(members, {}, [&](std::size_t i) { return misfit[i]; });
    if (members.size() <= kept) continue;
    auto end = members.begin() + static_cast<std::ptrdiff_t>(kept);
    if (ties == Ties::kept) end = std::find_if(end, members.end(), [&](std::size_t i) { return misfit[i] > misfit[*(end - 1)]; });
    if (end == members.end()) continue;
    dropped.insert(end, members.end());
    catalogue_.thinned.insert(label);
  }
  std::vector<Hypothesis> rest;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!dropped.contains(i)) rest.push_back(std::move(all[i]));
  all = std::move(rest);
}

/// Indices of the hypotheses that are screened on all segments. If there are many (ten muscles have ten of most kinds), those that explain
/// most of the first segment, and some of every effect. The choice does not depend on the candidates, because fault isolation must not.
std::vector<std::size_t> Search::worthScreening() const {
  const std::vector<Hypothesis>& all = causes_.hypotheses;
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), 0);
  if (all.size() <= many_hypotheses || screening_.segments().size() < 2) return order;
  const Comparison brief = firstScreeningSegment();
  std::vector<Hypothesis> hypotheses = all;
  const std::vector<Sensitivity> sensitivities =
      sensitivitiesOf(brief, hypotheses, brief.predicted(Model{}), Model{}, options_.job_count, on_simulation_);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return sensitivities[i].misfit; });
  std::map<std::string, std::size_t> per_effect;
  std::vector<std::size_t> chosen;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const bool among_first_of_effect = per_effect[all[order[rank]].info().id]++ < per_effect_count;
    const bool on_all = all[order[rank]].component() == "all";
    if (rank < nearest_count || among_first_of_effect || on_all) chosen.push_back(order[rank]);
  }
  std::ranges::sort(chosen);
  return chosen;
}

void Search::screenHypotheses(const Eigen::VectorXd& nominal) {
  const std::vector<std::size_t> chosen = worthScreening();
  std::vector<Hypothesis> hypotheses;
  for (const std::size_t i : chosen) hypotheses.push_back(causes_.hypotheses[i]);
  std::vector<Sensitivity> sensitivities = sensitivitiesOf(screening_, hypotheses, nominal, Model{}, options_.job_count, on_simulation_);
  for (const Hypothesis& hypothesis : causes_.hypotheses) {
    Sensitivity unknown;
    unknown.per_strength.resize(std::max<std::size_t>(1, hypothesis.strengths().size()));
    fitLinearly(screening_, hypothesis, screening_residual_, unknown);
    catalogue_.sensitivities.push_back(std::move(unknown));
  }
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    causes_.hypotheses[chosen[k]] = std::move(hypotheses[k]);
    catalogue_.sensitivities[chosen[k]] = std::move(sensitivities[k]);
  }
  catalogue_.screened_count = chosen.size();
}

/// An effect that shows nothing in the screening segments may show in the rest of the recordings.
void Search::checkExcitation(const std::vector<Hypothesis>& typical) {
  const std::vector<Segment>&screened = screening_.segments(), &fitted = fit_.segments();
  const bool is_all = screened.size() == fitted.size() && std::ranges::equal(screened, fitted, {}, &Segment::end_row, &Segment::end_row);
  if (is_all) return;
  const Eigen::VectorXd nominal = fit_.measured() - nominal_residual_;
  std::vector<std::size_t> hidden;
  for (std::size_t i = 0; i < typical.size(); ++i)
    if (catalogue_.allowed[i] && catalogue_.sensitivities[i].excitation_ratio.value_or(1) < 1) hidden.push_back(i);
  parallelFor(static_cast<int>(hidden.size()), options_.job_count, [&](int i) {
    const std::size_t index = hidden[static_cast<std::size_t>(i)];
    if (plant_.interrupted()) return;
    const Hypothesis& hypothesis = typical[index];
    const Eigen::VectorXd predicted = fit_.predicted(Model{{hypothesis.at(hypothesis.typical())}, {}});
    if (predicted.size() == nominal.size() && predicted.allFinite())
      catalogue_.sensitivities[index].excitation_ratio = excitationRatio(fit_, predicted - nominal);
    on_simulation_();
  });
}

void Search::screen() {
  const Eigen::VectorXd nominal = screening_.predicted(Model{});
  if (!nominal.size()) throw Diverged(0, plant_.robot(), "the model without further effects cannot follow the recordings");
  screening_residual_ = screening_.measured() - nominal;
  const Eigen::VectorXd everywhere = fit_.predicted(Model{});
  nominal_residual_ = fit_.measured() - everywhere;
  screening_.goCoarse(nominal, Comparison::Purpose::screening);
  fit_.goCoarse(everywhere);
  screening_.setGap(screening_residual_);
  fit_.setGap(nominal_residual_);
  causes_.hypotheses = musclesim::hypotheses(plant_, DiagnosisOptions{});
  keepNearestVariants();
  for (const Hypothesis& hypothesis : causes_.hypotheses) catalogue_.allowed.push_back(allows(options_, hypothesis.info().id));
  const std::vector<Hypothesis> typical = causes_.hypotheses;
  screenHypotheses(nominal);
  checkExcitation(typical);
}

}  // namespace musclesim
