#include "hypothesis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "../model/measured_values.h"
#include "musclesim/effect/relevance.h"

namespace musclesim {

namespace {

using Quantiles = std::optional<std::pair<double, double>>;

/// The lower and upper `share` quantile.
Quantiles quantiles(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return std::pair{values[static_cast<std::size_t>(share * last)], values[static_cast<std::size_t>((1 - share) * last)]};
}

Quantiles quantiles(const Plant& plant, const std::string& signal, double share) {
  return quantiles(measuredValues(plant, signal), share);
}

/// A twentieth of the span of a signal's readings; of a signal that hardly ever moves its noise.
double typicalChange(const Plant& plant, const ComparedSignal& signal) {
  const auto ends = quantiles(plant, signal.name, 0.02);
  return ends && ends->second > ends->first ? 0.05 * (ends->second - ends->first) : signal.sigma.value;
}

}  // namespace

Hypothesis::Hypothesis(EffectInfo info, std::string component, const Plant& plant)
    : info_(std::move(info)), component_(std::move(component)) {
  for (const EffectParameter& parameter : info_.parameters) base_.push_back(parameter.neutral);
  const auto signal = std::ranges::find_if(
      plant.signals(), [this](const ComparedSignal& compared) { return Plant::isComponentOf(component_, compared.name); });
  for (const std::size_t i : relevantParameters(info_, component_)) {
    const EffectParameter& p = info_.parameters[i];
    if (!p.choices.empty()) continue;
    const bool both_signs = p.usual_low < p.neutral && p.neutral < p.usual_high;
    Coordinate c{i, Scale::linear, 0, 0};
    if (p.shape) {
      const bool positive = p.usual_low > 0;
      c.scale = positive ? Scale::factor : Scale::shift;
      c.typical = positive ? std::sqrt(p.usual_low * p.usual_high) : 0.5 * (p.usual_low + p.usual_high);
      c.unit = 0.5 * (p.usual_high - p.usual_low);
    } else if (std::isinf(p.neutral)) {
      c.scale = Scale::inverse;
      c.typical = std::sqrt(p.usual_low * p.usual_high);
    } else if (both_signs) {
      c.typical = p.neutral + 0.5 * (p.usual_high - p.neutral);
    } else {
      c.typical = p.neutral + std::sqrt(std::abs(p.usual_low - p.neutral) * std::abs(p.usual_high - p.neutral));
    }
    if (p.unit == "unit of the signal" && signal != plant.signals().end()) c.typical = p.neutral + typicalChange(plant, *signal);
    const double extent = std::max(std::abs(p.usual_low - p.neutral), std::abs(p.usual_high - p.neutral));
    if (c.scale == Scale::inverse)
      c.farthest = p.usual_low / strongest;
    else if (c.scale == Scale::linear)
      c.farthest = strongest * (p.unit == "unit of the signal" ? 2 * std::abs(c.typical - p.neutral) : extent);
    if (!p.shape) strengths_.push_back(static_cast<int>(coordinates_.size()));
    coordinates_.push_back(c);
  }
  if (info_.replaces_law) useCorrectedLaw(plant);
  if (info_.id == held_effect) countHeld(plant);
}

/// Counts the share of held samples and the mean length of their runs instead of fitting them.
void Hypothesis::countHeld(const Plant& plant) {
  double samples = 0, held = 0, runs = 0;
  for (std::size_t s = 0; s < plant.signals().size(); ++s) {
    if (component_ != "all" && !Plant::isComponentOf(component_, plant.signals()[s].name)) continue;
    for (std::size_t r = 0; r < plant.recordings().size(); ++r) {
      const std::vector<double>& y = plant.measured(static_cast<int>(r), static_cast<int>(s));
      bool before = false;
      for (std::size_t row = 1; row < y.size(); ++row) {
        const bool is_held = y[row] == y[row - 1];
        samples += std::isfinite(y[row]) ? 1 : 0;
        held += is_held ? 1 : 0;
        runs += is_held && !before ? 1 : 0;
        before = is_held;
      }
    }
  }
  coordinates_.clear();
  strengths_.clear();
  for (std::size_t i = 0; i < info_.parameters.size(); ++i) {
    const EffectParameter& p = info_.parameters[i];
    if (p.name == "fraction" && samples > 0) base_[i] = std::clamp(held / samples, p.minimum, p.maximum);
    if (p.name == "mean_gap_samples" && runs > 0) base_[i] = std::clamp(held / runs, p.minimum, p.maximum);
  }
}

/// Another force law has many constants and no neutral ones, so the terms of Chou and Hannaford are added to the model's law; 0 is neutral
/// for them.
void Hypothesis::useCorrectedLaw(const Plant& plant) {
  constexpr double typical_share = 0.1;  // of the tension at full pressure and length
  const double typical_N = typical_share * plant.tensionN(0, 1, plant.muscleRange(0).maximum_mm);
  coordinates_.clear();
  strengths_.clear();
  for (std::size_t i = 0; i < info_.parameters.size(); ++i) {
    const EffectParameter& p = info_.parameters[i];
    if (p.name == "law") base_[i] = static_cast<double>(std::ranges::find(p.choices, "corrected") - p.choices.begin());
    if (p.name != "braid_N" && p.name != "bore_N" && p.name != "threshold_N" && p.name != "stretch_N") continue;
    base_[i] = 0;
    strengths_.push_back(static_cast<int>(coordinates_.size()));
    coordinates_.push_back({i, Scale::linear, typical_N, 0, 2 * strongest * typical_N});
  }
}

bool Hypothesis::isSigned(int coordinate) const {
  const Coordinate& c = coordinates_[static_cast<std::size_t>(coordinate)];
  const EffectParameter& p = info_.parameters[c.parameter];
  return info_.replaces_law || (c.scale == Scale::linear && p.minimum < p.neutral);
}

void Hypothesis::rescale(int coordinate, double z) {
  Coordinate& c = coordinates_[static_cast<std::size_t>(coordinate)];
  c.typical = valueOf(c, z);
}

void Hypothesis::leaveOut(int coordinate) {
  coordinates_.erase(coordinates_.begin() + coordinate);
  std::erase(strengths_, coordinate);
  for (int& strength : strengths_) strength -= strength > coordinate;
}

std::string Hypothesis::place() const {
  const Stage stage = info_.stage;
  return (place_count_ > 1 ? component_ : "all") + (stage == Stage::sensor                                ? " sensor"
                                                    : stage == Stage::command || stage == Stage::pressure ? " pressure"
                                                                                                          : " motion");
}

std::vector<std::string> Hypothesis::strengthNames() const {
  std::vector<std::string> names;
  for (const int strength : strengths_) names.push_back(info_.parameters[coordinates_[static_cast<std::size_t>(strength)].parameter].name);
  return names;
}

bool Hypothesis::isTime(int coordinate) const {
  return info_.parameters[coordinates_[static_cast<std::size_t>(coordinate)].parameter].unit == "s";
}

int Hypothesis::counterpartOf(int coordinate) const {
  const auto nameOf = [this](const Coordinate& c) -> const std::string& { return info_.parameters[c.parameter].name; };
  const std::string fill = "fill_", vent = "vent_", &name = nameOf(coordinates_[static_cast<std::size_t>(coordinate)]);
  const std::string wanted = name.starts_with(fill)   ? vent + name.substr(fill.size())
                             : name.starts_with(vent) ? fill + name.substr(vent.size())
                                                      : "";
  const auto found = std::ranges::find_if(coordinates_, [&](const Coordinate& c) { return nameOf(c) == wanted; });
  return found == coordinates_.end() ? -1 : static_cast<int>(found - coordinates_.begin());
}

double Hypothesis::coordinateLike(int coordinate, int other, double z_of_other) const {
  return coordinateOf(coordinates_[static_cast<std::size_t>(coordinate)],
                      valueOf(coordinates_[static_cast<std::size_t>(other)], z_of_other));
}

double Hypothesis::valueOf(const Coordinate& c, double z) const {
  const double base = base_[c.parameter];
  switch (c.scale) {
    case Scale::linear:
      return base + z * (c.typical - base);
    case Scale::inverse:
      return c.typical / z;  // z = 0: infinite
    case Scale::factor:
      return c.typical * std::exp(z);
    case Scale::shift:
      return c.typical + z * c.unit;
  }
  return base;
}

double Hypothesis::coordinateOf(const Coordinate& c, double value) const {
  const double base = base_[c.parameter];
  switch (c.scale) {
    case Scale::linear:
      return (value - base) / (c.typical - base);
    case Scale::inverse:
      return c.typical / value;
    case Scale::factor:
      return std::log(value / c.typical);
    case Scale::shift:
      return (value - c.typical) / c.unit;
  }
  return 0;
}

Eigen::VectorXd Hypothesis::clamped(Eigen::VectorXd z) const {
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& c = coordinates_[i];
    const EffectParameter& p = info_.parameters[c.parameter];
    double low_value = p.minimum, high_value = p.maximum;
    if (c.scale == Scale::factor) low_value = std::max(low_value, p.usual_low / 3), high_value = std::min(high_value, p.usual_high * 3);
    if (c.scale == Scale::inverse) low_value = std::max(low_value, c.farthest);
    if (c.scale == Scale::linear && c.farthest > 0)
      low_value = std::max(low_value, base_[c.parameter] - c.farthest), high_value = std::min(high_value, base_[c.parameter] + c.farthest);
    double first = coordinateOf(c, low_value), second = coordinateOf(c, high_value);
    if (first > second) std::swap(first, second);
    if (std::isinf(p.neutral)) first = std::max(first, 1e-6);
    auto& value = z[static_cast<Eigen::Index>(i)];
    value = std::clamp(value, first, second);
  }
  return z;
}

