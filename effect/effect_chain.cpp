#include "musclesim/effect/effect_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../robot/ode_vector.h"
#include "components.h"
#include "force_stack.h"
#include "length_rate.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/robot/robot.h"
#include "pressure/muscle_air.h"
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
  explicit Muscle(const Actuator& muscle) : actuator(muscle), forces(muscle), length_rate(muscle) {}

  const Actuator& actuator;
  ForceStack forces;
  LengthRate length_rate;
  MuscleAir* air = nullptr;  ///< while effects are added: the one whose balance takes up the next one; null if there is none
};

EffectChain::EffectChain(World& world, std::vector<ActiveEffect> effects)
    : world_(world), given_(std::move(effects)), sensors_(std::make_unique<SensorStage>()) {
  for (const ActiveEffect& effect : given_) {
    EffectInfo info = effectInfo(effect.id);
    const std::vector<double> values = effectValues(info, effect);
    if (isNeutral(info, values)) continue;
    planned_.push_back({std::move(info), effectRank(effect.id), effect.component, values});
  }
  std::stable_sort(planned_.begin(), planned_.end(), [](const Planned& a, const Planned& b) {
    return a.info.stage != b.info.stage ? a.info.stage < b.info.stage : a.rank < b.rank;
  });
}

EffectChain::~EffectChain() = default;

