// The order of a diagnosis: gap, fault isolation, effects, gap reduction, next experiment.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <variant>

#include "../base/parallel.h"
#include "actuation_phases.h"
#include "data_checks.h"
#include "fault_isolation.h"
#include "gap_reduction.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "next_experiment.h"
#include "plant.h"
#include "schedule.h"
#include "search.h"
#include "sentences.h"
#include "tune.h"
#include "unit_check.h"

namespace musclesim {

namespace {

constexpr double listed = 0.01;   ///< least probability that is listed
constexpr double named = 0.5;     ///< least probability of none_of_these that makes the verdict `unexplained`
constexpr double as_good = 0.05;  ///< explanations with at least this share of the best one's probability cannot be distinguished from it
constexpr double excited = 1;     ///< least change of a signal by a typical effect, in sigmas, for it to be excited

/// The options of the program for the diagnosed model, without the values in nominal.toml. A robot without a hand has no task.
std::string modelOptions(const Plant& plant, const std::optional<std::string>& initial_state) {
  std::string options = "--robot " + plant.robot();
  if (!plant.hasHand()) options += " --controller hold";
  if (const PhysicsKind kind = plant.model().physics().kind; kind != PhysicsKind::si) options += " --physics " + nameOf(kind);
  if (initial_state) options += " --initial-state " + *initial_state;
  for (const Parameter& parameter : plant.model().parameters().declared()) {
    if (parameter.name == "world.plane_height_mm") options += " --plane";
    const bool is_tuned = std::ranges::any_of(
        plant.numbers(), [&](const UncertainNumber& number) { return number.is_tuned && number.parameter.name == parameter.name; });
    if (parameter.value == parameter.default_value || is_tuned) continue;
    options += fmt::format(" --set {}=", parameter.name);
    options += std::visit([](const auto& any) { return fmt::format("{}", any); }, parameter.value);
  }
  return options;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Counts simulations and reports progress to the caller.
class Monitor {
 public:
  explicit Monitor(const DiagnosisOptions& options) : options_(options) {}
  void phase(const std::string& name, long expected_more) {
    const std::lock_guard lock(mutex_);
    progress_.phase = name;
    progress_.expected = progress_.done + expected_more;
    tell();
  }
  void count() {
    const std::lock_guard lock(mutex_);
    ++progress_.done;
    progress_.expected = std::max(progress_.expected, progress_.done);
    tell();
  }

 private:
  void tell() {
    if (options_.progress) options_.progress(progress_);
  }
  const DiagnosisOptions& options_;
  std::mutex mutex_;
  DiagnosisProgress progress_;
};

class Run {
 public:
  Run(std::vector<Recording> recordings, const DiagnosisOptions& options)
      : options_(options),
        monitor_(options),
        plant_(std::move(recordings), options),
        held_out_(plant_, plant_.split().held_out),
        search_(plant_, options, [this] { monitor_.count(); }) {}

  Diagnosis diagnose() {
    const auto start = std::chrono::steady_clock::now();
    describe();
    measureGap();
    screen();
    if (diagnosis_.verdict != Verdict::no_gap && diagnosis_.verdict != Verdict::not_excited) explain();
    finish();
    diagnosis_.simulation_count = plant_.simulationCount();
    diagnosis_.simulated_s = plant_.simulatedS();
    diagnosis_.wall_s = secondsSince(start);
    diagnosis_.partial = plant_.interrupted();
    return std::move(diagnosis_);
  }

 private:
  void describe() {
    diagnosis_.robot = plant_.robot();
    const auto& given = options_.model.initial_state;
    diagnosis_.model_options = modelOptions(plant_, given ? given : plant_.recordings().front().info.initial_state);
    for (const Recording& recording : plant_.recordings()) {
      diagnosis_.recordings.push_back(recording.file);
      for (const std::string& note : recording.notes) diagnosis_.notes.push_back(note);
    }
    for (const std::string& note : plant_.notes()) diagnosis_.notes.push_back(note);
    for (const auto& [name, value] : plant_.nominalParameters()) diagnosis_.refitted.push_back(name);
    diagnosis_.held_out = plant_.split().held_out_words;
    describeCandidates();
    noteEstimated(NoiseSigma::Source::quiet_rows, "the noise floor was estimated from quiet rows");
    noteEstimated(NoiseSigma::Source::range,
                  "the readings do not show their noise either, so a thousandth of their range was taken for the noise floor");
  }

  void noteEstimated(NoiseSigma::Source source, const std::string& how) {
    std::vector<std::string> names;
    for (const ComparedSignal& signal : plant_.signals())
      if (signal.sigma.source == source) names.push_back(signal.name);
    if (!names.empty()) diagnosis_.notes.push_back(fmt::format("no repeats and no noise_std of {}: {}", fmt::join(names, ", "), how));
  }

  /// Throws BadParameter if no effect is left as a candidate.
  void describeCandidates() {
    if (options_.candidates.empty() && options_.exclude.empty()) return;
    for (const Hypothesis& hypothesis : hypotheses(plant_, options_))
      if (std::ranges::find(diagnosis_.candidates, hypothesis.info().id) == diagnosis_.candidates.end())
        diagnosis_.candidates.push_back(hypothesis.info().id);
    if (diagnosis_.candidates.empty())
      throw BadParameter(fmt::format("--candidates and --exclude leave no effect that could show in recordings of {}", plant_.robot()));
  }

  void measureGap() {
    monitor_.phase("comparing the model with the recordings", static_cast<long>(plant_.recordings().size()));
    std::vector<Segment> everything = plant_.split().fit;
    everything.insert(everything.end(), plant_.split().held_out.begin(), plant_.split().held_out.end());
    std::vector<Prediction> whole(plant_.recordings().size());
    const auto count = static_cast<int>(whole.size());
    parallelFor(count, options_.job_count, [&](int i) { whole[static_cast<std::size_t>(i)] = plant_.predict(i, Model{}); });
    for (int i = 0; i < count; ++i) requireUnits(plant_, i, whole[static_cast<std::size_t>(i)]);
    const Comparison all(plant_, everything);
    const Eigen::VectorXd predicted = all.predicted(Model{}), held = held_out_.predicted(Model{});
    if (!predicted.size() || !held.size())
      throw Diverged(0, plant_.robot(), "the model without further effects cannot follow the recordings");
    before_residual_ = held_out_.measured() - held;
    diagnosis_.before = diagnosis_.after = held_out_.gap(before_residual_);
    const Eigen::VectorXd residual = all.measured() - predicted;
    const bool small = isWithinNoise(all, residual);
    if (!small && isWithinNoise(held_out_, before_residual_))
      diagnosis_.notes.push_back(
          fmt::format("there is no gap in {}: no cause can be confirmed there; put a recording that shows the gap last",
                      plant_.recordings().size() > 1 ? plant_.recordings().back().file : diagnosis_.held_out));
    diagnosis_.verdict = small ? (commandsMove(plant_.recordings()) ? Verdict::no_gap : Verdict::not_excited) : Verdict::unexplained;
    if (diagnosis_.verdict == Verdict::no_gap) diagnosis_.explanations.push_back({{}, 1});
  }

  /// Runs for every verdict, since effects that the recordings could not have shown may be present even without a gap.
  void screen() {
    monitor_.phase("screening all effects", static_cast<long>(hypotheses(plant_, DiagnosisOptions{}).size()));
    search_.screen();
    diagnosis_.unsteady = search_.fitComparison().unsteady();
    listNotExcited();
  }

  void explain() {
    if (search_.catalogue().screened_count < search_.hypotheses().size())
      diagnosis_.notes.push_back(fmt::format("of {} possible causes the {} nearest on the first recording were looked at on the others too",
                                             search_.hypotheses().size(), search_.catalogue().screened_count));
    if (plant_.interrupted()) return;
    const FaultIsolation isolation = isolateFault(search_.fitComparison(), search_.nominalResidual(), search_.screeningComparison(),
                                                  search_.hypotheses(), search_.catalogue().sensitivities);
    diagnosis_.where = isolation.places;
    diagnosis_.where_method = isolation.method;
    monitor_.phase("fitting the likely effects", 600);
    search_.decide();
    diagnosis_.none_of_these = search_.noneOfThese();
    if (!plant_.interrupted()) choose();
    listNumbers();
    list();
    listTrials();
    if (!plant_.interrupted()) proposeExperiment();
  }

  /// Labels none of whose variants would have shown; labels that were never simulated are not listed.
  void listNotExcited() {
    std::set<std::string> shown = search_.catalogue().thinned;
    for (std::size_t i = 0; i < search_.hypotheses().size(); ++i)
      if (!(search_.catalogue().sensitivities[i].excitation_ratio.value_or(excited) < excited)) shown.insert(labelOf(i));
    for (std::size_t i = 0; i < search_.hypotheses().size(); ++i) {
      const bool would_be_seen = search_.hypotheses()[i].info().id == held_effect;
      if (search_.catalogue().allowed[i] && !would_be_seen && shown.insert(labelOf(i)).second) diagnosis_.not_excited.push_back(labelOf(i));
    }
  }

  void choose() {
    if (search_.explanations().empty()) return;
    const Explanation& best = search_.explanations().front();
    if (search_.nothing().probability > best.probability) return chooseNothing();
    const Model model = search_.modelOf(best);
    const Eigen::VectorXd predicted = held_out_.predicted(model);
    if (!predicted.size()) return;
    const Eigen::VectorXd after = held_out_.measured() - predicted;
    measureControls(static_cast<int>(best.z.size()));
    if (plant_.interrupted()) return;
    const Estimate interval = gapReductionInterval({held_out_, before_residual_, after},
                                                   {search_.fitComparison(), search_.nominalResidual(), best.residual}, options_.seed);
    const Gap gap_after = held_out_.gap(after);
    const Attempt attempt{labelsOf(model), model.effects, gap_after, reductionOf(gap_after), interval.low, interval.high};
    // The share of the RMS that they leave on unseen data bounds the probability that none of these effects acts.
    const double none = std::min(std::sqrt(std::max(0.0, 1 - attempt.reduction_percent / 100)), search_.noneOfThese());
    const bool found =
        none <= named && clearlyBeats(attempt.reduction_percent, diagnosis_.nominal_refit_percent, diagnosis_.negative_control_percent);
    if (found) diagnosis_.none_of_these = none;
    // Not offered, because it does not hold on the held-out data or gains no more than a control.
    if (!found && attempt.reduction_percent <= std::max({0.0, diagnosis_.nominal_refit_percent, diagnosis_.negative_control_percent}))
      return;
    fitted_numbers_ = best;
    after_residual_ = after;
    if (found)
      accept(attempt);
    else
      diagnosis_.attempt = attempt;
  }

  /// What the tolerances of the model's numbers allow explains the gap better than any effect.
  void chooseNothing() {
    const Explanation& nothing = search_.nothing();
    const Eigen::VectorXd predicted = held_out_.predicted(search_.modelOf(nothing));
    if (!predicted.size()) return;
    fitted_numbers_ = nothing;
    after_residual_ = held_out_.measured() - predicted;
    diagnosis_.after = held_out_.gap(after_residual_);
    diagnosis_.reduction_percent = diagnosis_.reduction_low_percent = diagnosis_.reduction_high_percent = reductionOf(diagnosis_.after);
    if (!isWithinNoise(held_out_, after_residual_)) return;
    diagnosis_.verdict = Verdict::no_gap;
    diagnosis_.notes.push_back("the gap is no larger than the tolerances of the model's numbers explain");
  }

  double reductionOf(const Gap& after) const { return gapReductionPercent(diagnosis_.before, after); }

  void measureControls(int parameter_count) {
    monitor_.phase("measuring what the controls gain", 60);
    const auto count = [this] { monitor_.count(); };
    const Comparison& comparison = search_.fitComparison();
    Eigen::VectorXd nominal, negative_control;
    parallelFor(2, options_.job_count, [&](int i) {
      if (i == 0)
        nominal = nominalRefitResidual(comparison, held_out_, count);
      else
        negative_control = negativeControlResidual(comparison, held_out_, parameter_count, options_.seed, count);
    });
    const auto percentOf = [&](const Eigen::VectorXd& residual) { return residual.size() ? reductionOf(held_out_.gap(residual)) : 0.0; };
    // Within their tolerances the numbers are fitted with every explanation, so what they gain is no merit of the effects.
    const Eigen::VectorXd with_numbers = held_out_.predicted(search_.modelOf(search_.nothing()));
    const double by_numbers = with_numbers.size() ? reductionOf(held_out_.gap(held_out_.measured() - with_numbers)) : 0;
    diagnosis_.nominal_refit_percent = std::max(percentOf(nominal), by_numbers);
    diagnosis_.negative_control_percent = percentOf(negative_control);
  }

  /// What each chosen effect removes while the others are present.
  std::map<std::string, double> shares() const {
    std::map<std::string, double> result;
    if (diagnosis_.chosen.empty()) return result;
    const Explanation& chosen = search_.explanations().front();
    for (std::size_t m = 0; m < chosen.members.size(); ++m) {
      const Eigen::VectorXd predicted = held_out_.predicted(search_.modelOf(search_.causes().without(chosen, m)));
      if (!predicted.size()) continue;
      result[labelOf(chosen.members[m])] = diagnosis_.reduction_percent - reductionOf(held_out_.gap(held_out_.measured() - predicted));
    }
    return result;
  }

  /// Names the signal in which the rest stands out most, and its stage.
  void describeRemainder() {
    if (!after_residual_.size() || diagnosis_.before.normalised <= 0) return;
    const Gap left = held_out_.gap(after_residual_);
    Remainder& remainder = diagnosis_.remainder;
    remainder.is_significant = !isWithinNoise(held_out_, after_residual_);
    remainder.percent_of_gap = 100 * left.normalised / diagnosis_.before.normalised;
    remainder.probability = search_.noneOfThese();
    for (const auto& [signal, gap] : left.per_signal)
      if (const double in_sigmas = overNoise(gap); in_sigmas > remainder.in_sigmas) {
        remainder.in_sigmas = in_sigmas;
        remainder.signal = signal;
        remainder.stage = nameOf(signal.starts_with("pressure_") ? Stage::pressure
                                 : signal.starts_with("force_")  ? Stage::force
                                                                 : Stage::body);
      }
    remainder.shape = shapeOfRest(diagnosis_, remainder.signal);
    if (const std::string phase = phaseOf(held_out_, after_residual_); !phase.empty())
      remainder.shape += (remainder.shape.empty() ? "mostly while " : ", most while ") + phase;
  }

  void listNumbers() {
    for (Eigen::Index i = 0; i < fitted_numbers_.numbers.size(); ++i) {
      const auto& [parameter, tolerance, is_tuned] = plant_.numbers()[static_cast<std::size_t>(i)];
      if (is_tuned || fitted_numbers_.numbers_half_width.size() <= i) continue;
      const double eta = fitted_numbers_.numbers[i], half = fitted_numbers_.numbers_half_width[i];
      diagnosis_.numbers.push_back({parameter.name,
                                    parameter.unit,
                                    std::get<double>(parameter.value),
                                    {plant_.numberAt(i, eta), plant_.numberAt(i, eta - half), plant_.numberAt(i, eta + half), true},
                                    eta});
    }
    diagnosis_.tuned = tunedParameters(plant_, fitted_numbers_.numbers, fitted_numbers_.numbers_half_width);
  }

  void accept(const Attempt& attempt) {
    diagnosis_.verdict = Verdict::effects_found;
    diagnosis_.after = attempt.after;
    diagnosis_.chosen = attempt.effects;
    diagnosis_.chosen_effects = attempt.active_effects;
    diagnosis_.reduction_percent = attempt.reduction_percent;
    diagnosis_.reduction_low_percent = attempt.reduction_low_percent;
    diagnosis_.reduction_high_percent = attempt.reduction_high_percent;
  }

  static std::vector<std::string> labelsOf(const Model& model) {
    std::vector<std::string> labels;
    for (const ActiveEffect& effect : model.effects) labels.push_back(effect.id + "@" + effect.component);
    return labels;
  }

  std::string labelOf(std::size_t hypothesis) const { return search_.hypotheses()[hypothesis].label(); }

  /// Lists probabilities per effect and per explanation, and the ambiguity set.
  void list() {
    const double known = 1 - diagnosis_.none_of_these;  // probability that the catalogue holds the cause
    const double no_effect = known * search_.nothing().probability;
    if (no_effect >= listed) diagnosis_.explanations.push_back({{}, no_effect});
    const std::map<std::string, double> removed = plant_.interrupted() ? std::map<std::string, double>() : shares();
    std::map<std::string, FoundEffect> found;
    for (const Explanation& fitted : search_.explanations()) {
      ExplanationProbability entry{{}, known * fitted.probability};
      Eigen::Index first = 0;
      for (const std::size_t index : fitted.members) {
        const Hypothesis& hypothesis = search_.hypotheses()[index];
        entry.effects.push_back(hypothesis.label());
        FoundEffect& effect = found[hypothesis.label()];
        if (effect.id.empty()) {
          effect.id = hypothesis.info().id;
          effect.component = hypothesis.component();
          effect.parameters = estimates(hypothesis, fitted, first);
          effect.choices = hypothesis.choices();
          if (const auto share = removed.find(hypothesis.label()); share != removed.end()) effect.removes_percent = share->second;
        }
        effect.probability += known * fitted.probability;
        first += hypothesis.coordinateCount();
      }
      if (known * fitted.probability >= listed) diagnosis_.explanations.push_back(std::move(entry));
    }
    for (auto& [label, effect] : found)
      if (effect.probability >= listed) diagnosis_.effects.push_back(effect);
    std::ranges::stable_sort(diagnosis_.effects, [](const auto& a, const auto& b) { return a.probability > b.probability; });
    ambiguity();
    // An effect that was found is excited, though not at its typical strength.
    std::erase_if(diagnosis_.not_excited, [&](const std::string& label) {
      const auto& tried = diagnosis_.attempt.effects;
      return (found.contains(label) && found[label].probability >= listed) || std::ranges::find(tried, label) != tried.end();
    });
    parallelFor(static_cast<int>(diagnosis_.effects.size()), options_.job_count, [&](int i) {
      FoundEffect& effect = diagnosis_.effects[static_cast<std::size_t>(i)];
      effect.reduction_percent = singleReduction(effect.label());
    });
  }

  /// Lists the screened and the fitted hypotheses.
  void listTrials() {
    const double whole = search_.screeningComparison().misfit(search_.screeningResidual());
    for (std::size_t i = 0; i < search_.hypotheses().size(); ++i)
      if (search_.catalogue().allowed[i])
        diagnosis_.screenings.push_back({labelOf(i), whole > 0 ? 1 - search_.catalogue().sensitivities[i].misfit / whole : 0});
    std::ranges::stable_sort(diagnosis_.screenings, [](const auto& a, const auto& b) { return a.removed > b.removed; });
    const Comparison& comparison = search_.fitComparison();
    auto rmsOf = [&](const Eigen::VectorXd& residual) {
      std::vector<double> rms;
      for (const Comparison::Block& block : comparison.blocks()) rms.push_back(std::sqrt(comparison.meanSquare(block, residual)));
      return rms;
    };
    const std::vector<double> before = rmsOf(search_.nominalResidual());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Comparison::Block& block = comparison.blocks()[i];
      const auto recording = static_cast<std::size_t>(comparison.segments()[block.segment].recording);
      diagnosis_.blocks.push_back({plant_.recordings()[recording].file, plant_.signals()[static_cast<std::size_t>(block.signal)].name,
                                   block.sigma, before[i], static_cast<int>(block.averaged_rows)});
    }
    std::vector<Explanation> all = search_.explanations();
    all.push_back(search_.nothing());
    for (const Explanation& fitted : all) {
      if (fitted.residual.size() != comparison.size()) continue;
      const Evidence evidence = search_.evidence();
      const auto misfits = comparison.misfits(fitted.residual);
      const auto complexity = evidence.complexityOf(fitted).asArray();
      Trial trial{{},
                  static_cast<int>(fitted.z.size()),
                  rmsOf(fitted.residual),
                  {misfits.begin(), misfits.end()},
                  {complexity.begin(), complexity.end()},
                  0.5 * fitted.numbers.squaredNorm(),
                  fitted.score,
                  {}};
      Eigen::Index first = 0;
      for (const std::size_t index : fitted.members) {
        const Hypothesis& hypothesis = search_.hypotheses()[index];
        trial.effects.push_back(hypothesis.label());
        auto& values = trial.values.emplace_back();
        for (const auto& [name, value] : hypothesis.valuesAt(fitted.z.segment(first, hypothesis.coordinateCount()))) values[name] = value;
        first += hypothesis.coordinateCount();
      }
      diagnosis_.trials.push_back(std::move(trial));
    }
  }

  std::map<std::string, Estimate> estimates(const Hypothesis& hypothesis, const Explanation& fitted, Eigen::Index first) const {
    const Eigen::Index count = hypothesis.coordinateCount();
    const Eigen::VectorXd z = fitted.z.segment(first, count), half = fitted.half_width.segment(first, count);
    const auto at = hypothesis.valuesAt(z), one = hypothesis.valuesAt(hypothesis.clamped(z - half)),
               other = hypothesis.valuesAt(hypothesis.clamped(z + half));
    std::map<std::string, Estimate> result;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto coordinate = static_cast<Eigen::Index>(i);  // parameters that are not fitted come last
      result[at[i].first] = {at[i].second, std::min(one[i].second, other[i].second), std::max(one[i].second, other[i].second),
                             coordinate >= count || std::isfinite(half[coordinate])};
    }
    return result;
  }