std::vector<std::pair<std::string, double>> Hypothesis::valuesAt(const Eigen::VectorXd& z) const {
  std::vector<std::pair<std::string, double>> values;
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const EffectParameter& p = info_.parameters[coordinates_[i].parameter];
    values.emplace_back(p.name, std::clamp(valueOf(coordinates_[i], z[static_cast<Eigen::Index>(i)]), p.minimum, p.maximum));
  }
  for (std::size_t i = 0; i < info_.parameters.size(); ++i) {
    const EffectParameter& p = info_.parameters[i];
    const bool fitted = std::ranges::any_of(coordinates_, [&](const Coordinate& c) { return c.parameter == i; });
    if (!fitted && p.choices.empty() && base_[i] != p.neutral) values.emplace_back(p.name, base_[i]);
  }
  return values;
}

Eigen::VectorXd Hypothesis::coordinatesOf(const std::map<std::string, Parameter::Value>& values) const {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(coordinateCount());
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const auto value = values.find(info_.parameters[coordinates_[i].parameter].name);
    if (value != values.end() && std::holds_alternative<double>(value->second))
      z[static_cast<Eigen::Index>(i)] = coordinateOf(coordinates_[i], std::get<double>(value->second));
  }
  return clamped(z);
}

std::pair<Eigen::VectorXd, int> Hypothesis::nearestTo(const ActiveEffect& effect) const {
  constexpr double same = 1e-6;  // relative
  const std::vector<double> wanted = effectValues(info_, effect);
  const Eigen::VectorXd z = coordinatesOf(activeEffect(info_, component_, wanted).parameters);
  const std::vector<double> reached = effectValues(info_, at(z));
  int others = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) others += std::abs(reached[i] - wanted[i]) > same * std::abs(wanted[i]) ? 1 : 0;
  return {z, others};
}

