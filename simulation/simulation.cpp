#include "musclesim/simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "../base/ode_runtime.h"
#include "../robot/ode_vector.h"
#include "chain/chain_stepper.h"
#include "contacts.h"
#include "internal_step.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/primitive.h"
#include "musclesim/robot/robot_registry.h"

namespace musclesim {

namespace {

thread_local Simulation* current_simulation = nullptr;

constexpr double torn_mm = 7.5;            ///< a joint torn further than this ends the run
constexpr double farthest_mm = 1e5;        ///< a body farther out than 100 m ends the run
constexpr double fastest_m_per_s = 1000;   ///< in true seconds
constexpr double settle_duration_s = 0.5;  ///< of `si` time
/// What to do about a divergence at a time; before 0 the robot settles, and nothing is recorded.
std::string advice(double time_s) {
  return time_s < 0 ? " while it settled under the first command, before the run; try a smaller --step or more --substeps"
                    : "; try a smaller --step or more --substeps, and look at the last rows of the recording";
}

/// A fault may have left ODE in the middle of a call; its contacts are then kept with the world until the process ends, in reach, so that
/// leak checkers do not take them for forgotten.
void keepForEver(std::unique_ptr<Contacts> contacts) {
  static std::mutex access;
  static auto* const kept = new std::vector<std::unique_ptr<Contacts>>;
  const std::lock_guard<std::mutex> lock(access);
  kept->push_back(std::move(contacts));
}

double requireStep(double step_s) {
  if (!(step_s >= 1e-7 && step_s <= 10)) throw BadParameter("step", fmt::format("{} s", step_s), "be a number in 1e-7 .. 10 s");
  return step_s;
}

}  // namespace

Simulation::Simulation(SimulationOptions options)
    : world_(std::make_unique<World>(
          WorldOptions{options.physics, options.plane, options.seed, requireStep(options.step_s), std::move(options.parameters)})),
      interrupted_(std::move(options.interrupted)),
      body_moves_(options.body_moves) {
  if (options.substeps < 0 || options.substeps > 1000000)
    throw BadParameter("substeps", fmt::format("{}", options.substeps), "be a whole number in 1 .. 1000000, or 0 for automatic");
  substeps_given_ = options.substeps > 0;
  substeps_ = substeps_given_ ? options.substeps : automaticSubsteps(stepS(), physics(), {}, {});
  world_->setErrorReduction(physics().errorReductionPerStep(internalStepS()));
  contacts_ = std::make_unique<Contacts>(*world_, space(), physics().contact_friction_N * physics().force_per_N);
  if (options.stepper == StepperKind::quick)
    stepper_ = std::make_unique<QuickStepper>(
        *world_, parameters().integer("physics.quick_iteration_count", 20, 1, 100000, "sweeps of dWorldQuickStep per internal step"),
        static_cast<unsigned long>(seed()));
  else if (options.stepper == StepperKind::ode)
    stepper_ = std::make_unique<OdeStepper>(*world_);
  else
    stepper_ = std::make_unique<ChainStepper>(*world_, *contacts_, bodyBounds(), options.stepper == StepperKind::chain);
  effects_ = std::make_unique<EffectChain>(*world_, std::move(options.effects));
  world_->connect(effects_.get());
  makeCurrent();
}

Simulation::~Simulation() {
  if (current_simulation == this) {
    current_simulation = nullptr;
    Robot::setActiveRobot(nullptr);
    Controller::setActiveController(nullptr);
  }
  if (faulted_) {
    world_->markFaulted();
    keepForEver(std::move(contacts_));
  }
}

Simulation& Simulation::current() {
  if (!current_simulation) throw BadParameter("this thread has no current simulation");
  return *current_simulation;
}

void Simulation::makeCurrent() {
  current_simulation = this;
  Robot::setActiveRobot(robot_.get());
  Controller::setActiveController(controller_.get());
}

Robot& Simulation::robot() {
  if (!robot_) throw BadParameter("this simulation has no robot yet");
  return *robot_;
}

Robot& Simulation::build(const std::string& robot_name) {
  if (robot_) throw BadParameter("this simulation already has a robot");
  return adopt(makeRobot(robot_name, *world_));
}

Robot& Simulation::adopt(std::unique_ptr<Robot> robot) {
  if (robot_) throw BadParameter("this simulation already has a robot");
  robot_ = std::move(robot);
  if (current_simulation == this) makeCurrent();
  effects_->attach(*robot_);
  prepareSteps();
  stepper_->prepare();
  return *robot_;
}

/// Finishes the muscles there are by now, and sets the length of internal steps by them, and what depends on it.
void Simulation::prepareSteps() {
  for (Actuator* actuator : world_->actuators()) actuator->finishPath();
  const double before = world_->errorReduction();
  const bool set_by_user = dWorldGetERP(*world_) != before;
  if (!substeps_given_) substeps_ = automaticSubsteps(stepS(), physics(), world_->joints(), world_->actuators());
  adaptJoints(internalStepS(), before, physics(), world_->joints(), world_->actuators());
  const double now = physics().errorReductionPerStep(internalStepS());
  world_->setErrorReduction(now, set_by_user);
  prepared_actuator_count_ = world_->actuators().size();
  contacts_->reserve(100 + 20 * world_->actuators().size());
}

Controller& Simulation::control(std::unique_ptr<Controller> controller) {
  controller_ = std::move(controller);
  if (current_simulation == this) makeCurrent();
  return *controller_;
}

void Simulation::settle(const Action& command) {
  effects_->settlePressures(command);
  if (!body_moves_) return;
  robot().settle();
  robot().countTurns(true);
  stop();
}

void Simulation::start(const std::string& initial_state, const Action& first_command) {
  Clock& clock = world_->clock();
  if (initial_state == "settled") {
    settle(first_command);
    // In `original` units the same number of true seconds lasts sqrt(1000) times longer.
    const double slowness = std::sqrt(world_force_per_N / physics().force_per_N);
    clock.start(-settle_duration_s * slowness);
    effects_->begin();
    robot().step(first_command);
    advance(settle_duration_s * slowness);
    robot().step(first_command);  // forces at the lengths it has settled to
  } else if (initial_state == "built") {
    effects_->settlePressures(first_command);
    clock.start(0);
    effects_->begin();
    robot().step(first_command);
  } else {
    throw BadParameter("initial_state", initial_state, "be one of built, settled");
  }
  clock.start(0);
  worst_gap_ = tornMost();
}

template <class Function>
void Simulation::untilDiverged(const Function& move) {
  if (divergence_) throw Diverged(*divergence_);
  try {
    move();
  } catch (const Diverged& divergence) {
    divergence_ = divergence;
    throw;
  }
}

void Simulation::step() {
  makeCurrent();
  if (prepared_actuator_count_ != world_->actuators().size()) prepareSteps();
  untilDiverged([&] {
    for (int i = 0; i < substeps_; ++i) internalStep(internalStepS());
    world_->clock().countStep();
    if (robot_) robot_->countTurns();
    requireWhole();
  });
}

void Simulation::advance(double duration_s) {
  if (!(duration_s > 0 && std::isfinite(duration_s)))
    throw BadParameter("duration", fmt::format("{} s", duration_s), "be positive and finite");
  makeCurrent();
  const double whole_steps = std::round(duration_s / stepS());
  if (whole_steps >= 1 && std::abs(whole_steps * stepS() - duration_s) < 1e-9 * std::max(1.0, duration_s)) {
    for (long i = 0; i < static_cast<long>(whole_steps); ++i) step();
    return;
  }
  if (prepared_actuator_count_ != world_->actuators().size()) prepareSteps();
  const auto count = static_cast<long>(std::max(1.0, std::ceil(duration_s / internalStepS() - 1e-6)));
  const double h_s = duration_s / static_cast<double>(count);
  untilDiverged([&] {
    for (long i = 0; i < count; ++i) internalStep(h_s);
    world_->clock().shift(duration_s);
    if (robot_) robot_->countTurns();
    requireWhole();
  });
}

void Simulation::internalStep(double h_s) {
  if (interrupted_ && interrupted_()) throw Interrupted("interrupted within a step");
  MuscleValues& values = world_->values();
  // A sample's way: command -> pressure -> force -> body -> sensor. (Robot::getState takes the readings.)
  effects_->command(values, h_s);
  effects_->pressure(values, h_s);
  if (!body_moves_) {
    effects_->track(h_s);
    world_->clock().countInternalStep(h_s);
    return;
  }
  effects_->force(values, h_s);
  const double now_s = world_->clock().now_s();
  for (const Actuator* actuator : world_->actuators()) {
    if (!std::isfinite(actuator->tensionN()))
      throw Diverged(
          now_s, actuator->name(),
          fmt::format("its tension is {} N at {} mm and pressure {}", actuator->tensionN(), actuator->lengthMm(), actuator->pressure()));
  }
  stepper_->applyForces(world_->actuators(), h_s);
  pushBodies();
  effects_->body(h_s);
  effects_->track(h_s);
  auto& messages = ode_runtime::messagesOfThread();
  const long messages_before = messages.count;
  try {
    collide(h_s);
    stepper_->step(h_s);
    requireFinite();
  } catch (const OdeFault& fault) {
    faulted_ = true;
    throw Diverged(now_s, "the solver", std::string(fault.what()) + advice(now_s));
  } catch (const BodyOutOfBounds& escaped) {
    throw Diverged(now_s + h_s, labelOf(escaped.body()), std::string(escaped.what()) + advice(now_s));
  }
  solver_message_count_ += messages.count - messages_before;
  world_->clock().countInternalStep(h_s);
}

void Simulation::pushBodies() const {
  const double force_per_N = physics().force_per_N;
  for (const auto& element : world_->forceElements())
    element->load(false, [force_per_N](dBodyID body, const BodyLoad& load) {
      const Vector force = load.force_N * force_per_N, torque = load.torque_Nmm * force_per_N;
      dBodyAddForce(body, force.x(), force.y(), force.z());
      dBodyAddTorque(body, torque.x(), torque.y(), torque.z());
    });
  if (pull_) applyPull(*world_, *pull_);
}

void Simulation::pull(const std::optional<Pull>& pull) {
  if (pull) static_cast<void>(pullForce(*world_, *pull));  // throws if there is no such body
  pull_ = pull;
}

void Simulation::collide(double h_s) {
  if (!physics().has_contacts) return;
  if (physics().contact_compliance > 0) {
    const auto stop = PhysicsSettings::stop(physics().contact_compliance, physics().contact_time_constant_s, h_s);
    contacts_->soften(stop.error_reduction, stop.softness);
  }
  contacts_->collide(world_->revision());
}

void Simulation::requireFinite() const {
  if (stepper_->hasCheckedBounds()) return;
  const BodyBounds bounds = bodyBounds();
  auto check = [&](dBodyID body) { bounds.require(body, positionOf(body), fromOde(dBodyGetLinearVel(body))); };
  for (const auto& body : world_->bodies()) check(body->id);
  for (const auto& actuator : world_->actuators())
    for (const Link& link : actuator->links())
      for (const dBodyID bead : link.bead) check(bead);
}

BodyBounds Simulation::bodyBounds() const {
  const double slowness = std::sqrt(world_force_per_N / physics().force_per_N);
  return {farthest_mm, fastest_m_per_s * mm_per_m / slowness};
}

void Simulation::requireWhole() {
  if (!body_moves_) return;
  const std::optional<TornJoint> known = stepper_->largestGap();
  const TornJoint torn = known ? *known : tornMost();
  if (!(torn.gap_mm <= worst_gap_.gap_mm)) worst_gap_ = torn;
  if (!(torn.gap_mm <= torn_mm))
    throw Diverged(world_->clock().now_s(), torn.joint->name(),
                   fmt::format("it is torn by {:.3g} mm{}", torn.gap_mm, advice(world_->clock().now_s())));
}

TornJoint Simulation::tornMost() const {
  TornJoint largest;
  for (const auto& joint : world_->joints()) {
    const double gap_mm = joint->constraintErrorMm();
    if (!(gap_mm <= largest.gap_mm)) largest = {gap_mm, joint.get()};
  }
  return largest;
}

JointGap Simulation::named(const TornJoint& torn) {
  return {torn.gap_mm, torn.joint ? torn.joint->name() : ""};
}

std::string Simulation::labelOf(dBodyID id) const {
  for (const auto& body : world_->bodies())
    if (body->id == id) return body->parts.empty() ? "body" : body->parts.front()->name();
  for (const auto& actuator : world_->actuators())
    for (std::size_t i = 0; i < actuator->links().size(); ++i)
      for (int end = 0; end < 2; ++end)
        if (actuator->links()[i].bead[end] == id)
          return fmt::format("bead {} of {}", 2 * i + static_cast<std::size_t>(end), actuator->name());
  return "environment";
}

int Simulation::contactCount() const {
  return contacts_->count();
}

namespace {

double energyOf(dBodyID body, double gravity) {
  dMass mass;
  dBodyGetMass(body, &mass);
  const Vector v = fromOde(dBodyGetLinearVel(body)), w = fromOde(dBodyGetAngularVel(body));
  const Vector w_body = rotationOf(body).transpose() * w;
  return 0.5 * mass.mass * v.squaredNorm() + 0.5 * w_body.dot(matrixFromOde(mass.I) * w_body) + mass.mass * gravity * positionOf(body).y();
}

}  // namespace

double Simulation::mechanicalEnergyJ() const {
  double energy = 0;
  for (const auto& body : world_->bodies()) energy += energyOf(body->id, physics().gravity_mm_per_s2);
  for (const auto& actuator : world_->actuators())
    for (const Link& link : actuator->links())
      for (const dBodyID bead : link.bead) energy += energyOf(bead, physics().gravity_mm_per_s2);
  return energy / (world_force_per_N * mm_per_m);
}

void Simulation::stop() {
  auto halt = [](dBodyID body) {
    dBodySetLinearVel(body, 0, 0, 0);
    dBodySetAngularVel(body, 0, 0, 0);
  };
  for (const auto& body : world_->bodies()) halt(body->id);
  for (const auto& actuator : world_->actuators())
    for (const Link& link : actuator->links())
      for (const dBodyID bead : link.bead) halt(bead);
}

}  // namespace musclesim