  /// The best explanation, and all with at least the share as_good of its probability.
  std::vector<const Explanation*> asGood() const {
    std::vector<const Explanation*> result;
    const auto& all = search_.explanations();
    for (const Explanation& fitted : all)
      if (fitted.probability > 0 && fitted.probability >= as_good * all.front().probability) result.push_back(&fitted);
    return result;
  }

  void ambiguity() {
    const std::vector<const Explanation*> likely = asGood();
    for (const Explanation* fitted : likely) {
      const std::set<std::string> labels = search_.causes().labelsOf(fitted->members);
      diagnosis_.ambiguity_sets.emplace_back(labels.begin(), labels.end());
    }
    for (const Explanation* fitted : likely)
      if (likely.size() > 1) diagnosis_.alternatives.push_back(wordsOf(*fitted));
    for (const Explanation* fitted : likely)
      for (const std::size_t index : fitted->members)
        if (std::ranges::find(diagnosis_.ambiguity_set, labelOf(index)) == diagnosis_.ambiguity_set.end())
          diagnosis_.ambiguity_set.push_back(labelOf(index));
  }

  /// "a@x + b@y"
  std::string wordsOf(const Explanation& explanation) const {
    return fmt::format("{}", fmt::join(search_.causes().labelsOf(explanation.members), " + "));
  }

