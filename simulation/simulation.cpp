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

/// After a caught fault ODE's world may still be locked; destroying it would raise another. It is kept to the end of the process, in reach,
/// so that leak checkers do not take it for forgotten.
struct AbandonedWorld {
  dWorldID world;
  dSpaceID space;
  std::unique_ptr<Contacts> contacts;
  std::vector<std::unique_ptr<Primitive>> primitives;
};

void abandon(AbandonedWorld world) {
  static std::mutex access;
  static auto* const worlds = new std::vector<AbandonedWorld>;  // never destroyed: that would destroy the worlds
  const std::lock_guard<std::mutex> lock(access);
  worlds->push_back(std::move(world));
}

/// What is destroyed is no longer in the list: its destructor may look itself up there.
template <class Owned>
void destroyAll(std::vector<std::unique_ptr<Owned>>& owned) {
  while (!owned.empty()) {
    const std::unique_ptr<Owned> last = std::move(owned.back());
    owned.pop_back();
  }
}

/// Forgets something that is being destroyed from elsewhere.
template <class Owned>
void release(std::vector<std::unique_ptr<Owned>>& owned, const Owned& which) {
  const auto found = std::ranges::find_if(owned, [&](const auto& one) { return one.get() == &which; });
  if (found == owned.end()) return;
  static_cast<void>(found->release());
  owned.erase(found);
}

double requireStep(double step_s) {
  if (!(step_s >= 1e-7 && step_s <= 10)) throw BadParameter("step", fmt::format("{} s", step_s), "be a number in 1e-7 .. 10 s");
  return step_s;
}

}  // namespace

Simulation::Simulation(SimulationOptions options)
    : parameters_(std::move(options.parameters)),
      physics_(options.physics, parameters_),
      step_s_(requireStep(options.step_s)),
      seed_(options.seed),
      interrupted_(std::move(options.interrupted)) {
  ode_runtime::prepareThread();
  if (options.substeps < 0 || options.substeps > 1000000)
    throw BadParameter("substeps", fmt::format("{}", options.substeps), "be a whole number in 1 .. 1000000, or 0 for automatic");
  substeps_given_ = options.substeps > 0;
  substeps_ = substeps_given_ ? options.substeps : automaticSubsteps(step_s_, physics_, {}, {});
  world_ = dWorldCreate();
  // ODE's own threading is shared by all worlds of the process and not safe where two threads step two worlds.
  threading_ = dThreadingAllocateSelfThreadedImplementation();
  if (!threading_) throw OdeFault("ODE cannot allocate a threading implementation");
  dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_), threading_);
  dWorldSetData(world_, this);
  dWorldSetGravity(world_, 0, -physics_.gravity_mm_per_s2, 0);
  error_reduction_ = physics_.errorReductionPerStep(internalStepS());
  dWorldSetERP(world_, error_reduction_);
  dWorldSetCFM(world_, physics_.constraint_force_mixing);
  // The kind of space decides which of two bodies' several contacts counts. The published program has a hash table, which allocates memory
  // and is slower for robots of this size.
  space_ = options.physics == PhysicsKind::si ? dSimpleSpaceCreate(nullptr) : dHashSpaceCreate(nullptr);
  if (options.plane)
    dCreatePlane(space_, 0, 1, 0, parameters_.number("world.plane_height_mm", -500, "mm", -1e4, 1e4, "height of the ground plane"));
  contacts_ = std::make_unique<Contacts>(world_, space_, physics_.contact_friction_N * physics_.force_per_N);
  if (options.stepper == StepperKind::quick)
    stepper_ = std::make_unique<QuickStepper>(
        world_, parameters_.integer("physics.quick_iteration_count", 20, 1, 100000, "sweeps of dWorldQuickStep per internal step"),
        static_cast<unsigned long>(seed_));
  else if (options.stepper == StepperKind::ode)
    stepper_ = std::make_unique<OdeStepper>(world_);
  else
    stepper_ = std::make_unique<ChainStepper>(*this, *contacts_, bodyBounds(), options.stepper == StepperKind::chain);
  effects_ = std::make_unique<EffectChain>(*this, std::move(options.effects));
  makeCurrent();
}

Simulation::~Simulation() {
  if (current_simulation == this) current_simulation = nullptr;
  controller_.reset();
  effects_.reset();
  robot_.reset();
  if (faulted_) {
    destroyAll(actuators_);
    abandon({world_, space_, std::move(contacts_), std::move(primitives_)});
    return;
  }
  contacts_.reset();
  destroyAll(actuators_);
  destroyAll(primitives_);
  dSpaceDestroy(space_);
  dWorldDestroy(world_);
  dThreadingFreeImplementation(threading_);
}

