// How a plant is simulated: the internal steps, and the predictions of models.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "../../base/parallel.h"
#include "musclesim/base/error.h"
#include "musclesim/base/hash.h"
#include "plant.h"

namespace musclesim {

namespace {

constexpr int fewest_to_coarsen = 8;  ///< with fewer internal steps a simulation is cheap and cannot be coarser
constexpr int most_refinement = 8;    ///< internal steps, over those of a replay

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

}  // namespace

Model slightlyStronger() {
  return {{{"force_gain", "all", {{"gain", 1.001}}}}, {}};
}

bool Plant::beginsUnknown(int recording) const {
  const Recording& recorded = recordings_[static_cast<std::size_t>(recording)];
  return !options_.skip_start_s && !options_.model.initial_state && !recorded.info.skip_start_s && !recorded.info.initial_state &&
         !isSimulated(recorded);
}

/// Machines have no internal steps: where these are few, as with massless muscles, twice as many are taken until the error that is left,
/// twice what doubling changes, is below the noise of every signal. Recordings of this program are replayed in the steps they were made in.
void Plant::chooseSubsteps() {
  constexpr double bearable_sigmas = 0.5;
  substeps_ = reference_->substeps();
  if (options_.model.substeps > 0 || substeps_ >= fewest_to_coarsen || !hasStepError()) return;
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

/// Whether the model predicts the first recording to the last digit as before if a number has another value.
bool Plant::changesNothing(const std::string& name, double value) const {
  Model changed;
  changed.parameters.emplace_back(name, value);
  const Prediction before = predict(0, Model{}, 0, Fidelity::coarse), after = predict(0, changed, 0, Fidelity::coarse);
  return !after.diverged && !after.refused && !after.cut && before.values == after.values;
}

/// The muscles of a robot file may have force laws and settings of their own; then the program's numbers for these change nothing. Takes
/// such numbers out of the nominal refit, and writes a note about each that has a tolerance.
void Plant::leaveOutWhatChangesNothing() {
  constexpr double larger = 1.1;
  std::vector<std::pair<std::string, double>> changed;
  for (const auto& [name, value] : nominal_) changed.emplace_back(name, larger * value);
  for (Eigen::Index i = 0; i < numberCount(); ++i) {
    const double given = numberAt(i, numbers_in_force_[i]), more = numberAt(i, numbers_in_force_[i] + 1);
    changed.emplace_back(numbers_[static_cast<std::size_t>(i)].parameter.name,
                         more != given ? more : numberAt(i, numbers_in_force_[i] - 1));
  }
  std::vector<char> is_idle(changed.size());
  parallelFor(static_cast<int>(changed.size()), jobCount(), [&](int i) {
    const auto& [name, value] = changed[static_cast<std::size_t>(i)];
    is_idle[static_cast<std::size_t>(i)] = changesNothing(name, value);
  });
  for (std::size_t i = nominal_.size(); i < changed.size(); ++i)
    if (is_idle[i])
      notes_.push_back(
          fmt::format("{} changes no measured signal of the first recording: its tolerance explains nothing", changed[i].first));
  std::size_t index = 0;
  std::erase_if(nominal_, [&](const auto&) { return is_idle[index++] != 0; });
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

bool Plant::hasStepError() const {
  return std::ranges::none_of(recordings_, isSimulated);
}

Fidelity Plant::possible(Fidelity fidelity) const {
  return substeps_ >= fewest_to_coarsen ? fidelity : std::min(fidelity, Fidelity::fine);
}

/// Where more were chosen than a replay takes, never fewer than that: the search would lose effects in the error of longer steps.
int Plant::substepsOf(Fidelity fidelity) const {
  if (fidelity == Fidelity::finer) return 2 * substeps_;
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
  Hash hash;
  for (const std::vector<double>& row : commands)
    for (const double command : row) hash.add(command);
  const std::string key = simulationKey(recording, rows, fidelity) + modelKey(model) + " commands " + hash.text();
  if (store_.isNew(key)) count(changed.time_s[rows - 1] - changed.time_s.front());
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
  if (!result) return {std::vector<std::vector<double>>(signals_.size(), std::vector<double>(all_rows, std::nan(""))), true, true};
  Prediction prediction;
  prediction.diverged = result->divergence.has_value() || result->interrupted;
  prediction.cut = result->interrupted;
  for (const ComparedSignal& signal : signals_) {
    prediction.values.push_back(result->simulated.find(signal.name)->values);
    prediction.values.back().resize(all_rows, std::nan(""));
  }
  return prediction;
}

std::optional<Recording> Plant::predictSchedule(const Recording& schedule, const Model& model, Fidelity fidelity) const {
  count(schedule.time_s.back() - schedule.time_s.front());
  std::optional<ReplayResult> result = simulated(schedule, model, fidelity, HeldSamples::drawn);
  if (!result || result->divergence || result->interrupted) return std::nullopt;
  return std::move(result->simulated);
}

/// Offsets, gains and other effects of sensors without memory need no simulation; read() computes their readings. They do if an effect with
/// memory acts on the same signal, since it reads what they return, or if the user's own model has effects of sensors or noise.
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
