/// A world: the bodies, joints and muscles of one simulation, and who owns them.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "musclesim/base/parameters.h"
#include "musclesim/robot/body.h"
#include "musclesim/robot/clock.h"
#include "musclesim/robot/force_element.h"
#include "musclesim/robot/joint.h"
#include "musclesim/robot/muscle_values.h"
#include "musclesim/robot/physics.h"
#include "musclesim/robot/state.h"

namespace musclesim {

class Actuator;
class Primitive;
class RobotEffects;

/// A part that is made with `new`, as in the paper, and belongs to the world in which it is made.
class WorldPart {
 public:
  virtual ~WorldPart() = default;
  WorldPart(const WorldPart&) = delete;
  WorldPart& operator=(const WorldPart&) = delete;

 protected:
  WorldPart() = default;
  /// Number of this part in the world's list of such parts.
  std::size_t worldIndex() const { return world_index_; }

 private:
  friend class World;
  std::size_t world_index_ = 0;
};

struct WorldOptions {
  PhysicsKind physics = PhysicsKind::si;
  bool plane = false;  ///< a ground plane at the height of the parameter "world.plane_height_mm"
  std::uint64_t seed = 1;
  double step_s = 0.01;   ///< control and logging step
  Parameters parameters;  ///< overrides by name
};

/// Robots are built in a world; a Simulation owns it and moves it.
///
/// A World stands for its ODE world wherever one is expected: `new Box(world, world.space(), ...)`. It owns every body, joint, primitive
/// and actuator made in it. Lengths in mm, masses in g, times in s.
class World {
 public:
  /// Throws BadParameter for parameters out of range.
  explicit World(WorldOptions options = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  operator dWorldID() const { return id_; }
  dSpaceID space() const { return space_; }
  Parameters& parameters() { return parameters_; }
  const Parameters& parameters() const { return parameters_; }
  const PhysicsSettings& physics() const { return physics_; }
  /// How composites built from now on get their inertia.
  void setCompositeInertia(CompositeInertia how) { physics_.composite_inertia = how; }
  /// Seed of everything random; each part derives a stream of its own from it.
  std::uint64_t seed() const { return seed_; }

  const std::vector<Primitive*>& primitives() const { return primitives_.parts(); }
  const std::vector<Actuator*>& actuators() const { return actuators_.parts(); }
  const std::vector<std::unique_ptr<Joint>>& joints() const { return joints_; }
  const std::vector<std::unique_ptr<Body>>& bodies() const { return bodies_; }
  const std::vector<std::unique_ptr<ForceElement>>& forceElements() const { return force_elements_; }
  /// Goes up whenever a body, a joint, a shape or a muscle is added or removed.
  long revision() const { return revision_; }

  /// Commands, pressures and tensions, in the order of actuators().
  MuscleValues& values() { return values_; }
  const MuscleValues& values() const { return values_; }
  Clock& clock() { return clock_; }
  const Clock& clock() const { return clock_; }

  /// Sets ODE's error reduction per internal step (ERP) of all joints made from now on; with `only_noted` a value of the user stays in
  /// force.
  void setErrorReduction(double ratio, bool only_noted = false);
  /// What setErrorReduction set last; a user may have given ODE another value since.
  double errorReduction() const { return error_reduction_ratio_; }
  /// Acceleration of a falling body, world units; effects may turn it.
  Vector gravityMmPerS2() const;

  /// The effects of the simulation. Throws BadParameter for a world without a simulation.
  RobotEffects& effects() const;
  void connect(RobotEffects* effects) { effects_ = effects; }

  /// The world to which an ODE world belongs. Throws BadParameter if it belongs to none.
  static World& of(dWorldID id);

  // For the parts themselves.
  /// Takes ownership of a part that has just been made with `new`.
  template <class Part>
  void own(Part* part) {
    ++revision_;
    if constexpr (std::is_same_v<Part, Primitive>) {
      primitives_.add(part);
    } else {
      actuators_.add(part);
      addMuscleValues();
    }
  }
  /// Forgets a part that is being destroyed.
  void disown(const Primitive& primitive);
  void disown(const Actuator& actuator);
  Body& addBody(dBodyID id, Primitive& part);
  void removeBody(Body& body);
  Joint& addJoint(Joint::Kind kind, dJointID id, const std::string& name);
  void addForceElement(std::unique_ptr<ForceElement> element) { force_elements_.push_back(std::move(element)); }
  /// Puts these actuators first, in this order. Throws BadParameter for one that does not belong to this world.
  void putFirst(const std::vector<Actuator*>& first);

  /// Says that a call of ODE was left in the middle. ODE's world may still be locked then, and destroying it would raise another fault; so
  /// it is kept, in reach, until the process ends.
  void markFaulted() { faulted_ = true; }

 private:
  /// Parts of one type, in the order in which they were made; the last one is destroyed first.
  template <class Part>
  class PartList {
   public:
    const std::vector<Part*>& parts() const { return parts_; }
    void add(Part* part) {
      parts_.push_back(part);
      owned_.emplace_back(part);
      number();
    }
    /// Forgets a part without destroying it. Returns its place, or the number of parts if it is not in the list.
    std::size_t release(const Part& part) {
      const auto place = static_cast<std::size_t>(std::ranges::find(parts_, &part) - parts_.begin());
      if (place == parts_.size()) return place;
      static_cast<void>(owned_[place].release());
      owned_.erase(owned_.begin() + static_cast<std::ptrdiff_t>(place));
      parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(place));
      number();
      return place;
    }
    /// Moves a part to an earlier place; those in between move up.
    void moveTo(std::size_t to, std::size_t from) {
      const auto rotate = [&](auto& list) {
        std::rotate(list.begin() + static_cast<std::ptrdiff_t>(to), list.begin() + static_cast<std::ptrdiff_t>(from),
                    list.begin() + static_cast<std::ptrdiff_t>(from) + 1);
      };
      rotate(parts_);
      rotate(owned_);
      number();
    }
    /// A part that is being destroyed is no longer in the list: its destructor looks itself up there.
    void destroyAll() {
      while (!owned_.empty()) {
        const std::unique_ptr<WorldPart> last = std::move(owned_.back());
        owned_.pop_back();
        parts_.pop_back();
      }
    }
    std::vector<std::unique_ptr<WorldPart>> takeOwned() { return std::move(owned_); }

   private:
    void number() {
      for (std::size_t i = 0; i < owned_.size(); ++i) owned_[i]->world_index_ = i;
    }

    std::vector<Part*> parts_;
    std::vector<std::unique_ptr<WorldPart>> owned_;
  };
  void addMuscleValues();

  Parameters parameters_;
  PhysicsSettings physics_;
  std::uint64_t seed_;
  Clock clock_;
  long revision_ = 0;
  double error_reduction_ratio_ = 0;
  bool faulted_ = false;
  dWorldID id_ = nullptr;
  dThreadingImplementationID threading_ = nullptr;  ///< the world's own
  dSpaceID space_ = nullptr;
  std::vector<std::unique_ptr<Body>> bodies_;
  std::vector<std::unique_ptr<Joint>> joints_;
  std::vector<std::unique_ptr<ForceElement>> force_elements_;
  PartList<Primitive> primitives_;
  PartList<Actuator> actuators_;
  MuscleValues values_;
  RobotEffects* effects_ = nullptr;
};

}  // namespace musclesim