  std::optional<double> singleReduction(const std::string& label) const {
    if (plant_.interrupted()) return std::nullopt;
    for (const Explanation& fitted : search_.singles()) {
      if (labelOf(fitted.members.front()) != label) continue;
      const Eigen::VectorXd predicted = held_out_.predicted(search_.modelOf(fitted));
      if (predicted.size()) return reductionOf(held_out_.gap(held_out_.measured() - predicted));
    }
    return std::nullopt;
  }

  void proposeExperiment() {
    constexpr std::size_t most = 4;
    std::vector<const Explanation*> likely = asGood();
    if (likely.size() < 2) return;
    likely.resize(std::min(most, likely.size()));
    monitor_.phase("planning the next experiment", static_cast<long>(2 * scheduleBank().size() * likely.size()));
    std::vector<Rival> rivals;
    for (const Explanation* fitted : likely) rivals.push_back(search_.rival(*fitted, wordsOf(*fitted)));
    const Fidelity fidelity = std::min(search_.screeningComparison().fidelity(), Fidelity::coarse);
    diagnosis_.next_experiment = nextExperiment(plant_, rivals, fidelity, options_.job_count, [this] { monitor_.count(); });
  }

  void finish() {
    if (diagnosis_.before.normalised > 0) diagnosis_.unexplained_percent = 100 * diagnosis_.after.normalised / diagnosis_.before.normalised;
    addPhases();
    addTraces();
    describeRemainder();
    diagnosis_.drawing = plant_.drawing();
  }