std::map<std::string, std::string> Hypothesis::choices() const {
  std::map<std::string, std::string> result;
  for (const std::size_t i : relevantParameters(info_, component_))
    if (const EffectParameter& p = info_.parameters[i]; !p.choices.empty()) result[p.name] = p.choices[static_cast<std::size_t>(base_[i])];
  return result;
}

ActiveEffect Hypothesis::at(const Eigen::VectorXd& z) const {
  std::vector<double> values = base_;
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const EffectParameter& p = info_.parameters[coordinates_[i].parameter];
    values[coordinates_[i].parameter] = std::clamp(valueOf(coordinates_[i], z[static_cast<Eigen::Index>(i)]), p.minimum, p.maximum);
  }
  return activeEffect(info_, component_, values);
}

/// How many times its usual range a coordinate's value needs; at most 1 within it.
double Hypothesis::stretchOf(int coordinate, double z) const {
  const Coordinate& c = coordinates_[static_cast<std::size_t>(coordinate)];
  const EffectParameter& p = info_.parameters[c.parameter];
  const double value = std::clamp(valueOf(c, z), p.minimum, p.maximum);
  if (c.scale == Scale::factor) return std::max(value / p.usual_high, p.usual_low / value);
  if (std::isinf(p.neutral)) return p.usual_low / value;
  // Of a factor: its logarithm counts where it is below 1. A ninth of the force is odder than 1.9 times the force.
  constexpr double least_share = 1e-6;
  if (p.neutral == 1 && p.minimum == 0 && value < 1) return std::log(std::max(value, least_share)) / std::log(p.usual_low);
  return std::abs(value - p.neutral) / std::max(std::abs(p.usual_low - p.neutral), std::abs(p.usual_high - p.neutral));
}

