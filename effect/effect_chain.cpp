#include "musclesim/effect/effect_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../robot/ode_vector.h"
#include "components.h"
#include "force_stack.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/simulation.h"
#include "sensor_stage.h"

namespace musclesim {

/// An effect that is not neutral.
struct EffectChain::Planned {
  EffectInfo info;
  std::size_t rank;  ///< place in the catalogue
  std::string component;
  std::vector<double> values;
};

struct EffectChain::Muscle {
  Actuator* actuator;
  ForceStack forces;
  double length_before_mm = 0, step_before_s = 0;  ///< at the begin of the last internal step, and its length

  double rateMmPerS() const { return step_before_s > 0 ? (actuator->lengthMm() - length_before_mm) / step_before_s : 0; }
};

EffectChain::EffectChain(Simulation& simulation, std::vector<ActiveEffect> effects)
    : simulation_(simulation), given_(std::move(effects)), sensors_(std::make_unique<SensorStage>()) {
  if (given_.empty()) return;
  const std::vector<EffectInfo> catalogue = effectCatalogue();
  for (const ActiveEffect& effect : given_) {
    EffectInfo info = effectInfo(effect.id);
    const auto found = std::find_if(catalogue.begin(), catalogue.end(), [&](const EffectInfo& entry) { return entry.id == effect.id; });
    const std::vector<double> values = effectValues(info, effect);
    if (isNeutral(info, values)) continue;
    planned_.push_back({std::move(info), static_cast<std::size_t>(found - catalogue.begin()), effect.component, values});
  }
  std::stable_sort(planned_.begin(), planned_.end(), [](const Planned& a, const Planned& b) {
    return a.info.stage != b.info.stage ? a.info.stage < b.info.stage : a.rank < b.rank;
  });
}

EffectChain::~EffectChain() = default;

void EffectChain::attach() {
  attached_ = true;
  requireMuscles();
  for (const ActiveEffect& effect : given_) placesFor(effectInfo(effect.id), effect.component, simulation_);
  for (const Planned& planned : planned_)
    for (const EffectPlace& place : placesFor(planned.info, planned.component, simulation_)) addObject(planned, place);
  sensors_->addNoise(simulation_);
}

namespace {

/// The effect as an object of its stage's class; a registered effect may be of a wrong one.
template <class StageEffect>
std::unique_ptr<StageEffect> as(std::unique_ptr<Effect> effect, const EffectInfo& info) {
  if (!dynamic_cast<StageEffect*>(effect.get()))
    throw BadParameter(fmt::format("effect {}: its class does not belong to the {} stage", info.id, nameOf(info.stage)));
  return std::unique_ptr<StageEffect>(dynamic_cast<StageEffect*>(effect.release()));
}

}  // namespace

void EffectChain::addObject(const Planned& planned, const EffectPlace& place) {
  const EffectInfo& info = planned.info;
  std::unique_ptr<Effect> effect = info.make(EffectValues(info.parameters, planned.values));
  effect->attach(place);
  switch (info.stage) {
    case Stage::command:
      return command_.push_back(as<RatioEffect>(std::move(effect), info));
    case Stage::pressure:
      return pressure_.push_back(as<RatioEffect>(std::move(effect), info));
    case Stage::force:
      return muscles_[static_cast<std::size_t>(place.muscle)].forces.add(as<ForceEffect>(std::move(effect), info));
    case Stage::body:
      return body_.push_back(as<BodyEffect>(std::move(effect), info));
    case Stage::sensor:
      return sensors_->add(place.signal, as<SensorEffect>(std::move(effect), info));
  }
}

void EffectChain::requireMuscles() {
  if (!attached_ && !planned_.empty()) throw BadParameter("effects: this simulation has no robot that they could act on");
  if (muscles_.size() == simulation_.actuators().size()) return;
  auto add = [&](Actuator* actuator) {
    const bool known = std::any_of(muscles_.begin(), muscles_.end(), [&](const Muscle& m) { return m.actuator == actuator; });
    if (!known) muscles_.push_back({actuator, ForceStack(*actuator)});
  };
  if (attached_)
    for (Actuator* actuator : simulation_.robot().actuators()) add(actuator);
  for (const auto& actuator : simulation_.actuators()) add(actuator.get());
  ratios_.resize(muscles_.size());
}

void EffectChain::command(double h_s) {
  requireMuscles();
  for (std::size_t i = 0; i < muscles_.size(); ++i) ratios_[i] = muscles_[i].actuator->command();
  for (const auto& effect : command_) effect->apply(ratios_, {clock_s_, h_s});
}

void EffectChain::pressure(double h_s) {
  for (const auto& effect : pressure_) effect->apply(ratios_, {clock_s_, h_s});
  for (std::size_t i = 0; i < muscles_.size(); ++i) muscles_[i].actuator->takePressure(ratios_[i]);
}

MuscleInput EffectChain::inputOf(const Muscle& muscle, double h_s) const {
  return {muscle.actuator->pressure(), muscle.actuator->lengthMm(), muscle.rateMmPerS(), {clock_s_, h_s}};
}

void EffectChain::force(double h_s) {
  for (Muscle& muscle : muscles_) {
    if (muscle.forces.empty()) {
      muscle.actuator->updateTension();
    } else {
      const double tension_N = muscle.forces.tensionN(inputOf(muscle, h_s));
      muscle.actuator->takeTension(muscle.actuator->line() && tension_N < 0 ? 0 : tension_N);  // a thread does not push
      if (h_s > 0) muscle.forces.advance(h_s);
    }
    if (h_s > 0 && (!pressure_.empty() || !muscle.forces.empty())) {
      muscle.length_before_mm = muscle.actuator->lengthMm();
      muscle.step_before_s = h_s;
    }
  }
}

void EffectChain::body(double h_s) {
  for (const auto& effect : body_) effect->apply({clock_s_, h_s});
}

void EffectChain::track(double h_s) {
  if (!sensors_->empty()) sensors_->track(simulation_.robot(), {clock_s_, h_s});
  clock_s_ += h_s;
}

void EffectChain::read(State& state) {
  if (!sensors_->empty()) sensors_->read(simulation_.robot(), state, {clock_s_, 0});
}

void EffectChain::settlePressures(const Action& command) {
  requireMuscles();
  for (const auto* stage : {&command_, &pressure_})
    for (const auto& effect : *stage) effect->reset();
  for (std::size_t i = 0; i < muscles_.size(); ++i) {
    if (i < command.size()) muscles_[i].actuator->setPressure(command[i]);
    muscles_[i].step_before_s = 0;
    ratios_[i] = muscles_[i].actuator->command();
  }
  for (const auto* stage : {&command_, &pressure_})
    for (const auto& effect : *stage) effect->settle(ratios_);
  for (std::size_t i = 0; i < muscles_.size(); ++i) muscles_[i].actuator->takePressure(ratios_[i]);
}

double EffectChain::restingTensionN(int muscle, double length_mm) {
  requireMuscles();
  Muscle& one = muscles_[static_cast<std::size_t>(muscle)];
  const MuscleInput input = {one.actuator->pressure(), length_mm, 0, {clock_s_, 0}};
  if (one.forces.empty()) return one.actuator->calculateForce(input.pressure_ratio, length_mm);
  one.forces.settle(input);
  return one.forces.tensionN(input);
}

BodyLoad EffectChain::restingLoad(const Primitive& primitive) {
  BodyLoad load;
  if (body_.empty()) return load;
  body(0);
  const double force_per_N = simulation_.physics().force_per_N;
  const dBodyID id = primitive.body().id;
  load.force_N = fromOde(dBodyGetForce(id)) / force_per_N;
  load.torque_Nmm = fromOde(dBodyGetTorque(id)) / force_per_N;
  for (const auto& body : simulation_.bodies()) {
    dBodySetForce(body->id, 0, 0, 0);
    dBodySetTorque(body->id, 0, 0, 0);
  }
  return load;
}

void EffectChain::begin(double clock_s) {
  requireMuscles();
  clock_s_ = clock_s;
  for (const auto& effect : body_) effect->reset();
  sensors_->reset();
  for (Muscle& muscle : muscles_) {
    muscle.step_before_s = 0;
    if (!muscle.forces.empty()) muscle.forces.settle(inputOf(muscle, 0));
  }
}

const std::map<std::string, double>& EffectChain::noise() const {
  return sensors_->noise();
}

double EffectChain::lengthRateMmPerS(std::size_t muscle) const {
  return muscles_[muscle].rateMmPerS();
}

bool EffectChain::has(const std::string& id) const {
  return std::any_of(planned_.begin(), planned_.end(), [&](const Planned& planned) { return planned.info.id == id; });
}

Vector EffectChain::mountOffsetMm(int muscle, MuscleEnd end, const Vector& lever) const {
  Vector sum = Vector::Zero();
  const Vector up = Vector::UnitY() - lever.y() * lever;
  for (const Planned& planned : planned_) {
    if (!planned.info.mount_offset_mm || (planned.component != "all" && planned.component != fmt::format("muscle_{}", muscle))) continue;
    const Eigen::Vector2d offset_mm = planned.info.mount_offset_mm(EffectValues(planned.info.parameters, planned.values), end);
    sum += offset_mm.x() * lever + offset_mm.y() * up.stableNormalized();
  }
  return sum;
}

}  // namespace musclesim