  void addPhases() {
    if (!before_residual_.size()) return;
    const PhaseSums before = phaseSums(held_out_, before_residual_),
                    after = after_residual_.size() ? phaseSums(held_out_, after_residual_) : PhaseSums{};
    for (const ActuationPhase phase : {ActuationPhase::filling, ActuationPhase::venting, ActuationPhase::holding})
      if (before.rows[static_cast<std::size_t>(phase)] > 0)
        diagnosis_.phases.push_back({nameOf(phase), std::sqrt(before.meanSquare(phase)), std::sqrt(after.meanSquare(phase))});
  }

  void addTraces() {
    for (const Comparison::Block& block : held_out_.blocks()) {
      const int recording = held_out_.segments()[block.segment].recording;
      Trace trace{plant_.recordings()[static_cast<std::size_t>(recording)].file,
                  plant_.signals()[static_cast<std::size_t>(block.signal)].name,
                  {},
                  {},
                  {},
                  {}};
      for (std::size_t i = 0; i < block.rows.size(); ++i) {
        const auto k = block.first + static_cast<Eigen::Index>(i);
        trace.time_s.push_back(plant_.recordings()[static_cast<std::size_t>(recording)].time_s[static_cast<std::size_t>(block.rows[i])]);
        trace.measured.push_back(held_out_.measured()[k]);
        trace.before.push_back(held_out_.measured()[k] - before_residual_[k]);
        if (after_residual_.size()) trace.after.push_back(held_out_.measured()[k] - after_residual_[k]);
      }
      diagnosis_.traces.push_back(std::move(trace));
    }
  }