double Hypothesis::excess(const Eigen::VectorXd& z) const {
  double sum = 0;
  for (int i = 0; i < coordinateCount(); ++i) {
    const Coordinate& c = coordinates_[static_cast<std::size_t>(i)];
    const bool is_strength = std::ranges::find(strengths_, i) != strengths_.end();
    if (!(is_strength || c.scale == Scale::factor) || info_.parameters[c.parameter].unit == "unit of the signal" || info_.replaces_law)
      continue;
    const double ratio = stretchOf(i, z[i]);
    if (ratio > 1 && std::isfinite(ratio)) sum += std::log(ratio);
  }
  return sum;
}

Eigen::VectorXd Hypothesis::typical() const {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(coordinateCount());
  for (const int strength : strengths_) z[strength] = 1;
  return z;
}

/// One variant per whole number of bits, rounded and truncated, with full scale at the highest level and one beyond it; nothing is fitted.
std::vector<Hypothesis> Hypothesis::numbersOfBits() const {
  constexpr int fewest = 3, most = 10;
  std::vector<Hypothesis> result;
  for (int bits = fewest; bits <= most; ++bits)
    for (const double rounding_point : {0.5, 1.0})
      for (const double top_level : {1.0, 0.0}) {
        Hypothesis variant = *this;
        for (std::size_t i = 0; i < info_.parameters.size(); ++i) {
          const std::string& name = info_.parameters[i].name;
          variant.base_[i] = name == "bits" ? bits : name == "top_level" ? top_level : rounding_point;
        }
        variant.coordinates_.clear();
        variant.strengths_.clear();
        result.push_back(std::move(variant));
      }
  return result;
}

/// Two variants: a small leak shows as the lag of its regulator, a large one as a pressure that the regulator cannot hold.
std::vector<Hypothesis> Hypothesis::smallAndLarge() const {
  constexpr double large = 0.5;  // times the upper end of the usual range
  std::vector<Hypothesis> result = {*this, *this};
  for (const int strength : strengths_) {
    Coordinate& c = result.back().coordinates_[static_cast<std::size_t>(strength)];
    c.typical = large * info_.parameters[c.parameter].usual_high;
  }
  return result;
}

