#include "chain_stepper.h"

#include <algorithm>

#include "../../robot/actuator_step.h"
#include "../../robot/ode_vector.h"
#include "../contacts.h"
#include "musclesim/robot/world.h"

namespace musclesim {

ChainStepper::ChainStepper(const World& world, const Contacts& contacts, const BodyBounds& bounds, bool strict)
    : world_(world), contacts_(contacts), bounds_(bounds), strict_(strict) {}

ChainStepper::~ChainStepper() = default;

bool ChainStepper::upToDate() const {
  return revision_ == world_.revision();
}

void ChainStepper::prepare() {
  revision_ = world_.revision();
  registered_reduction_ = world_.errorReduction();
  problem_.reset();
  state_is_current_ = false;
  reason_ = chain::registerModel(world_, model_);
  if (!reason_.empty()) {
    if (strict_) throw BadParameter("stepper", "chain", "be auto, ode or quick for this robot: " + reason_);
    return;
  }
  problem_ = std::make_unique<chain::StepProblem>(model_);
  new_velocity_.resize(static_cast<std::size_t>(model_.bodies.count()));
}

std::string ChainStepper::message() const {
  return reason_.empty() ? "" : "dWorldStep is used, which is slow, because " + reason_;
}

/// Only line muscles need this: the forces of chains are read when their rows are made.
void ChainStepper::applyForces(const Actuators& actuators, double) {
  if (!upToDate()) prepare();
  for (const auto& actuator : actuators)
    if (actuator->line()) musclesim::applyForces(*actuator);
}

void ChainStepper::step(double h_s) {
  if (!upToDate()) prepare();
  ++statistics_.steps;
  state_is_current_ = false;
  if (!problem_) return leaveToOde(h_s);
  if (!solve(h_s)) {
    ++statistics_.unsolved_steps;
    problem_->forget();
    return leaveToOde(h_s);
  }
  model_.bodies.integrate(h_s, new_velocity_, bounds_);
  model_.bodies.scatter();
  state_is_current_ = true;
}

bool ChainStepper::solve(double h_s) {
  const dWorldID world = world_;
  const PhysicsSettings& physics = world_.physics();
  dVector3 gravity;
  dWorldGetGravity(world, gravity);
  chain::StepProblem::Conditions conditions;
  conditions.h_s = h_s;
  conditions.gravity = fromOde(gravity);
  conditions.force_per_N = physics.force_per_N;
  conditions.reduction = {registered_reduction_, physics.errorReductionPerStep(h_s)};
  conditions.contact_reduction = conditions.reduction.of(dWorldGetERP(world));
  conditions.world_softness = conditions.contact_softness = dWorldGetCFM(world);
  if (physics.contact_compliance > 0) {
    const auto stop = PhysicsSettings::stop(physics.contact_compliance, physics.contact_time_constant_s, h_s);
    conditions.contact_reduction = stop.error_reduction;
    conditions.contact_softness = stop.softness;
  }
  conditions.friction_force = contacts_.frictionLimit();
  model_.bodies.gather();
  if (!problem_->begin(conditions, contacts_.points())) return false;
  const chain::ActiveSetResult result = active_set_.run(*problem_, problem_->rows());
  statistics_.rounds += result.rounds;
  statistics_.monotone_rounds += result.monotone_rounds;
  statistics_.largest_rounds = std::max(statistics_.largest_rounds, result.rounds);
  if (result.solved) problem_->end(new_velocity_);
  return result.solved;
}

void ChainStepper::leaveToOde(double h_s) {
  for (const auto& actuator : world_.actuators())
    if (!actuator->line()) musclesim::applyForces(*actuator);
  for (const auto& actuator : world_.actuators()) applyBeadInertia(*actuator, h_s);
  if (!dWorldStep(world_, h_s)) throw OdeFault("dWorldStep ran out of memory");
  for (const auto& actuator : world_.actuators()) applyBeadInertia(*actuator, 0);
}

std::optional<TornJoint> ChainStepper::largestGap() const {
  if (!state_is_current_) return std::nullopt;
  TornJoint largest;
  auto look = [&](const chain::JointModel& joint) {
    const double gap_mm = chain::gapOf(joint, model_.bodies);
    if (!(gap_mm <= largest.gap_mm)) largest = {gap_mm, joint.joint};
  };
  for (const chain::Chain& chain : model_.chains) {
    look(chain.start);
    for (const chain::JointModel& joint : chain.joints) look(joint);
  }
  for (const chain::JointModel& joint : model_.skeleton) look(joint);
  for (const chain::JointModel& joint : model_.fixed) look(joint);
  return largest;
}

}  // namespace musclesim