Simulation& Simulation::of(dWorldID world) {
  auto* simulation = world ? static_cast<Simulation*>(dWorldGetData(world)) : nullptr;
  if (!simulation) throw BadParameter("this world does not belong to a Simulation");
  return *simulation;
}

Simulation& Simulation::current() {
  if (!current_simulation) throw BadParameter("this thread has no current simulation");
  return *current_simulation;
}

void Simulation::makeCurrent() {
  current_simulation = this;
}

Robot& Simulation::robot() {
  if (!robot_) throw BadParameter("this simulation has no robot yet");
  return *robot_;
}

Robot& Simulation::build(const std::string& robot_name) {
  if (robot_) throw BadParameter("this simulation already has a robot");
  return adopt(Robot::make(robot_name, *this));
}

Robot& Simulation::adopt(std::unique_ptr<Robot> robot) {
  if (robot_) throw BadParameter("this simulation already has a robot");
  robot_ = std::move(robot);
  effects_->attach();
  prepareSteps();
  stepper_->prepare();
  return *robot_;
}

/// Sets the length of internal steps by the muscles there are by now, and what depends on it.
void Simulation::prepareSteps() {
  const double before = dWorldGetERP(world_);
  if (!substeps_given_) substeps_ = automaticSubsteps(step_s_, physics_, joints_, actuators_);
  if (before == error_reduction_) dWorldSetERP(world_, physics_.errorReductionPerStep(internalStepS()));
  adaptJoints(internalStepS(), error_reduction_, physics_, joints_, actuators_);
  error_reduction_ = physics_.errorReductionPerStep(internalStepS());
  prepared_actuator_count_ = actuators_.size();
  contacts_->reserve(100 + 20 * actuators_.size());
}

Controller& Simulation::control(std::unique_ptr<Controller> controller) {
  controller_ = std::move(controller);
  return *controller_;
}

Controller* Controller::getActiveController() {
  Controller* controller = Simulation::current().controller();
  if (!controller) throw BadParameter("the current simulation has no controller");
  return controller;
}

void Simulation::start(const std::string& initial_state, const Action& first_command) {
  if (initial_state == "settled") {
    robot().settle(first_command);
    stop();
    // In `original` units the same number of true seconds lasts sqrt(1000) times longer.
    const double slowness = std::sqrt(world_force_per_N / physics_.force_per_N);
    start_time_s_ = internal_time_s_ = -settle_duration_s * slowness;
    step_count_ = 0;
    effects_->begin(start_time_s_);
    robot().step(first_command);
    advance(settle_duration_s * slowness);
    robot().step(first_command);  // forces at the lengths it has settled to
  } else if (initial_state == "built") {
    effects_->settlePressures(first_command);
    effects_->begin(0);
    robot().step(first_command);
  } else {
    throw BadParameter("initial_state", initial_state, "be one of built, settled");
  }
  start_time_s_ = internal_time_s_ = 0;
  step_count_ = 0;
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
  if (prepared_actuator_count_ != actuators_.size()) prepareSteps();
  untilDiverged([&] {
    for (int i = 0; i < substeps_; ++i) internalStep(internalStepS());
    ++step_count_;
    internal_time_s_ = time_s();
    requireWhole();
  });
}

void Simulation::advance(double duration_s) {
  if (!(duration_s > 0 && std::isfinite(duration_s)))
    throw BadParameter("duration", fmt::format("{} s", duration_s), "be positive and finite");
  makeCurrent();
  const double whole_steps = std::round(duration_s / step_s_);
  if (whole_steps >= 1 && std::abs(whole_steps * step_s_ - duration_s) < 1e-9 * std::max(1.0, duration_s)) {
    for (long i = 0; i < static_cast<long>(whole_steps); ++i) step();
    return;
  }
  if (prepared_actuator_count_ != actuators_.size()) prepareSteps();
  const auto count = static_cast<long>(std::max(1.0, std::ceil(duration_s / internalStepS() - 1e-6)));
  const double h_s = duration_s / static_cast<double>(count);
  untilDiverged([&] {
    for (long i = 0; i < count; ++i) internalStep(h_s);
    start_time_s_ += duration_s;
    internal_time_s_ = time_s();
    requireWhole();
  });
}

void Simulation::sense() {
  updateForces(0);
}

void Simulation::updateForces(double h_s) {
  effects_->command(h_s);
  effects_->pressure(h_s);
  effects_->force(h_s);
}

