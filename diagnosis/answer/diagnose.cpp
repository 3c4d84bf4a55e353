// The order of a diagnosis: gap, fault isolation, effects, gap reduction, next experiment.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <ranges>
#include <set>
#include <variant>

#include "../../base/parallel.h"
#include "../data/data_checks.h"
#include "../isolation/fault_isolation.h"
#include "../model/convention_check.h"
#include "../model/plant.h"
#include "../planning/next_experiment.h"
#include "../planning/schedule.h"
#include "../search/search.h"
#include "listing.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/robot/robot_file.h"
#include "number_instead.h"
#include "odd_recording.h"
#include "tune.h"
#include "unknown_start.h"
#include "verdict.h"

namespace musclesim {

namespace {

/// The options of the program for the diagnosed model, without the numbers in nominal.toml. A robot without a hand has no task.
std::string modelOptions(const Plant& plant, const std::optional<std::string>& initial_state, const Diagnosis& diagnosis) {
  const auto isIn = [](const auto& numbers, const std::string& name) {
    return std::ranges::any_of(numbers, [&](const auto& number) { return number.name == name; });
  };
  const bool is_file = isRobotFile(plant.robot());
  std::string options = "--robot " + (is_file ? std::filesystem::absolute(plant.robot()).lexically_normal().string() : plant.robot());
  if (!plant.hasHand()) options += " --controller hold";
  if (const PhysicsKind kind = plant.model().physics().kind; kind != PhysicsKind::si) options += " --physics " + nameOf(kind);
  if (initial_state) options += " --initial-state " + *initial_state;
  for (const Parameter& parameter : plant.model().parameters().declared()) {
    if (parameter.name == "world.plane_height_mm") options += " --plane";
    const bool is_fitted = isIn(diagnosis.tuned, parameter.name) || isIn(diagnosis.numbers, parameter.name);
    if (parameter.value == parameter.default_value || is_fitted) continue;
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

void addNew(const std::string& note, std::vector<std::string>& notes) {
  if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
}

class Run {
 public:
  /// `given` as for Plant.
  Run(std::vector<Recording> recordings, const DiagnosisOptions& options, const std::map<std::string, double>& given = {})
      : options_(options),
        monitor_(options),
        plant_(std::move(recordings), options, given),
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

  /// After diagnose().
  const UnknownStarts& unknownStarts() const { return unknown_starts_; }

 private:
  void describe() {
    diagnosis_.robot = plant_.robot();
    for (const Recording& recording : plant_.recordings()) {
      diagnosis_.recordings.push_back(recording.file);
      for (const std::string& note : recording.notes) addNew(note, diagnosis_.notes);
    }
    for (const ActiveEffect& effect : plant_.recordings().front().info.active_effects)
      diagnosis_.model_effects.push_back(effect.id + "@" + effect.component);
    for (const std::string& note : plant_.notes()) diagnosis_.notes.push_back(note);
    std::set<std::string> refitted;
    for (const auto& [name, value] : plant_.nominalParameters()) refitted.insert(name);
    for (const UncertainNumber& number : plant_.numbers()) refitted.insert(number.parameter.name);
    diagnosis_.refitted.assign(refitted.begin(), refitted.end());
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
    if (!options_.trust_columns)
      for (std::string& note : checkConventions(plant_, whole)) diagnosis_.notes.push_back(std::move(note));
    const Comparison all(plant_, everything);
    const Eigen::VectorXd predicted = all.predicted(Model{}), held = held_out_.predicted(Model{});
    if (!predicted.size() || !held.size())
      throw Diverged(0, plant_.robot(), "the model without further effects cannot follow the recordings");
    before_residual_ = held_out_.measured() - held;
    held_out_.setGap(before_residual_);
    diagnosis_.before = diagnosis_.after = held_out_.gap(before_residual_);
    const Eigen::VectorXd residual = all.measured() - predicted;
    const SmallGap largest = largestBesideMotion(all, residual);
    const bool is_noise = isWithinNoise(all, residual), small = is_noise || largest.percent_of_motion < options_.smallest_gap_percent;
    diagnosis_.held_out_is_noise = isWithinNoise(held_out_, before_residual_);
    if (!small && diagnosis_.held_out_is_noise)
      diagnosis_.notes.push_back(
          fmt::format("there is no gap in {}: no cause can be confirmed there; put a recording that shows the gap last",
                      plant_.recordings().size() > 1 ? plant_.recordings().back().file : diagnosis_.held_out));
    diagnosis_.verdict = small ? (commandsMove(plant_.recordings()) ? Verdict::no_gap : Verdict::not_excited) : Verdict::unexplained;
    if (diagnosis_.verdict != Verdict::no_gap) return;
    diagnosis_.explanations.push_back({{}, 1});
    if (!is_noise) diagnosis_.small_gap = largest;
  }

  /// Runs for every verdict, since effects that the recordings could not have shown may be present even without a gap.
  void screen() {
    monitor_.phase("screening all effects", static_cast<long>(hypotheses(plant_, DiagnosisOptions{}).size()));
    search_.screen();
    diagnosis_.unsteady = search_.fitComparison().unsteady();
    listNotExcited(search_, diagnosis_);
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
    monitor_.phase("fitting the likely effects", 0);  // a thousand simulations or twenty thousand
    search_.decide();
    diagnosis_.none_of_these = search_.somethingElse();
    if (!plant_.interrupted()) {
      monitor_.phase("measuring what the controls gain", 60);
      offer_ = judge(
          search_, heldOut(), options_, [this] { monitor_.count(); }, diagnosis_);
    }
    const bool is_offered = offer_.after.size() > 0;
    const Eigen::VectorXd &fitted = is_offered ? offer_.explanation.residual : search_.nominalResidual(),
                          &after = is_offered ? offer_.after : before_residual_;
    diagnosis_.odd_recordings = oddRecordings(search_, heldOut(), fitted, after);
    unknown_starts_ = musclesim::unknownStarts(search_, heldOut(), fitted, after);
    listNumbers(plant_, offer_.explanation, diagnosis_);
    listTrials(search_, diagnosis_);
    listEffects(search_, heldOut(), options_, diagnosis_);
    if (plant_.interrupted() || !unknown_starts_.seconds.empty()) return;
    tryExactNumbers();
    proposeExperiment();
  }

  void tryExactNumbers() {
    if (diagnosis_.verdict != Verdict::effects_found) return;
    monitor_.phase("trying numbers that were taken as exact", 0);
    diagnosis_.numbers_instead = numbersInstead(search_, [this] { monitor_.count(); });
  }

  void proposeExperiment() {
    constexpr std::size_t most = 4;
    std::vector<const Explanation*> likely = asGood(search_);
    if (likely.size() < 2) return;
    likely.resize(std::min(most, likely.size()));
    monitor_.phase("planning the next experiment", static_cast<long>(2 * scheduleBank().size() * likely.size()));
    std::vector<Rival> rivals;
    for (const Explanation* fitted : likely) rivals.push_back(search_.rival(*fitted, wordsOf(search_, *fitted)));
    const Fidelity fidelity = std::min(search_.screeningComparison().fidelity(), Fidelity::coarse);
    diagnosis_.next_experiment = nextExperiment(plant_, rivals, fidelity, options_.job_count, [this] { monitor_.count(); });
  }

  void finish() {
    if (diagnosis_.before.normalised > 0) diagnosis_.unexplained_percent = 100 * diagnosis_.after.normalised / diagnosis_.before.normalised;
    if (before_residual_.size()) listHeldOut(search_, heldOut(), offer_.after, diagnosis_);
    diagnosis_.drawing = plant_.drawing();
    diagnosis_.muscle_names = plant_.muscleNames();
    if (plant_.hasOwnSubsteps()) diagnosis_.substeps = plant_.substeps();
    const auto& given = options_.model.initial_state;
    diagnosis_.model_options = modelOptions(plant_, given ? given : plant_.recordings().front().info.initial_state, diagnosis_);
  }

  HeldOut heldOut() const { return {held_out_, before_residual_}; }

  const DiagnosisOptions& options_;
  Monitor monitor_;
  Plant plant_;
  Comparison held_out_;
  Search search_;
  Diagnosis diagnosis_;
  Eigen::VectorXd before_residual_;
  Offer offer_;
  UnknownStarts unknown_starts_;
};

/// Diagnoses once, or twice if some recordings turn out to begin in the middle of a motion: then without their first readings. If the
/// second diagnosis is interrupted, the answer is the first one.
Diagnosis run(std::vector<Recording> recordings, const DiagnosisOptions& options, const std::map<std::string, double>& given = {}) {
  Run first(recordings, options, given);
  Diagnosis diagnosis = first.diagnose();
  const UnknownStarts& starts = first.unknownStarts();
  if (starts.seconds.empty() || diagnosis.partial) return diagnosis;
  for (const auto& [recording, seconds] : starts.seconds) recordings[static_cast<std::size_t>(recording)].info.skip_start_s = seconds;
  DiagnosisOptions checked = options;
  checked.trust_columns = true;
  Diagnosis again = Run(std::move(recordings), checked, given).diagnose();
  if (again.partial) {
    diagnosis.partial = true;
    return diagnosis;
  }
  for (const std::string& note : diagnosis.notes) addNew(note, again.notes);
  again.unknown_start = starts.sentence;
  again.simulation_count += diagnosis.simulation_count;
  again.simulated_s += diagnosis.simulated_s;
  again.wall_s += diagnosis.wall_s;
  return again;
}

}  // namespace

MethodPart methodPartNamed(const std::string& name) {
  static const std::map<std::string, MethodPart> parts = {
      {"nuisances", MethodPart::nuisances}, {"stand_ins", MethodPart::stand_ins}, {"tempering", MethodPart::tempering}};
  const auto found = parts.find(name);
  if (found != parts.end()) return found->second;
  std::vector<std::string> names;
  names.reserve(parts.size());
  for (const auto& [known, part] : parts) names.push_back(known);
  throw BadParameter(fmt::format("{} is no part of the method that can be left out; these are: {}", name, fmt::join(names, ", ")));
}

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
  if (options.max_effects < 1 || options.max_effects > most_effects)
    throw BadParameter("max_effects", std::to_string(options.max_effects), fmt::format("lie in 1..{}", most_effects));
  if (!(options.smallest_gap_percent >= 0))
    throw BadParameter("smallest_gap_percent", fmt::format("{:g}", options.smallest_gap_percent), "be 0 or more");
  for (const std::string& name : options.tune)
    if (std::ranges::count(options.tune, name) > 1) throw BadParameter("--tune", name + "," + name, "name each number once");
  if (options.skip_start_s && !(*options.skip_start_s >= 0))
    throw BadParameter("skip_start_s", fmt::format("{:g}", *options.skip_start_s), "be 0 s or more");
  if (options.tune.empty()) return run(std::move(recordings), options);
  const auto start = std::chrono::steady_clock::now();
  DiagnosisOptions with_tuned = options;
  const Tuning tuning = tune(recordings, with_tuned);
  std::map<std::string, double> given;
  for (const TunedParameter& parameter : tuning.parameters) given[parameter.name] = parameter.start;
  Diagnosis diagnosis = run(std::move(recordings), with_tuned, given);
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
