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
#include "attribute.h"
#include "data_checks.h"
#include "fault_isolation.h"
#include "gap_reduction.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "next_experiment.h"
#include "plant.h"
#include "schedule.h"
#include "tune.h"
#include "unit_check.h"

namespace musclesim {

namespace {

constexpr double listed = 0.01;   ///< least probability that is listed
constexpr double named = 0.5;     ///< least probability of none_of_these that makes the verdict `unexplained`
constexpr double as_good = 0.01;  ///< explanations with at least this share of the best one's probability cannot be distinguished from it
constexpr double excited = 1;     ///< least change of a signal by a typical effect, in sigmas, for it to be excited

/// The options of the program for the diagnosed model, without the values in nominal.toml. A robot without a hand has no task.
std::string modelOptions(const Plant& plant, const std::optional<std::string>& initial_state) {
  std::string options = "--robot " + plant.robot();
  if (!plant.hasHand()) options += " --controller hold";
  if (const PhysicsKind kind = plant.model().physics().kind; kind != PhysicsKind::si) options += " --physics " + nameOf(kind);
  if (initial_state) options += " --initial-state " + *initial_state;
  for (const Parameter& parameter : plant.model().parameters().declared()) {
    if (parameter.name == "world.plane_height_mm") options += " --plane";
    const bool is_tuned = std::ranges::find(plant.tuned(), parameter.name, &Parameter::name) != plant.tuned().end();
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
        attributor_(plant_, options, [this] { monitor_.count(); }) {}

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
    attributor_.screen();
    diagnosis_.unsteady = attributor_.fitComparison().unsteady();
    listNotExcited();
  }

  void explain() {
    const Attribution& attribution = attributor_.result();
    if (attribution.screened_count < attribution.hypotheses.size())
      diagnosis_.notes.push_back(fmt::format("of {} possible causes the {} nearest on the first recording were looked at on the others too",
                                             attribution.hypotheses.size(), attribution.screened_count));
    if (plant_.interrupted()) return;
    const FaultIsolation isolation =
        isolateFault(attributor_.fitComparison(), attributor_.nominalResidual(), attributor_.screeningComparison(), attribution.hypotheses,
                     attribution.sensitivities, attributor_.screeningResidual());
    diagnosis_.where = isolation.places;
    diagnosis_.where_method = isolation.method;
    monitor_.phase("fitting the likely effects", 600);
    attributor_.decide();
    if (!plant_.interrupted()) choose();
    list();
    listTrials();
    if (!plant_.interrupted()) proposeExperiment();
  }

  /// Labels none of whose variants would have shown; labels that were never simulated are not listed.
  void listNotExcited() {
    const Attribution& attribution = attributor_.result();
    std::set<std::string> shown = attribution.thinned;
    for (std::size_t i = 0; i < attribution.hypotheses.size(); ++i)
      if (!(attribution.sensitivities[i].excitation_ratio.value_or(excited) < excited)) shown.insert(labelOf(i));
    for (std::size_t i = 0; i < attribution.hypotheses.size(); ++i) {
      const bool would_be_seen = attribution.hypotheses[i].info().id == held_effect;
      if (attribution.allowed[i] && !would_be_seen && shown.insert(labelOf(i)).second) diagnosis_.not_excited.push_back(labelOf(i));
    }
  }

  void choose() {
    const Attribution& attribution = attributor_.result();
    if (attribution.fits.empty() || attribution.no_effect > named) return;
    const bool none = attribution.none_of_these > named;
    const FittedHypothesis& best = none ? attributor_.nearest() : attribution.fits.front();
    const Model model = attributor_.modelOf(best);
    const Eigen::VectorXd predicted = held_out_.predicted(model);
    if (!predicted.size()) return;
    const Eigen::VectorXd after = held_out_.measured() - predicted;
    const Gap gap_after = held_out_.gap(after);
    monitor_.phase("measuring what the controls gain", 60);
    auto count = [this] { monitor_.count(); };
    const Comparison& comparison = attributor_.fitComparison();
    Eigen::VectorXd nominal, negative_control;
    parallelFor(2, options_.job_count, [&](int i) {
      if (i == 0)
        nominal = nominalRefitResidual(comparison, held_out_, count);
      else
        negative_control = negativeControlResidual(comparison, held_out_, static_cast<int>(best.z.size()), options_.seed, count);
    });
    if (plant_.interrupted()) return;
    auto reductionOf = [&](const Eigen::VectorXd& residual) {
      return residual.size() ? gapReductionPercent(diagnosis_.before, held_out_.gap(residual)) : 0.0;
    };
    diagnosis_.nominal_refit_percent = reductionOf(nominal);
    diagnosis_.negative_control_percent = reductionOf(negative_control);
    const Estimate interval =
        gapReductionInterval({held_out_, before_residual_, after},
                             {attributor_.fitComparison(), attributor_.nominalResidual(), best.validationResidual()}, options_.seed);
    const Attempt attempt{labelsOf(model), model.effects, gap_after, reductionOf(after), interval.low, interval.high};
    const bool found =
        !none && clearlyBeats(attempt.reduction_percent, diagnosis_.nominal_refit_percent, diagnosis_.negative_control_percent);
    // Not offered, because it does not hold on the held-out data or gains no more than a control.
    if (!found && attempt.reduction_percent <= std::max({0.0, diagnosis_.nominal_refit_percent, diagnosis_.negative_control_percent}))
      return;
    diagnosis_.tuned = tunedParameters(plant_, best.tuning, best.tuning_half_width);
    after_residual_ = after;
    if (found)
      accept(attempt);
    else
      diagnosis_.attempt = attempt;
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

  std::string labelOf(std::size_t hypothesis) const { return attributor_.result().hypotheses[hypothesis].label(); }

  /// Lists probabilities per effect and per explanation, and the ambiguity set.
  void list() {
    const Attribution& attribution = attributor_.result();
    diagnosis_.none_of_these = attribution.none_of_these;
    if (attribution.no_effect >= listed) diagnosis_.explanations.push_back({{}, attribution.no_effect});
    std::map<std::string, FoundEffect> found;
    for (const FittedHypothesis& fitted : attribution.fits) {
      ExplanationProbability entry{{}, fitted.probability};
      Eigen::Index first = 0;
      for (const std::size_t index : fitted.members) {
        const Hypothesis& hypothesis = attribution.hypotheses[index];
        entry.effects.push_back(hypothesis.label());
        FoundEffect& effect = found[hypothesis.label()];
        if (effect.id.empty()) {
          effect.id = hypothesis.info().id;
          effect.component = hypothesis.component();
          effect.parameters = estimates(hypothesis, fitted, first);
          effect.choices = hypothesis.choices();
        }
        effect.probability += fitted.probability;
        first += hypothesis.coordinateCount();
      }
      if (fitted.probability >= listed) diagnosis_.explanations.push_back(std::move(entry));
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
    const Attribution& attribution = attributor_.result();
    const double all = attributor_.screeningComparison().logMisfit(attributor_.screeningResidual());
    for (std::size_t i = 0; i < attribution.hypotheses.size(); ++i)
      if (attribution.allowed[i])
        diagnosis_.screenings.push_back({labelOf(i), all > 0 ? 1 - attribution.sensitivities[i].log_misfit / all : 0});
    std::ranges::stable_sort(diagnosis_.screenings, [](const auto& a, const auto& b) { return a.removed > b.removed; });
    const Comparison& comparison = attributor_.fitComparison();
    auto rmsOf = [&](const Eigen::VectorXd& residual) {
      std::vector<double> rms;
      for (const Comparison::Block& block : comparison.blocks()) rms.push_back(std::sqrt(comparison.meanSquare(block, residual)));
      return rms;
    };
    const std::vector<double> before = rmsOf(attributor_.nominalResidual());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Comparison::Block& block = comparison.blocks()[i];
      const auto recording = static_cast<std::size_t>(comparison.segments()[block.segment].recording);
      diagnosis_.blocks.push_back({plant_.recordings()[recording].file, plant_.signals()[static_cast<std::size_t>(block.signal)].name,
                                   block.sigma, before[i], static_cast<int>(block.averaged_rows)});
    }
    for (const FittedHypothesis& fitted : attribution.fits) {
      Trial trial{{}, static_cast<int>(fitted.z.size()), rmsOf(fitted.residual), {}, {}};
      if (fitted.cross_validated.size()) trial.rms_cross_validated = rmsOf(fitted.cross_validated);
      Eigen::Index first = 0;
      for (const std::size_t index : fitted.members) {
        const Hypothesis& hypothesis = attribution.hypotheses[index];
        trial.effects.push_back(hypothesis.label());
        auto& values = trial.values.emplace_back();
        for (const auto& [name, value] : hypothesis.valuesAt(fitted.z.segment(first, hypothesis.coordinateCount()))) values[name] = value;
        first += hypothesis.coordinateCount();
      }
      diagnosis_.trials.push_back(std::move(trial));
    }
  }

  std::map<std::string, Estimate> estimates(const Hypothesis& hypothesis, const FittedHypothesis& fitted, Eigen::Index first) const {
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

  /// The best fit and those with as many effects that are not much less probable.
  std::vector<const FittedHypothesis*> asGood() const {
    std::vector<const FittedHypothesis*> result;
    const auto& all = attributor_.result().fits;
    for (const FittedHypothesis& fitted : all)
      if (fitted.members.size() == all.front().members.size() && fitted.probability > 0 &&
          fitted.probability >= as_good * all.front().probability)
        result.push_back(&fitted);
    return result;
  }

  void ambiguity() {
    const std::vector<const FittedHypothesis*> likely = asGood();
    for (const FittedHypothesis* fitted : likely)
      if (likely.size() > 1) diagnosis_.alternatives.push_back(ownWords(*fitted, likely));
    for (const FittedHypothesis* fitted : likely)
      for (const std::size_t index : fitted->members)
        if (std::ranges::find(diagnosis_.ambiguity_set, labelOf(index)) == diagnosis_.ambiguity_set.end())
          diagnosis_.ambiguity_set.push_back(labelOf(index));
  }

  /// The effects of a fitted hypothesis that not all the others have.
  std::string ownWords(const FittedHypothesis& fitted, const std::vector<const FittedHypothesis*>& others) const {
    std::vector<std::string> own;
    for (const std::size_t index : fitted.members)
      if (!std::ranges::all_of(others, [&](const FittedHypothesis* other) {
            return std::ranges::any_of(other->members, [&](std::size_t member) { return labelOf(member) == labelOf(index); });
          }))
        own.push_back(labelOf(index));
    return fmt::format("{}", fmt::join(own, " + "));
  }

  double singleReduction(const std::string& label) const {
    const Attribution& attribution = attributor_.result();
    if (plant_.interrupted()) return 0;
    for (const FittedHypothesis& fitted : attribution.fits) {
      if (fitted.members.size() != 1 || labelOf(fitted.members.front()) != label) continue;
      const Eigen::VectorXd predicted = held_out_.predicted(attributor_.modelOf(fitted));
      return predicted.size() ? gapReductionPercent(diagnosis_.before, held_out_.gap(held_out_.measured() - predicted)) : 0;
    }
    return 0;
  }

  void proposeExperiment() {
    constexpr std::size_t most = 4;
    std::vector<const FittedHypothesis*> likely = asGood();
    if (likely.size() < 2) return;
    likely.resize(std::min(most, likely.size()));
    monitor_.phase("planning the next experiment", static_cast<long>(2 * scheduleBank().size() * likely.size()));
    std::vector<Rival> rivals;
    for (const FittedHypothesis* fitted : likely) rivals.push_back(attributor_.rival(*fitted, ownWords(*fitted, likely)));
    const Fidelity fidelity = std::min(attributor_.screeningComparison().fidelity(), Fidelity::coarse);
    diagnosis_.next_experiment = nextExperiment(plant_, rivals, fidelity, options_.job_count, [this] { monitor_.count(); });
  }

  void finish() {
    if (diagnosis_.before.normalised > 0) diagnosis_.unexplained_percent = 100 * diagnosis_.after.normalised / diagnosis_.before.normalised;
    addPhases();
    addTraces();
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
  Attributor attributor_;
  Diagnosis diagnosis_;
  Eigen::VectorXd before_residual_, after_residual_;
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