std::vector<int> Hypothesis::furtherMechanisms() const {
  std::vector<int> result;
  for (int i = 0; i < coordinateCount(); ++i)
    if (info_.parameters[coordinates_[static_cast<std::size_t>(i)].parameter].adds_mechanism) result.push_back(i);
  return result;
}

/// With and without shares that may be zero (of further lags, of a filter, of friction that depends on the pressure): the simpler law is
/// also fitted by itself, because a share leads fits away from its optimum.
std::vector<Hypothesis> Hypothesis::withAndWithoutShares() const {
  Hypothesis without = *this;
  for (int i = coordinateCount() - 1; i >= 0; --i) {
    const Coordinate& c = coordinates_[static_cast<std::size_t>(i)];
    const EffectParameter& p = info_.parameters[c.parameter];
    if (c.scale == Scale::shift && p.minimum == p.neutral && p.usual_low == p.neutral) without.leaveOut(i);
  }
  return without.coordinateCount() < coordinateCount() ? std::vector{*this, std::move(without)} : std::vector{*this};
}

/// The first strength with and without the shares, which belong to its law, and each further one alone, without shares. A fit of all would
/// have to tell what they share. On a robot that moves in one joint only the first: constant friction of the muscles is nearly friction of
/// that joint there, and two effects that nothing tells apart lead the search astray.
std::vector<Hypothesis> Hypothesis::eachLaw(const Plant& plant) const {
  const Robot& robot = plant.model().robot();
  const bool moves_in_one = robot.angles().size() + robot.slides().size() < 2;
  std::vector<Hypothesis> result;
  for (const int kept : strengths_) {
    Hypothesis one = *this;
    for (int i = coordinateCount() - 1; i >= 0; --i)
      if (i != kept && std::ranges::find(strengths_, i) != strengths_.end()) one.leaveOut(i);
    std::vector<Hypothesis> own = one.withAndWithoutShares();
    if (kept == strengths_.front())
      result = std::move(own);
    else if (!moves_in_one)
      result.push_back(std::move(own.back()));
  }
  return result;
}

/// Variants for the start and the end of a muscle, if the robot has both.
std::vector<Hypothesis> Hypothesis::ends(const Plant& plant) const {
  std::vector<Hypothesis> result;
  for (const MuscleEnd end : {MuscleEnd::start, MuscleEnd::end}) {
    const int muscle = component_ == "all" ? 0 : std::stoi(component_.substr(std::string("muscle_").size()));
    if (!plant.model().robot().asksForOffset(muscle, end)) continue;
    result.push_back(*this);
    for (std::size_t i = 0; i < info_.parameters.size(); ++i)
      if (info_.parameters[i].name == "attachment") result.back().base_[i] = end == MuscleEnd::start ? 0 : 1;
  }
  return result;
}

/// All strengths together, and each alone: a tilt about an axis in the plane of motion acts by its square, so small steps do not show it,
/// and beside another strength it would not be increased.
std::vector<Hypothesis> Hypothesis::togetherAndAlone() const {
  std::vector<Hypothesis> result = {*this};
  for (int kept = 0; kept < coordinateCount(); ++kept) {
    Hypothesis alone = *this;
    for (int i = coordinateCount() - 1; i >= 0; --i)
      if (i != kept) alone.leaveOut(i);
    result.push_back(std::move(alone));
  }
  return result;
}

/// Stops that are hard, and stops that give way: how far is no strength, because stops that are not reached show neither.
std::vector<Hypothesis> Hypothesis::hardAndYielding() const {
  Hypothesis hard = *this, yielding = *this;
  for (int i = coordinateCount() - 1; i >= 0; --i) {
    if (isSigned(i)) continue;
    hard.leaveOut(i);
    Coordinate& c = yielding.coordinates_[static_cast<std::size_t>(i)];
    c.scale = Scale::factor;
    std::erase(yielding.strengths_, i);
  }
  return {std::move(hard), std::move(yielding)};
}