void Simulation::internalStep(double h_s) {
  if (interrupted_ && interrupted_()) throw Interrupted("interrupted within a step");
  // A sample's way: command -> pressure -> force -> body -> sensor. (Readings are taken in Robot::getState.)
  updateForces(h_s);
  for (const auto& actuator : actuators_) {
    if (!std::isfinite(actuator->tensionN()))
      throw Diverged(
          internal_time_s_, actuator->name(),
          fmt::format("its tension is {} N at {} mm and pressure {}", actuator->tensionN(), actuator->lengthMm(), actuator->pressure()));
  }
  stepper_->applyForces(actuators_, h_s);
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
    throw Diverged(internal_time_s_, "the solver", std::string(fault.what()) + advice(internal_time_s_));
  } catch (const BodyOutOfBounds& escaped) {
    throw Diverged(internal_time_s_ + h_s, labelOf(escaped.body()), std::string(escaped.what()) + advice(internal_time_s_));
  }
  solver_message_count_ += messages.count - messages_before;
  internal_time_s_ += h_s;
}

void Simulation::collide(double h_s) {
  if (!physics_.has_contacts) return;
  if (physics_.contact_compliance > 0) {
    const auto stop = PhysicsSettings::stop(physics_.contact_compliance, physics_.contact_time_constant_s, h_s);
    contacts_->soften(stop.error_reduction, stop.softness);
  }
  contacts_->collide(revision_);
}

void Simulation::requireFinite() const {
  if (stepper_->hasCheckedBounds()) return;
  const BodyBounds bounds = bodyBounds();
  auto check = [&](dBodyID body) { bounds.require(body, positionOf(body), fromOde(dBodyGetLinearVel(body))); };
  for (const auto& body : bodies_) check(body->id);
  for (const auto& actuator : actuators_)
    for (const Link& link : actuator->links())
      for (const dBodyID bead : link.bead) check(bead);
}

Vector Simulation::gravityMmPerS2() const {
  dVector3 gravity;
  dWorldGetGravity(world_, gravity);
  return fromOde(gravity);
}

BodyBounds Simulation::bodyBounds() const {
  const double slowness = std::sqrt(world_force_per_N / physics_.force_per_N);
  return {farthest_mm, fastest_m_per_s * mm_per_m / slowness};
}

void Simulation::requireWhole() {
  const std::optional<TornJoint> known = stepper_->largestGap();
  const TornJoint torn = known ? *known : tornMost();
  if (!(torn.gap_mm <= worst_gap_.gap_mm)) worst_gap_ = torn;
  if (!(torn.gap_mm <= torn_mm))
    throw Diverged(internal_time_s_, torn.joint->name(), fmt::format("it is torn by {:.3g} mm{}", torn.gap_mm, advice(internal_time_s_)));
}

TornJoint Simulation::tornMost() const {
  TornJoint largest;
  for (const auto& joint : joints_) {
    const double gap_mm = joint->gapMm();
    if (!(gap_mm <= largest.gap_mm)) largest = {gap_mm, joint.get()};
  }
  return largest;
}

JointGap Simulation::named(const TornJoint& torn) {
  return {torn.gap_mm, torn.joint ? torn.joint->name() : ""};
}

std::string Simulation::labelOf(dBodyID id) const {
  for (const auto& body : bodies_)
    if (body->id == id) return body->parts.empty() ? "body" : body->parts.front()->name();
  for (const auto& actuator : actuators_)
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
  for (const auto& body : bodies_) energy += energyOf(body->id, physics_.gravity_mm_per_s2);
  for (const auto& actuator : actuators_)
    for (const Link& link : actuator->links())
      for (const dBodyID bead : link.bead) energy += energyOf(bead, physics_.gravity_mm_per_s2);
  return energy / (world_force_per_N * mm_per_m);
}

void Simulation::stop() {
  auto halt = [](dBodyID body) {
    dBodySetLinearVel(body, 0, 0, 0);
    dBodySetAngularVel(body, 0, 0, 0);
  };
  for (const auto& body : bodies_) halt(body->id);
  for (const auto& actuator : actuators_)
    for (const Link& link : actuator->links())
      for (const dBodyID bead : link.bead) halt(bead);
}

void Simulation::disown(const Primitive& primitive) {
  ++revision_;
  release(primitives_, primitive);
}

void Simulation::disown(const Actuator& actuator) {
  ++revision_;
  release(actuators_, actuator);
}

Body& Simulation::addBody(dBodyID id, Primitive& part) {
  ++revision_;
  bodies_.push_back(std::make_unique<Body>(Body{id, {&part}, false}));
  return *bodies_.back();
}

void Simulation::removeBody(Body& body) {
  ++revision_;
  dBodyDestroy(body.id);
  std::erase_if(bodies_, [&](const auto& b) { return b.get() == &body; });
}

Joint& Simulation::addJoint(Joint::Kind kind, dJointID id, const std::string& name) {
  ++revision_;
  joints_.push_back(std::make_unique<Joint>(kind, id, name));
  return *joints_.back();
}

}  // namespace musclesim