void EffectChain::attach(Robot& robot) {
  robot_ = &robot;
  world_.putFirst(robot.actuators());
  muscles_.clear();
  requireMuscles();
  for (const ActiveEffect& effect : given_) placesFor(effectInfo(effect.id), effect.component, world_, robot);
  for (const Planned& planned : planned_)
    for (const EffectPlace& place : placesFor(planned.info, planned.component, world_, robot)) addObject(planned, place);
  sensors_->addNoise(world_, robot);
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

void EffectChain::addObject(const Planned& planned, EffectPlace place) {
  if (place.muscle >= 0) place.length_rate = &muscles_[static_cast<std::size_t>(place.muscle)]->length_rate;
  const EffectInfo& info = planned.info;
  std::unique_ptr<Effect> effect = info.make(EffectValues(info.parameters, planned.values));
  effect->attach(place);
  switch (info.stage) {
    case Stage::command:
      return command_.push_back(as<RatioEffect>(std::move(effect), info));
    case Stage::pressure:
      if (place.muscle >= 0) joinBalance(*muscles_[static_cast<std::size_t>(place.muscle)], dynamic_cast<MuscleAir*>(effect.get()));
      return pressure_.push_back(as<RatioEffect>(std::move(effect), info));
    case Stage::force:
      return muscles_[static_cast<std::size_t>(place.muscle)]->forces.add(as<ForceEffect>(std::move(effect), info));
    case Stage::body:
      return body_.push_back(as<BodyEffect>(std::move(effect), info));
    case Stage::sensor:
      return sensors_->add(place.signal, as<SensorEffect>(std::move(effect), info));
  }
}

/// Tells a muscle of the next effect on its pressure; null if that does not act on the muscle's air. The first effect on the air holds the
/// balance, and the next ones become terms of it, until an effect of another kind comes.
void EffectChain::joinBalance(Muscle& muscle, MuscleAir* effect) {
  if (muscle.air && effect && effect->isTerm())
    muscle.air->takeUp(*effect);
  else
    muscle.air = effect;
}

/// Takes in muscles that have been built since the last call.
void EffectChain::requireMuscles() {
  if (!robot_ && !planned_.empty()) throw BadParameter("effects: this simulation has no robot that they could act on");
  const std::vector<Actuator*>& actuators = world_.actuators();
  for (std::size_t i = muscles_.size(); i < actuators.size(); ++i) muscles_.push_back(std::make_unique<Muscle>(*actuators[i]));
}

void EffectChain::command(MuscleValues& values, double h_s) {
  requireMuscles();
  values.pressure_ratio = values.command_ratio;
  for (const auto& effect : command_) effect->apply(values.pressure_ratio, at(h_s));
}

void EffectChain::pressure(MuscleValues& values, double h_s) {
  for (const auto& effect : pressure_) effect->apply(values.pressure_ratio, at(h_s));
}

MuscleInput EffectChain::inputOf(std::size_t muscle, double pressure_ratio, double h_s) const {
  const Muscle& one = *muscles_[muscle];
  return {pressure_ratio, one.actuator.lengthMm(), one.length_rate.mmPerS(), at(h_s)};
}

void EffectChain::force(MuscleValues& values, double h_s) {
  for (std::size_t i = 0; i < muscles_.size(); ++i) {
    Muscle& muscle = *muscles_[i];
    double& tension_N = values.tension_N[i];
    if (muscle.forces.empty()) {
      tension_N = muscle.actuator.cleanTensionN(values.pressure_ratio[i]);
    } else {
      tension_N = muscle.forces.tensionN(inputOf(i, values.pressure_ratio[i], h_s));
      if (muscle.actuator.line() && tension_N < 0) tension_N = 0;  // a thread does not push
      if (h_s > 0) muscle.forces.advance(h_s);
    }
    if (h_s > 0 && (!pressure_.empty() || !muscle.forces.empty())) muscle.length_rate.beginStep(h_s);
  }
}

void EffectChain::body(double h_s) {
  for (const auto& effect : body_) effect->apply(at(h_s));
}

void EffectChain::track(double h_s) {
  if (!sensors_->empty()) sensors_->track(*robot_, at(h_s));
}

void EffectChain::update() {
  MuscleValues& values = world_.values();
  command(values, 0);
  pressure(values, 0);
  force(values, 0);
}

void EffectChain::read(State& state) {
  if (!sensors_->empty()) sensors_->read(*robot_, state, at(0));
}

void EffectChain::settlePressures(const Action& command) {
  requireMuscles();
  for (const auto* stage : {&command_, &pressure_})
    for (const auto& effect : *stage) effect->reset();
  MuscleValues& values = world_.values();
  for (std::size_t i = 0; i < std::min(command.size(), muscles_.size()); ++i) world_.actuators()[i]->setPressure(command[i]);
  for (const auto& muscle : muscles_) muscle->length_rate.reset();
  values.pressure_ratio = values.command_ratio;
  for (const auto* stage : {&command_, &pressure_})
    for (const auto& effect : *stage) effect->settle(values.pressure_ratio);
}

double EffectChain::restingTensionN(int muscle, double length_mm) {
  requireMuscles();
  Muscle& one = *muscles_[static_cast<std::size_t>(muscle)];
  const MuscleInput input = {one.actuator.pressure(), length_mm, 0, at(0)};
  if (one.forces.empty()) return one.actuator.calculateForce(input.pressure_ratio, length_mm);
  one.forces.settle(input);
  return one.forces.tensionN(input);
}

BodyLoad EffectChain::restingLoad(const Primitive& primitive) {
  BodyLoad load;
  if (body_.empty()) return load;
  body(0);
  const double force_per_N = world_.physics().force_per_N;
  const dBodyID id = primitive.body().id;
  load.force_N = fromOde(dBodyGetForce(id)) / force_per_N;
  load.torque_Nmm = fromOde(dBodyGetTorque(id)) / force_per_N;
  for (const auto& body : world_.bodies()) {
    dBodySetForce(body->id, 0, 0, 0);
    dBodySetTorque(body->id, 0, 0, 0);
  }
  return load;
}

void EffectChain::begin() {
  requireMuscles();
  for (const auto& effect : body_) effect->reset();
  sensors_->reset();
  for (std::size_t i = 0; i < muscles_.size(); ++i) {
    Muscle& muscle = *muscles_[i];
    muscle.length_rate.reset();
    if (!muscle.forces.empty()) muscle.forces.settle(inputOf(i, world_.values().pressure_ratio[i], 0));
  }
}

const std::map<std::string, double>& EffectChain::noise() const {
  return sensors_->noise();
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
