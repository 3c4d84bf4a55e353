#include "musclesim/robot/world.h"

#include <mutex>

#include "../base/ode_runtime.h"
#include "musclesim/base/error.h"
#include "ode_vector.h"

namespace musclesim {

namespace {

struct AbandonedWorld {
  dWorldID world;
  dSpaceID space;
  std::vector<std::unique_ptr<WorldPart>> primitives;
};

void abandon(AbandonedWorld world) {
  static std::mutex access;
  static auto* const worlds = new std::vector<AbandonedWorld>;  // never destroyed: that would destroy the worlds
  const std::lock_guard<std::mutex> lock(access);
  worlds->push_back(std::move(world));
}

/// Calls change(column) for every column of the values.
template <class Function>
void forEachColumn(MuscleValues& values, const Function& change) {
  for (auto* column : {&values.command_ratio, &values.pressure_ratio, &values.tension_N}) change(*column);
}

}  // namespace

World::World(WorldOptions options)
    : parameters_(std::move(options.parameters)), physics_(options.physics, parameters_), seed_(options.seed), clock_(options.step_s) {
  ode_runtime::prepareThread();
  id_ = dWorldCreate();
  // ODE's own threading is shared by all worlds of the process and not safe where two threads step two worlds.
  threading_ = dThreadingAllocateSelfThreadedImplementation();
  if (!threading_) throw OdeFault("ODE cannot allocate a threading implementation");
  dWorldSetStepThreadingImplementation(id_, dThreadingImplementationGetFunctions(threading_), threading_);
  dWorldSetData(id_, this);
  dWorldSetGravity(id_, 0, -physics_.gravity_mm_per_s2, 0);
  dWorldSetCFM(id_, physics_.constraint_force_mixing);
  // The kind of space decides which of two bodies' several contacts counts. The published program has a hash table, which allocates memory
  // and is slower for robots of this size.
  space_ = options.physics == PhysicsKind::si ? dSimpleSpaceCreate(nullptr) : dHashSpaceCreate(nullptr);
  if (options.plane)
    dCreatePlane(space_, 0, 1, 0, parameters_.number("world.plane_height_mm", -500, "mm", -1e4, 1e4, "height of the ground plane"));
}

World::~World() {
  actuators_.destroyAll();
  if (faulted_) {
    abandon({id_, space_, primitives_.takeOwned()});
    return;
  }
  primitives_.destroyAll();
  dSpaceDestroy(space_);
  dWorldDestroy(id_);
  dThreadingFreeImplementation(threading_);
}

World& World::of(dWorldID id) {
  auto* world = id ? static_cast<World*>(dWorldGetData(id)) : nullptr;
  if (!world) throw BadParameter("this ODE world does not belong to a World of musclesim");
  return *world;
}

RobotEffects& World::effects() const {
  if (!effects_) throw BadParameter("this world does not belong to a simulation");
  return *effects_;
}

void World::setErrorReduction(double ratio, bool only_noted) {
  error_reduction_ratio_ = ratio;
  if (!only_noted) dWorldSetERP(id_, ratio);
}

Vector World::gravityMmPerS2() const {
  dVector3 gravity;
  dWorldGetGravity(id_, gravity);
  return fromOde(gravity);
}

void World::addMuscleValues() {
  forEachColumn(values_, [](std::vector<double>& column) { column.push_back(0); });
}

void World::disown(const Primitive& primitive) {
  ++revision_;
  primitives_.release(primitive);
}

void World::disown(const Actuator& actuator) {
  ++revision_;
  const std::size_t place = actuators_.release(actuator);
  forEachColumn(values_, [&](std::vector<double>& column) {
    if (place < column.size()) column.erase(column.begin() + static_cast<std::ptrdiff_t>(place));
  });
}

Body& World::addBody(dBodyID id, Primitive& part) {
  ++revision_;
  bodies_.push_back(std::make_unique<Body>(Body{id, {&part}, false}));
  return *bodies_.back();
}

void World::removeBody(Body& body) {
  ++revision_;
  dBodyDestroy(body.id);
  std::erase_if(bodies_, [&](const auto& b) { return b.get() == &body; });
}

Joint& World::addJoint(Joint::Kind kind, dJointID id, const std::string& name) {
  ++revision_;
  joints_.push_back(std::make_unique<Joint>(kind, id, name));
  return *joints_.back();
}

void World::putFirst(const std::vector<Actuator*>& first) {
  for (std::size_t to = 0; to < first.size(); ++to) {
    const auto found = std::ranges::find(actuators(), first[to]);
    if (found == actuators().end()) throw BadParameter("a muscle of the robot belongs to another world than the robot");
    const auto from = static_cast<std::size_t>(found - actuators().begin());
    actuators_.moveTo(to, from);
    forEachColumn(values_, [&](std::vector<double>& column) {
      std::rotate(column.begin() + static_cast<std::ptrdiff_t>(to), column.begin() + static_cast<std::ptrdiff_t>(from),
                  column.begin() + static_cast<std::ptrdiff_t>(from) + 1);
    });
  }
}

}  // namespace musclesim