  const DiagnosisOptions& options_;
  Monitor monitor_;
  Plant plant_;
  Comparison held_out_;
  Search search_;
  Diagnosis diagnosis_;
  Eigen::VectorXd before_residual_, after_residual_;
  Explanation fitted_numbers_;  ///< the explanation whose numbers of the model are reported
};

}  // namespace

std::string nameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::no_gap:
      return "no_gap";
    case Verdict::effects_found:
      return "effects_found";
    case Verdict::unexplained:
      return "unexplained";
    case Verdict::not_excited:
      return "not_excited";
  }
  return "";
}

Diagnosis diagnose(std::vector<Recording> recordings, const DiagnosisOptions& options) {
  if (options.tune.empty()) return Run(std::move(recordings), options).diagnose();
  const auto start = std::chrono::steady_clock::now();
  DiagnosisOptions with_tuned = options;
  const Tuning tuning = tune(recordings, with_tuned);
  Diagnosis diagnosis = Run(std::move(recordings), with_tuned).diagnose();
  std::vector<TunedParameter> with_all;
  for (std::size_t i = 0; i < tuning.parameters.size(); ++i) {
    const Estimate with_effects = diagnosis.tuned.empty() ? tuning.parameters[i].fitted : diagnosis.tuned[i].with_effects;
    with_all.push_back(tuning.parameters[i]);
    with_all.back().with_effects = with_effects;
  }
  diagnosis.tuned = with_all;
  diagnosis.simulation_count += tuning.simulation_count;
  diagnosis.simulated_s += tuning.simulated_s;
  diagnosis.wall_s = secondsSince(start);
  return diagnosis;
}

}  // namespace musclesim
