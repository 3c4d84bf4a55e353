#include "verdict.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "../../base/parallel.h"
#include "../isolation/substitution.h"
#include "../search/gap_reduction.h"
#include "../words/sentences.h"

namespace musclesim {

namespace {

constexpr double named = 0.5;  ///< probability above which an explanation, or none_of_these, is the answer

std::vector<std::string> labelsOf(const Model& model) {
  std::vector<std::string> labels;
  for (const ActiveEffect& effect : model.effects) labels.push_back(effect.id + "@" + effect.component);
  return labels;
}

void accept(const Attempt& attempt, Diagnosis& diagnosis) {
  diagnosis.verdict = Verdict::effects_found;
  diagnosis.after = attempt.after;
  diagnosis.chosen = attempt.effects;
  diagnosis.chosen_effects = attempt.active_effects;
  diagnosis.reduction_percent = attempt.reduction_percent;
  diagnosis.reduction_low_percent = attempt.reduction_low_percent;
  diagnosis.reduction_high_percent = attempt.reduction_high_percent;
}

/// Whether a model without effects explains the fitted data nearly as well: with its numbers within their tolerances, or with a refit of
/// what is never measured, which pays for its numbers as an explanation pays for its parameters.
bool numbersDoAsWell(const Search& search, const Eigen::VectorXd& refitted, double score) {
  const Comparison& comparison = search.fitComparison();
  const auto number_count = static_cast<double>(comparison.plant().nominalParameters().size());
  const double of_refit = -comparison.misfit(refitted) - prices.parameters * number_count;
  return score < clearly + std::max(of_refit, search.nothing().score);
}

/// Offers the model without effects, with its numbers fitted, and its residual on the held-out rows. Offers nothing if it diverges.
Offer numbersAlone(const Search& search, const HeldOut& held_out) {
  const Eigen::VectorXd residual = held_out.comparison.residualOf(search.modelOf(search.nothing()));
  if (!residual.size()) return {};
  return {search.nothing(), residual};
}

/// Measures the controls, the negative one with as many disturbances as the best explanation has coordinates. True if
/// numbersDoAsWell().
bool measureControls(const Search& search, const HeldOut& held_out, const DiagnosisOptions& options, const OnSimulation& on_simulation,
                     Diagnosis& diagnosis) {
  const Explanation& best = search.explanations().front();
  const Comparison& comparison = search.fitComparison();
  ControlResidual nominal;
  Eigen::VectorXd negative_control;
  parallelFor(2, options.job_count, [&](int i) {
    if (i == 0)
      nominal = nominalRefit(comparison, held_out.comparison, on_simulation);
    else
      negative_control =
          negativeControlResidual(comparison, held_out.comparison, static_cast<int>(best.z.size()), options.seed, on_simulation);
  });
  const auto percentOf = [&](const Eigen::VectorXd& residual) { return residual.size() ? held_out.reductionPercent(residual) : 0.0; };
  diagnosis.nominal_refit_percent = std::max(percentOf(nominal.held_out), percentOf(numbersAlone(search, held_out).after));
  diagnosis.negative_control_percent = percentOf(negative_control);
  return numbersDoAsWell(search, nominal.fitted, search.likeliest().score);
}

/// Whether no signal stands out of its noise, or only by a SmallGap, which is then told.
bool isSmall(const Comparison& comparison, const Eigen::VectorXd& residual, const DiagnosisOptions& options,
             std::optional<SmallGap>& told) {
  if (isWithinNoise(comparison, residual)) return true;
  const SmallGap left = largestBesideMotion(comparison, residual);
  if (!(left.percent_of_motion < options.smallest_gap_percent)) return false;
  told = left;
  return true;
}

/// Whether the numbers of the model leave no gap or a SmallGap on the fitted recordings, and are so near to what was given that no
/// explanation is clearly ahead for their sake.
bool numbersSuffice(const Search& search, const DiagnosisOptions& options) {
  const Explanation& no_effect = search.nothing();
  std::optional<SmallGap> left;
  return no_effect.numbers.size() > 0 && costOfNumbers(no_effect.numbers) <= clearly &&
         no_effect.residual.size() == search.fitComparison().size() && isSmall(search.fitComparison(), no_effect.residual, options, left);
}

/// Reports the gap with fitted numbers; `are_all` says that no more than noise or a SmallGap is left, so that the verdict is `no_gap`.
void acceptNumbers(const Eigen::VectorXd& after, const HeldOut& held_out, bool are_all, Diagnosis& diagnosis) {
  diagnosis.after = held_out.comparison.gap(after);
  diagnosis.reduction_percent = diagnosis.reduction_low_percent = diagnosis.reduction_high_percent = held_out.reductionPercent(after);
  if (!are_all) return;
  diagnosis.nominal_refit_percent = diagnosis.reduction_percent;
  diagnosis.verdict = Verdict::no_gap;
  diagnosis.notes.push_back("the gap is no larger than the tolerances of the model's numbers explain");
}

/// RMS over the noise floor of each signal of the held-out rows under a model; empty if it diverges.
std::map<std::string, double> heldOutRatios(const HeldOut& held_out, const Model& model) {
  std::map<std::string, double> ratios;
  const Eigen::VectorXd residual = held_out.comparison.residualOf(model);
  if (!residual.size()) return ratios;
  for (const auto& [signal, gap] : held_out.comparison.gap(residual).per_signal) ratios[signal] = overNoise(gap);
  return ratios;
}

/// Whether each effect of an explanation is needed to make noise of a signal of the held-out rows that stands out clearly in the model as
/// it was given and with its numbers fitted: a pressure that a dead time explains, however far something unknown turns the joint. Effects
/// that only make up for each other are not needed for any signal that stood out.
bool eachExplainsASignal(const Search& search, const HeldOut& held_out, const Explanation& explanation) {
  constexpr double clear = 3;  // noise floors: the least that a cause must make to be demanded in the check on withheld causes
  const auto ratios = [&](const Explanation& one) { return heldOutRatios(held_out, search.modelOf(one)); };
  const std::map<std::string, double> as_given = heldOutRatios(held_out, Model{}), with_numbers = ratios(search.nothing()),
                                      with_all = ratios(explanation);
  for (std::size_t member = 0; member < explanation.members.size(); ++member) {
    std::map<std::string, double> without = ratios(search.causes().without(explanation, member));
    if (std::ranges::none_of(with_all, [&](const auto& left) {
          const auto standsOut = [&](const std::map<std::string, double>& in) {
            const auto found = in.find(left.first);
            return found != in.end() && found->second > clear;
          };
          return left.second < agrees && standsOut(as_given) && standsOut(with_numbers) && standsOut(without);
        }))
      return false;
  }
  return !explanation.members.empty();
}

}  // namespace

double HeldOut::reductionPercent(const Eigen::VectorXd& residual) const {
  return gapReductionPercent(comparison.gap(before), comparison.gap(residual));
}

Offer judge(const Search& search, const HeldOut& held_out, const DiagnosisOptions& options, const OnSimulation& on_simulation,
            Diagnosis& diagnosis) {
  if (search.explanations().empty()) return {};
  const Explanation& best = search.explanations().front();
  const double likeliest = search.likeliest().probability, ahead = std::log(likeliest / search.nothing().probability);  // nats
  if (ahead < 0 || (likeliest <= named && (ahead < clearly || numbersSuffice(search, options)))) {
    Offer numbers = numbersAlone(search, held_out);
    const bool are_all = numbers.after.size() > 0 && isSmall(held_out.comparison, numbers.after, options, diagnosis.small_gap);
    if (are_all || ahead < 0) {
      if (numbers.after.size() > 0) acceptNumbers(numbers.after, held_out, are_all, diagnosis);
      return numbers;
    }
  }
  const Model model = search.modelOf(best);
  const Eigen::VectorXd after = held_out.comparison.residualOf(model);
  if (!after.size()) return {};
  const bool numbers_do_as_well = measureControls(search, held_out, options, on_simulation, diagnosis);
  if (search.causes().plant().interrupted()) return {};
  const Estimate interval = gapReductionInterval({held_out.comparison, held_out.before, after},
                                                 {search.fitComparison(), search.nominalResidual(), best.residual}, options.seed);
  const Gap gap_after = held_out.comparison.gap(after);
  const Attempt attempt{labelsOf(model), model.effects, gap_after, held_out.reductionPercent(after), interval.low, interval.high};
  const double left_of_rms = std::sqrt(std::max(0.0, 1 - attempt.reduction_percent / 100));
  // An explanation that removes most of the RMS on unseen data is of use, whatever its causes really are.
  const bool is_of_use = std::min(left_of_rms, search.somethingElse()) <= named;
  // Numbers that are off may make most of a gap. What an unlikely explanation removes beside them must be more than theirs alone.
  const bool beats_numbers = likeliest > named ? attempt.reduction_percent > diagnosis.nominal_refit_percent
                                               : clearlyBeats(attempt.reduction_percent, diagnosis.nominal_refit_percent);
  const bool beats_controls = beats_numbers && clearlyBeats(attempt.reduction_percent, diagnosis.negative_control_percent);
  // Or it is a part of the whole: of all signals together it may remove little.
  const bool found = !numbers_do_as_well &&
                     ((is_of_use && beats_controls) || (attempt.reduction_percent > 0 && eachExplainsASignal(search, held_out, best)));
  if (found) {
    const double on_held_out = probabilityOfUnknown(shareOfMisfitLeft(held_out.comparison, held_out.before, after));
    diagnosis.none_of_these = stand_in_share * std::min(named, std::max(search.somethingElse(), on_held_out));
  }
  // Not offered, because it does not hold on the held-out data or gains no more than a control.
  if (!found && attempt.reduction_percent <= std::max({0.0, diagnosis.nominal_refit_percent, diagnosis.negative_control_percent}))
    return {};
  if (found)
    accept(attempt, diagnosis);
  else
    diagnosis.attempt = attempt;
  return {best, after};
}

}  // namespace musclesim
