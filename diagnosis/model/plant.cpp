#include "plant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "../../base/short_names.h"
#include "../../effect/components.h"
#include "../data/data_checks.h"
#include "drawing.h"
#include "musclesim/base/error.h"
#include "musclesim/robot/force_law.h"
#include "stop_contacts.h"

namespace musclesim {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Parameters of the nominal refit: friction within the muscles and the exponent of Eq. 1.
constexpr const char* hinge_friction = "muscle.hinge_friction_Nm";
constexpr const char* braun_exponent = "force_law.b";
constexpr const char* nominal_names[] = {"muscle.slider_friction_N", hinge_friction, braun_exponent};

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
  leaveOutWhatChangesNothing();
}

void Plant::findNominalParameters() {
  const auto any = [&](const auto& has) { return std::ranges::any_of(reference_->world().actuators(), has); };
  const bool has_hinges = any([](const auto& actuator) { return !actuator->hinges().empty(); });
  const bool obeys_eq_1 = any([](const auto& actuator) { return dynamic_cast<const BraunForceLaw*>(&actuator->forceLaw()) != nullptr; });
  const auto acts = [&](const std::string& name) {
    return name == hinge_friction   ? has_hinges
           : name == braun_exponent ? obeys_eq_1
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

/// Removes the readings at the beginning that depend on what the machine did before.
void Plant::dropStarts() {
  for (Recording& recording : recordings_) {
    const double skipped_s = options_.skip_start_s.value_or(recording.info.skip_start_s.value_or(0));
    const double duration_s = recording.time_s.back() - recording.time_s.front();
    if (skipped_s > 0 && skipped_s >= duration_s)
      throw BadFile(recording.file,
                    fmt::format("skip_start_s = {:g} leaves out all its readings: it lasts {:.3g} s", skipped_s, duration_s));
    const auto end = std::ranges::lower_bound(recording.time_s, recording.time_s.front() + skipped_s);
    for (Signal& signal : recording.signals)
      if (!signal.name.starts_with("command_")) std::fill_n(signal.values.begin(), end - recording.time_s.begin(), nan);
    if (skipped_s > 0) notes_.push_back(fmt::format("{}: the readings of the first {:g} s are left out", recording.file, skipped_s));
  }
}

void Plant::compareSignals() {
  measured_.resize(recordings_.size());
  std::ranges::move(dataNotes(recordings_), std::back_inserter(notes_));
  dropDeadSegments();
  dropAfterDropouts();
  dropStarts();
  std::ranges::move(dropAfterStops(recordings_, reference_->robot()), std::back_inserter(notes_));
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
  for (const Recording& recording : recordings_) {
    std::vector<std::string> unknown = unknownSignalNotes(recording, reference_->robot());
    // A misspelt column would leave pressures alone, which agree where the motion may not.
    if (!unknown.empty() && std::ranges::none_of(signals_, [](const ComparedSignal& signal) { return isMotion(signal.name); }))
      throw BadFile(recording.file,
                    fmt::format("{}{} No other column is of a motion: correct the name, or leave the column out with "
                                "--ignore-columns",
                                unknown.front().substr(recording.file.size() + 2), unknown.front().ends_with('?') ? "" : "."));
    std::ranges::move(unknown, std::back_inserter(notes_));
  }
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

/// The first row of a segment with a value that is compared; its end if there is none. Readings are left out where they depend on what the
/// machine did before.
int Plant::firstReading(const Segment& segment) const {
  int first = segment.end_row;
  for (const std::vector<double>& values : measured_[static_cast<std::size_t>(segment.recording)]) {
    const auto end = values.begin() + std::min(first, static_cast<int>(values.size()));
    const auto found = std::find_if(values.begin(), end, [](double value) { return std::isfinite(value); });
    first = found == end ? first : static_cast<int>(found - values.begin());
  }
  return first;
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
    if (!repeated && result.size() < most_recordings && firstReading(segment) < segment.end_row) result.push_back(segment);
  }
  const auto count = static_cast<int>(result.size());
  for (Segment& segment : result) {
    const std::vector<double>& time_s = recordingOf(segment).time_s;
    const int from = std::max(firstChange(recordingOf(segment)), firstReading(segment));
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

std::vector<Parameter> Plant::exactNumbers() const {
  const std::vector<std::string> varying = allThatVaries(recordings_);
  const std::string group = reference_->robot().name() + ".";
  std::vector<Parameter> exact;
  for (const Parameter& parameter : reference_->parameters().declared()) {
    const std::string& name = parameter.name;
    const bool is_factor = std::holds_alternative<double>(parameter.value) && !parameter.integer && std::get<double>(parameter.value) != 0;
    if (is_factor && name.starts_with(group) &&
        std::ranges::none_of(varying, [&](const std::string& listed) { return means(listed, name); }) &&
        std::ranges::none_of(numbers_, [&](const UncertainNumber& number) { return number.parameter.name == name; }))
      exact.push_back(parameter);
  }
  return exact;
}

double Plant::tensionN(int muscle, double pressure_ratio, double length_mm) const {
  return reference_->world().actuators()[static_cast<std::size_t>(muscle)]->calculateForce(pressure_ratio, length_mm);
}

RobotDrawing Plant::drawing() const {
  return drawingOf(*reference_);
}

std::vector<std::string> Plant::muscleNames() const {
  std::vector<std::string> names;
  bool is_numbered = true;
  for (const Actuator* muscle : reference_->robot().actuators()) {
    is_numbered = is_numbered && muscle->name() == fmt::format("muscle_{}", names.size());
    names.push_back(muscle->name());
  }
  return is_numbered ? std::vector<std::string>{} : names;
}

bool Plant::hasHand() const {
  return reference_->robot().getState().hand_mm.has_value();
}

Eigen::MatrixX3d Plant::nominalHandMm(int recording) const {
  const Recording& recorded = recordings_[static_cast<std::size_t>(recording)];
  Eigen::MatrixX3d places(static_cast<Eigen::Index>(recorded.time_s.size()), 3);
  Eigen::Index row = 0;
  ReplayOptions options = options_.model;
  if (hasOwnSubsteps()) options.substeps = substeps_;
  options.watch = [&](Simulation& simulation) -> ReplayOptions::Watcher {
    if (!simulation.robot().hand()) return {};
    return [&](const State&) {
      if (row < places.rows()) places.row(row++) = simulation.robot().handMm();
    };
  };
  const ReplayResult result = replayRecording(recorded, options);
  return result.divergence || row < places.rows() ? Eigen::MatrixX3d() : places;
}

}  // namespace musclesim