/// Walls on either side of where a joint or the hand was most of the time.
std::vector<Hypothesis> Hypothesis::sides(const Plant& plant) const {
  std::vector<Hypothesis> result;
  auto add = [&](const std::string& plane, double at, const std::string& side, int axis) {
    Hypothesis variant = *this;
    for (std::size_t i = 0; i < info_.parameters.size(); ++i) {
      const EffectParameter& p = info_.parameters[i];
      if (p.name == "side") variant.base_[i] = static_cast<double>(std::ranges::find(p.choices, side) - p.choices.begin());
      if (p.name == "axis") variant.base_[i] = axis;
      if (p.name != plane) continue;
      for (Coordinate& c : variant.coordinates_)
        if (c.parameter == i) c.typical = at, c.unit = std::max(1.0, std::abs(at) * 0.1);
    }
    result.push_back(std::move(variant));
  };
  auto addBothSides = [&](const std::string& plane, const std::pair<double, double>& ends, int axis) {
    add(plane, ends.second, "beyond", axis);
    add(plane, ends.first, "below", axis);
  };
  if (component_.starts_with("joint_")) {
    if (const auto ends = quantiles(plant, "angle_" + component_.substr(6) + "_deg", 0.2)) addBothSides("plane_deg", *ends, 0);
    return result;
  }
  const std::array<std::vector<double>, 3> hand = handMm(plant);
  for (int axis = 0; axis < 3; ++axis)
    if (const auto ends = quantiles(hand[static_cast<std::size_t>(axis)], 0.2)) addBothSides("plane_mm", *ends, axis);
  return result;
}

std::vector<Hypothesis> Hypothesis::variants(const Plant& plant) const {
  switch (info_.variants) {
    case Variants::shares:
      return withAndWithoutShares();
    case Variants::laws:
      return eachLaw(plant);
    case Variants::strengths:
      return togetherAndAlone();
    case Variants::sizes:
      return smallAndLarge();
    case Variants::bits:
      return numbersOfBits();
    case Variants::ends:
      return ends(plant);
    case Variants::sides:
      return sides(plant);
    case Variants::stops:
      return hardAndYielding();
  }
  return {};
}

bool allows(const DiagnosisOptions& options, const std::string& id) {
  auto contains = [&](const std::vector<std::string>& ids) { return std::ranges::find(ids, id) != ids.end(); };
  return (options.candidates.empty() || contains(options.candidates)) && !contains(options.exclude);
}

std::vector<Hypothesis> hypotheses(const Plant& plant, const DiagnosisOptions& options) {
  std::vector<Hypothesis> result;
  for (const EffectInfo& info : effectCatalogue()) {
    if (!allows(options, info.id)) continue;
    const std::size_t first = result.size();
    std::set<std::string> places;
    for (const std::string& component : plant.componentsFor(info)) {
      // A wall stops one joint or the hand, not all.
      if (component == "all" && info.acts_on.size() > 1) continue;
      // Effects without relevant parameters on this component cannot act, such as play between a gauge and a pressure.
      if (!info.parameters.empty() && relevantParameters(info, component).empty()) continue;
      // Sensors fail one at a time, but a clock or a logger may fail for all at once.
      if (info.stage == Stage::sensor && (!plant.compares(component) || (component == "all" && !info.may_be_shared))) continue;
      if (component != "all") places.insert(component);
      for (Hypothesis& variant : Hypothesis(info, component, plant).variants(plant)) result.push_back(std::move(variant));
    }
    for (std::size_t i = first; i < result.size(); ++i)
      if (result[i].component() != "all") result[i].place_count_ = static_cast<int>(places.size());
  }
  return result;
}

}  // namespace musclesim
