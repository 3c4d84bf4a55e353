#include "plant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "../base/parallel.h"
#include "../base/short_names.h"
#include "../effect/components.h"
#include "data_checks.h"
#include "drawing.h"
#include "musclesim/base/error.h"
#include "musclesim/base/hash.h"
#include "musclesim/robot/force_law.h"

namespace musclesim {

namespace {

constexpr int fewest_to_coarsen = 8;  ///< with fewer internal steps a simulation is cheap and cannot be coarser
constexpr int most_refinement = 8;    ///< internal steps, over those of a replay
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Parameters of the nominal refit: friction within the muscles and the curvature of Eq. 1.
constexpr const char* hinge_friction = "muscle.hinge_friction_Nm";
constexpr const char* braun_curvature = "force_law.b";
constexpr const char* nominal_names[] = {"muscle.slider_friction_N", hinge_friction, braun_curvature};

/// Whether an entry of "varies" means this member of robot_parameters: the robot's name before it is optional.
bool means(const std::string& listed, const std::string& parameter) {
  return listed == parameter || listed.ends_with("." + parameter) || parameter.ends_with("." + listed);
}

/// The parameters that all recordings of one plant must share.
std::map<std::string, Parameter::Value> sharedParameters(const RecordingInfo& info, const std::vector<std::string>& varies) {
  auto shared = info.robot_parameters;
  std::erase_if(shared, [&](const auto& entry) {
    return std::ranges::any_of(varies, [&](const std::string& listed) { return means(listed, entry.first); });
  });
  return shared;
}

std::vector<std::string> allThatVaries(const std::vector<Recording>& recordings) {
  std::vector<std::string> all;
  for (const Recording& recording : recordings) all.insert(all.end(), recording.info.varies.begin(), recording.info.varies.end());
  return all;
}

void requireDiagnosable(const std::vector<Recording>& recordings) {
  if (recordings.empty()) throw BadParameter("diagnosis: there is no recording");
  const Recording& first = recordings.front();
  const std::vector<std::string> varies = allThatVaries(recordings);
  for (const Recording& recording : recordings) {
    if (recording.info.robot != first.info.robot)
      throw BadFile(recording.file,
                    fmt::format("its robot is {}, but that of {} is {}", recording.info.robot, first.file, first.info.robot));
    if (sharedParameters(recording.info, varies) != sharedParameters(first.info, varies))
      throw BadFile(
          recording.file,
          fmt::format("its robot_parameters are not those of {}: one plant is diagnosed at a time. Write \"varies\": [\"NAME\"] into "
                      "its sidecar for a number that was measured anew for each recording, for example a load",
                      first.file));
    if (recording.muscleCount() == 0)
      throw BadFile(recording.file, "it has no columns command_0, command_1, ...: without them nothing can be simulated");
  }
  requireDifferentMeasurements(recordings);
}

/// Of several recordings the last is held out; of one recording, the last two fifths of its rows.
Split splitOf(const std::vector<Recording>& recordings) {
  Split split;
  const int count = static_cast<int>(recordings.size());
  std::vector<std::string> files;
  for (const Recording& recording : recordings) files.push_back(recording.file);
  const std::vector<std::string> names = shortNames(files);
  auto rows = [&](int i) { return static_cast<int>(recordings[static_cast<std::size_t>(i)].time_s.size()); };
  if (count == 1) {
    const int border = rows(0) * 3 / 5;
    split.fit = {{0, 0, border}};
    split.held_out = {{0, border, rows(0)}};
    split.held_out_words = fmt::format("the last two fifths of {}", names.front());
    return split;
  }
  for (int i = 0; i + 1 < count; ++i) split.fit.push_back({i, 0, rows(i)});
  split.held_out = {{count - 1, 0, rows(count - 1)}};
  split.held_out_words = fmt::format("{}, held out from fitting and choosing", names.back());
  return split;
}

/// A model as a key: all that a simulation depends on beside the recording and the user's model.
std::string modelKey(const Model& model) {
  auto written = [](const Parameter::Value& value) {
    return std::holds_alternative<double>(value) ? fmt::format("{:a}", std::get<double>(value)) : std::get<std::string>(value);
  };
  std::string key;
  for (const ActiveEffect& effect : model.effects) {
    if (effect.id == held_effect) continue;
    key += fmt::format(";{}@{}", effect.id, effect.component);
    for (const auto& [name, value] : effect.parameters) key += fmt::format(",{}={}", name, written(value));
  }
  for (const auto& [name, value] : model.parameters) key += fmt::format(";{}={:a}", name, value);
  return key;
}

/// Ratio of the time step to the fine one.
int ratioOf(Fidelity fidelity) {
  return 1 << static_cast<int>(fidelity);
}

/// Whether a sidecar says with how many internal steps this program simulated the recording, or which effects were simulated.
bool isSimulated(const Recording& recording) {
  return !recording.info.active_effects.empty() || nlohmann::json::parse(recording.info.extra_json, nullptr, false).contains("substeps");
}

bool hasNumbers(const Signal& signal) {
  return std::any_of(signal.values.begin(), signal.values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

Plant::Plant(std::vector<Recording> recordings, const DiagnosisOptions& options, const std::map<std::string, double>& given)
    : recordings_(std::move(recordings)), options_(options), store_(options.kept) {
  for (Recording& recording : recordings_) replaceRobot(recording.info, options.model.robot);
  requireDiagnosable(recordings_);
  for (const auto* ids : {&options.candidates, &options.exclude})
    for (const std::string& id : *ids) effectInfo(id);  // throws for an unknown one
  split_ = splitOf(recordings_);
  const RecordingInfo& info = recordings_.front().info;
  reference_ = std::make_unique<Simulation>(simulationOptionsFor(info, sidecarPath(recordings_.front().file), options_.model));
  reference_->build(info.robot);
  reference_->parameters().requireAllKnown();
  if (std::string note = otherDescriptionNote(info, reference_->robot()); !note.empty()) notes_.push_back(std::move(note));
  findNumbers(given);
  for (Eigen::Index i = 0; i < numberCount(); ++i)
    if (numbers_[static_cast<std::size_t>(i)].is_tuned) key_of_tuned_ += fmt::format("{:a},", numberAt(i, numbers_in_force_[i]));
  findNominalParameters();
  compareSignals();
  for (const auto* part : {&split_.fit, &split_.held_out}) requireNumbers(*part);
  chooseSubsteps();
}

/// Machines have no internal steps: where these are few, as with massless muscles, twice as many are taken until the error that is left,
/// twice what doubling changes, is below the noise of every signal. Recordings of this program are replayed in the steps they were made in.
void Plant::chooseSubsteps() {
  constexpr double bearable_sigmas = 0.5;
  substeps_ = reference_->substeps();
  if (options_.model.substeps > 0 || substeps_ >= fewest_to_coarsen || std::ranges::any_of(recordings_, isSimulated)) return;
  const auto predicted = [this] {
    std::vector<Prediction> all(recordings_.size());
    parallelFor(static_cast<int>(all.size()), jobCount(), [&](int i) { all[static_cast<std::size_t>(i)] = predict(i, Model{}); });
    return all;
  };
  std::vector<Prediction> usual = predicted();
  for (const int most = most_refinement * substeps_; 2 * substeps_ <= most;) {
    substeps_ *= 2;
    std::vector<Prediction> finer = predicted();
    if (largestChangeInSigmas(usual, finer) < bearable_sigmas) {
      substeps_ /= 2;
      break;
    }
    usual = std::move(finer);
  }
}

/// The largest RMS difference of any signal of any recording between two simulations of all, over the signal's noise sigma.
double Plant::largestChangeInSigmas(const std::vector<Prediction>& one, const std::vector<Prediction>& other) const {
  double largest = 0;
  for (std::size_t r = 0; r < recordings_.size(); ++r)
    for (std::size_t s = 0; s < signals_.size(); ++s) {
      double sum = 0;
      int count = 0;
      for (std::size_t row = 0; row < measured_[r][s].size(); ++row) {
        const double change = one[r].values[s][row] - other[r].values[s][row];
        if (!std::isfinite(measured_[r][s][row]) || !std::isfinite(change)) continue;
        sum += change * change;
        ++count;
      }
      if (count > 0) largest = std::max(largest, std::sqrt(sum / count) / signals_[s].sigma.value);
    }
  return largest;
}

void Plant::findNominalParameters() {
  const auto any = [&](const auto& has) { return std::ranges::any_of(reference_->world().actuators(), has); };
  const bool has_hinges = any([](const auto& actuator) { return !actuator->hinges().empty(); });
  const bool obeys_eq_1 = any([](const auto& actuator) { return dynamic_cast<const BraunForceLaw*>(&actuator->forceLaw()) != nullptr; });
  const auto acts = [&](const std::string& name) {
    return name == hinge_friction    ? has_hinges
           : name == braun_curvature ? obeys_eq_1
                                     : std::ranges::find(nominal_names, name) != std::end(nominal_names);
  };
  for (const Parameter& parameter : reference_->parameters().declared())
    if (acts(parameter.name) || std::ranges::find(options_.tune, parameter.name) != options_.tune.end())
      nominal_.emplace_back(parameter.name, std::get<double>(parameter.value));
}

/// Throws BadFile unless a part of the recordings has enough numbers of at least one signal.
void Plant::requireNumbers(const std::vector<Segment>& part) const {
  const auto numbersIn = [&](const Segment& segment, std::size_t signal) {
    const std::vector<double>& y = measured(segment.recording, static_cast<int>(signal));
    const auto end = std::min(static_cast<std::size_t>(segment.end_row), y.size());
    int count = 0;
    for (auto row = static_cast<std::size_t>(segment.first_row); row < end; ++row) count += std::isfinite(y[row]) ? 1 : 0;
    return count;
  };
  for (const Segment& segment : part)
    for (std::size_t signal = 0; signal < signals_.size(); ++signal)
      if (numbersIn(segment, signal) >= fewest_compared_rows) return;
  const Segment& segment = part.front();
  throw BadFile(recordings_[static_cast<std::size_t>(segment.recording)].file,
                fmt::format("its rows {} to {}, {}, hold fewer than {} numbers of every signal that can be compared", segment.first_row + 1,
                            segment.end_row, &part == &split_.fit ? "which the effects are fitted to" : "on which the result is measured",
                            fewest_compared_rows));
}

/// Removes a signal from a recording in which it never changes although commands do, if it changes in another recording: the sensor is dead
/// there.
void Plant::dropDeadSegments() {
  for (Recording& recording : recordings_) {
    const std::vector<Recording> one = {recording};
    if (!commandsMove(one)) continue;
    for (Signal& signal : recording.signals) {
      if (signal.name.starts_with("command_") || !hasNumbers(signal)) continue;
      if (!neverChanges(one, signal.name) || neverChanges(recordings_, signal.name)) continue;
      std::ranges::fill(signal.values, nan);
      notes_.push_back(fmt::format("{}: {} has the same value in every row although commands change: a dead sensor, left out there",
                                   recording.file, signal.name));
    }
  }
}

/// Removes the readings that depend on commands within a dropout, which are not known.
void Plant::dropAfterDropouts() {
  for (Recording& recording : recordings_)
    for (const Dropout& dropout : dropoutsOf(recording)) {
      if (!dropout.changes_commands) continue;
      const auto end = std::ranges::upper_bound(recording.time_s, recording.time_s[dropout.next_row] + forgotten_after_s);
      for (Signal& signal : recording.signals)
        if (!signal.name.starts_with("command_"))
          std::fill(signal.values.begin() + static_cast<std::ptrdiff_t>(dropout.next_row),
                    signal.values.begin() + (end - recording.time_s.begin()), nan);
    }
}

void Plant::compareSignals() {
  measured_.resize(recordings_.size());
  notes_ = dataNotes(recordings_);
  dropDeadSegments();
  dropAfterDropouts();
  const bool moves = commandsMove(recordings_);
  for (const std::string& name : reference_->robot().signalNames()) {
    if (name.starts_with("command_")) continue;
    const bool recorded = std::ranges::any_of(recordings_, [&](const Recording& recording) {
      const Signal* found = recording.find(name);
      return found && hasNumbers(*found);
    });
    if (!recorded) continue;
    if (moves && neverChanges(recordings_, name)) {
      notes_.push_back(name + " has the same value in every row although commands change: a dead sensor, left out");
      continue;
    }
    signals_.push_back({name, noiseSigma(recordings_, name)});
    for (std::size_t i = 0; i < recordings_.size(); ++i) {
      const Signal* found = recordings_[i].find(name);
      measured_[i].push_back(found ? found->values : std::vector<double>{});
    }
  }
  for (const Recording& recording : recordings_)
    for (std::string& note : unknownSignalNotes(recording, reference_->robot())) notes_.push_back(std::move(note));
  if (signals_.empty())
    throw BadFile(recordings_.front().file,
                  "it has no signal that can be compared: one that changes and that the model also has, for example length_0_mm");
}

const std::vector<double>& Plant::measured(int recording, int signal) const {
  return measured_[static_cast<std::size_t>(recording)][static_cast<std::size_t>(signal)];
}

const ParityRelations& Plant::parity(int recording) const {
  const std::scoped_lock lock(access_to_parity_);
  if (const auto known = parity_.find(recording); known != parity_.end()) return known->second;
  std::vector<int> motions;
  std::vector<std::string> names;
  std::vector<double> sigmas;
  for (const ComparedSignal& signal : signals_) {
    const auto& values = measured(recording, static_cast<int>(names.size()));
    if (isMotion(signal.name) && std::ranges::any_of(values, [](double value) { return std::isfinite(value); }))
      motions.push_back(static_cast<int>(names.size()));
    names.push_back(signal.name);
    sigmas.push_back(signal.sigma.value);
  }
  ParityRelations relations(recordings_[static_cast<std::size_t>(recording)], options_.model, std::move(motions), names, sigmas);
  return parity_.emplace(recording, std::move(relations)).first->second;
}

std::vector<Segment> Plant::screeningSegments() const {
  constexpr std::size_t most_recordings = 3;
  constexpr int row_count = 1200;
  constexpr double duration_s = 12, rounding_s = 1e-9;
  std::vector<Segment> result;
  auto recordingOf = [&](const Segment& s) -> const Recording& { return recordings_[static_cast<std::size_t>(s.recording)]; };
  for (const Segment& segment : split_.fit) {
    const bool repeated =
        std::ranges::any_of(result, [&](const Segment& other) { return isRepeat(recordingOf(segment), recordingOf(other)); });
    if (!repeated && result.size() < most_recordings) result.push_back(segment);
  }
  const auto count = static_cast<int>(result.size());
  for (Segment& segment : result) {
    const std::vector<double>& time_s = recordingOf(segment).time_s;
    const int from = firstChange(recordingOf(segment));
    const double until_s = time_s[static_cast<std::size_t>(from)] + duration_s / count - rounding_s;
    const auto in_time = static_cast<int>(std::ranges::lower_bound(time_s, until_s) - time_s.begin());
    segment.end_row = std::min(segment.end_row, std::max(from + row_count / count, in_time));
    segment.every = std::max(1, (segment.end_row - from) * count / row_count);
  }
  return result;
}

bool Plant::holds(Stage stage) const {
  const auto acts = [stage](const ActiveEffect& effect) { return effectInfo(effect.id).stage == stage; };
  return std::ranges::any_of(options_.model.effects, acts) || std::ranges::any_of(recordings_, [&](const Recording& recording) {
           return std::ranges::any_of(recording.info.active_effects, acts);
         });
}

std::vector<std::string> Plant::componentsFor(const EffectInfo& info) const {
  return musclesim::componentsFor(info, reference_->robot());
}

bool Plant::compares(const std::string& component) const {
  return component == "all" ||
         std::ranges::any_of(signals_, [&](const ComparedSignal& signal) { return isComponentOf(component, signal.name); });
}

bool Plant::isComponentOf(const std::string& component, const std::string& signal_name) {
  return component == "signal_" + stemOf(signal_name);
}

Plant::MuscleRange Plant::muscleRange(int muscle) const {
  const Actuator& actuator = *reference_->world().actuators()[static_cast<std::size_t>(muscle)];
  return {actuator.minimumLengthMm(), actuator.maximumLengthMm()};
}

/// By the names of parameters, those of the robot's file and of the sidecars.
std::map<std::string, double> Plant::declaredTolerances() const {
  if (leavesOut(MethodPart::nuisances)) return {};
  const std::vector<Parameter>& declared = reference_->parameters().declared();
  std::map<std::string, double> by_name = reference_->robot().parameterTolerances();
  // The robot's own tolerances are for its usual values: a number that is set to 0 has none.
  std::erase_if(by_name, [&](const auto& entry) {
    return std::ranges::none_of(declared, [&](const Parameter& parameter) {
      return parameter.name == entry.first && std::holds_alternative<double>(parameter.value) && std::get<double>(parameter.value) != 0;
    });
  });
  for (const Recording& recording : recordings_)
    for (const auto& [name, tolerance] : recording.info.parameter_tolerance) {
      const auto meant = std::ranges::find_if(declared, [&, &wanted = name](const Parameter& each) { return means(wanted, each.name); });
      by_name[meant == declared.end() ? name : meant->name] = tolerance;
    }
  return by_name;
}

void Plant::findNumbers(const std::map<std::string, double>& given) {
  constexpr double of_tuned = 0.5;  // a guess by eye: within a factor of e, twice the tolerance
  const std::vector<std::string> varying = allThatVaries(recordings_);
  const auto varies = [&](const std::string& name) {
    return std::ranges::any_of(varying, [&](const std::string& listed) { return means(listed, name); });
  };
  for (const std::string& name : options_.tune) {
    if (varies(name)) throw BadParameter("--tune", name, "not name a parameter that varies between the recordings");
    numbers_.push_back({numberNamed("--tune", name), of_tuned, true});
  }
  for (const auto& [name, tolerance] : declaredTolerances())
    if (!varies(name) && std::ranges::find(options_.tune, name) == options_.tune.end())
      numbers_.push_back({numberNamed("parameter_tolerance", name), tolerance, false});
  numbers_in_force_ = Eigen::VectorXd::Zero(numberCount());
  for (Eigen::Index i = 0; i < numberCount(); ++i) {
    UncertainNumber& number = numbers_[static_cast<std::size_t>(i)];
    const auto by_user = given.find(number.parameter.name);
    if (by_user == given.end()) continue;
    numbers_in_force_[i] = std::log(std::get<double>(number.parameter.value) / by_user->second) / number.tolerance;
    number.parameter.value = by_user->second;
  }
}

double Plant::tensionN(int muscle, double pressure_ratio, double length_mm) const {
  return reference_->world().actuators()[static_cast<std::size_t>(muscle)]->calculateForce(pressure_ratio, length_mm);
}

RobotDrawing Plant::drawing() const {
  return drawingOf(*reference_);
}

bool Plant::hasHand() const {
  return reference_->robot().getState().hand_mm.has_value();
}

Eigen::MatrixX3d Plant::nominalHandMm(int recording) const {
  const Recording& recorded = recordings_[static_cast<std::size_t>(recording)];
  Eigen::MatrixX3d places(static_cast<Eigen::Index>(recorded.time_s.size()), 3);
  Eigen::Index row = 0;
  ReplayOptions options = options_.model;
  options.watch = [&](Simulation& simulation) -> ReplayOptions::Watcher {
    if (!simulation.robot().hand()) return {};
    return [&](const State&) {
      if (row < places.rows()) places.row(row++) = simulation.robot().handMm();
    };
  };
  const ReplayResult result = replayRecording(recorded, options);
  return result.divergence || row < places.rows() ? Eigen::MatrixX3d() : places;
}

/// The fidelity itself if coarser steps save time on this robot, otherwise fine.
Fidelity Plant::possible(Fidelity fidelity) const {
  return substeps_ >= fewest_to_coarsen ? fidelity : Fidelity::fine;
}

/// Where more were chosen than a replay takes, never fewer than that: the search would lose effects in the error of longer steps.
int Plant::substepsOf(Fidelity fidelity) const {
  const int ratio = ratioOf(possible(fidelity)), usual = reference_->substeps();
  const int substeps = (substeps_ + ratio - 1) / ratio;
  return substeps_ > usual ? std::max(substeps, usual) : substeps;
}

void Plant::count(double simulated_s) const {
  ++simulation_count_;
  simulated_ms_ += std::lround(simulated_s * ms_per_s);
}

/// What a simulation depends on beside the model that is tried: the recording, its length, the time step, and the tuned numbers.
std::string Plant::simulationKey(int recording, std::size_t rows, Fidelity fidelity) const {
  return fmt::format("{} {} {} {}", recording, rows, substepsOf(fidelity), key_of_tuned_);
}

/// Whether the pressures under a model depend on the muscles' lengths.
bool Plant::pressuresNeedMotion(const Model& model) const {
  const auto needsMotion = [](const ActiveEffect& effect) {
    const EffectInfo info = effectInfo(effect.id);
    return (info.stage == Stage::command || info.stage == Stage::pressure) && !info.ignores_motion;
  };
  return std::ranges::any_of(model.effects, needsMotion) || std::ranges::any_of(options_.model.effects, needsMotion) ||
         std::ranges::any_of(recordings_, [&](const Recording& one) { return std::ranges::any_of(one.info.active_effects, needsMotion); });
}

Prediction Plant::predict(int recording, const Model& model, int end_row, Fidelity fidelity, Focus focus) const {
  if (focus == Focus::pressures && pressuresNeedMotion(model)) focus = Focus::all_signals;
  const Recording& recorded = recordings_[static_cast<std::size_t>(recording)];
  const std::size_t all_rows = recorded.time_s.size();
  const std::size_t rows = end_row > 0 ? std::min(static_cast<std::size_t>(end_row), all_rows) : all_rows;
  const Parts parts = partsOf(model);
  std::string key = simulationKey(recording, rows, fidelity) + modelKey(parts.simulated);
  if (focus == Focus::pressures) key += " pressures";
  const bool is_new = store_.isNew(key);
  Prediction prediction = store_.get(key, [&] { return replay(recorded, parts.simulated, end_row, fidelity, focus); });
  if (is_new && !prediction.refused && focus == Focus::all_signals) count(recorded.time_s[rows - 1] - recorded.time_s.front());
  read(parts.reading, prediction);
  holdSamples(recording, model, prediction);
  return prediction;
}

Prediction Plant::predict(int recording, const Model& model, const std::vector<std::vector<double>>& commands, int end_row,
                          Fidelity fidelity) const {
  Recording changed = recordings_[static_cast<std::size_t>(recording)];
  for (Signal& signal : changed.signals)
    if (signal.name.starts_with("command_")) {
      const auto muscle = static_cast<std::size_t>(std::stoi(signal.name.substr(8)));
      for (std::size_t row = 0; row < commands.size(); ++row) signal.values[row] = commands[row][muscle];
    }
  const auto rows = end_row > 0 ? static_cast<std::size_t>(end_row) : changed.time_s.size();
  count(changed.time_s[rows - 1] - changed.time_s.front());
  Hash hash;
  for (const std::vector<double>& row : commands)
    for (const double command : row) hash.add(command);
  const std::string key = simulationKey(recording, rows, fidelity) + modelKey(model) + " commands " + hash.text();
  return store_.get(key, [&] { return replay(changed, model, end_row, fidelity); });
}

/// Empty if such an effect cannot act on this plant (a payload that removes more mass than there is), or if the simulation would take too
/// long, for example with a force that grows a millionfold towards full length.
std::optional<ReplayResult> Plant::simulated(const Recording& recording, const Model& model, Fidelity fidelity, HeldSamples held,
                                             Focus focus) const {
  constexpr int most_ratio = 20;  // of internal steps, over those of the model
  ReplayOptions options = options_.model;
  options.body_moves = focus != Focus::pressures;
  const bool unchanged = model.effects.empty() && model.parameters.empty();
  if (!unchanged) options.interrupted = options_.interrupted;  // a partial report also compares with the unchanged model
  if (const int substeps = substepsOf(fidelity); substeps != reference_->substeps()) options.substeps = substeps;
  for (const ActiveEffect& effect : model.effects)
    if (effect.id != held_effect || held == HeldSamples::drawn) options.effects.push_back(effect);
  for (const auto& [name, value] : model.parameters) options.parameters.set(name, value, "diagnosis");
  if (!model.parameters.empty()) options.most_substeps = most_ratio * substeps_;
  try {
    return replayRecording(recording, options);
  } catch (const BadParameter&) {
    if (unchanged) throw;
  } catch (const BadFile&) {  // a robot file that cannot be built with this effect: a muscle that would end within its pulley
    if (unchanged) throw;
  }
  return std::nullopt;
}

Prediction Plant::replay(Recording recording, const Model& model, int end_row, Fidelity fidelity, Focus focus) const {
  const std::size_t all_rows = recording.time_s.size();
  if (end_row > 0 && static_cast<std::size_t>(end_row) < all_rows) {
    recording.time_s.resize(static_cast<std::size_t>(end_row));
    for (Signal& signal : recording.signals) signal.values.resize(static_cast<std::size_t>(end_row));
  }
  const std::optional<ReplayResult> result = simulated(recording, model, fidelity, HeldSamples::as_measured, focus);
  if (!result) return {std::vector<std::vector<double>>(signals_.size(), std::vector<double>(all_rows, nan)), true, true};
  Prediction prediction;
  prediction.diverged = result->divergence.has_value() || result->interrupted;
  prediction.cut = result->interrupted;
  for (const ComparedSignal& signal : signals_) {
    prediction.values.push_back(result->simulated.find(signal.name)->values);
    prediction.values.back().resize(all_rows, nan);
  }
  return prediction;
}

std::optional<Recording> Plant::predictSchedule(const Recording& schedule, const Model& model, Fidelity fidelity) const {
  count(schedule.time_s.back() - schedule.time_s.front());
  std::optional<ReplayResult> result = simulated(schedule, model, fidelity, HeldSamples::drawn);
  if (!result || result->divergence || result->interrupted) return std::nullopt;
  return std::move(result->simulated);
}

/// Which effects need no simulation: those of sensors without memory, on signals on which no effect with memory acts (that one would read
/// what they return), if the user's own model has neither effects of sensors nor noise. read() computes their readings.
Plant::Parts Plant::partsOf(const Model& model) const {
  Parts parts{{{}, model.parameters}, {}};
  const auto overlap = [](const std::string& one, const std::string& other) { return one == other || one == "all" || other == "all"; };
  const auto hasMemory = [](const ActiveEffect& effect) {
    const EffectInfo info = effectInfo(effect.id);
    return info.stage == Stage::sensor && !info.is_memoryless && effect.id != held_effect;
  };
  const bool is_clean = !holds(Stage::sensor) && reference_->effects().noise().empty();
  for (const ActiveEffect& effect : model.effects) {
    const bool can_be_read = is_clean && effectInfo(effect.id).is_memoryless && compares(effect.component) &&
                             std::ranges::none_of(model.effects, [&](const ActiveEffect& other) {
                               return overlap(effect.component, other.component) && hasMemory(other);
                             });
    (can_be_read ? parts.reading : parts.simulated.effects).push_back(effect);
  }
  return parts;
}

/// Turns the values of a prediction into the readings of sensors without memory.
void Plant::read(std::vector<ActiveEffect> effects, Prediction& prediction) const {
  std::ranges::stable_sort(effects, {}, [](const ActiveEffect& effect) { return effectRank(effect.id); });
  for (const ActiveEffect& effect : effects) {
    const EffectInfo info = effectInfo(effect.id);
    const std::unique_ptr<Effect> made = info.make(EffectValues(info.parameters, effectValues(info, effect)));
    auto& sensor = dynamic_cast<SensorEffect&>(*made);
    for (std::size_t i = 0; i < signals_.size(); ++i)
      if (effect.component == "all" || isComponentOf(effect.component, signals_[i].name))
        for (double& value : prediction.values[i]) value = sensor.reading(value, {}, 0);
  }
}

/// Applies held samples to a stored prediction, which does not depend on them.
void Plant::holdSamples(int recording, const Model& model, Prediction& prediction) const {
  for (const ActiveEffect& effect : model.effects) {
    if (effect.id != held_effect) continue;
    for (std::size_t i = 0; i < signals_.size(); ++i)
      if (effect.component == "all" || isComponentOf(effect.component, signals_[i].name))
        holdWhereMeasured(prediction.values[i], measured_[static_cast<std::size_t>(recording)][i]);
  }
}

}  // namespace musclesim
