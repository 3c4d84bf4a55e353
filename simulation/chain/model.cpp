#include "model.h"

#include <fmt/format.h>

#include <algorithm>

#include "../../robot/ode_vector.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/world.h"

namespace musclesim::chain {

namespace {

/// Thrown while registering; registerModel() returns its reason.
struct NotTaken {
  std::string reason;
};

void requirePlainBody(dBodyID id, const std::string& name) {
  if (!dBodyIsEnabled(id)) throw NotTaken{name + " is disabled"};
  if (dBodyIsKinematic(id)) throw NotTaken{name + " is kinematic"};
  if (dBodyGetLinearDamping(id) != 0 || dBodyGetAngularDamping(id) != 0) throw NotTaken{name + " has its own damping"};
  if (dBodyGetFiniteRotationMode(id) != 0) throw NotTaken{name + " uses ODE's finite rotation mode"};
  if (dBodyGetAutoDisableFlag(id) != 0) throw NotTaken{name + " may be disabled automatically"};
  if (dBodyGetMaxAngularSpeed(id) < dInfinity) throw NotTaken{name + " has a limit on its angular speed"};
}

/// Requires that all of ODE's joints on the body, except contacts, are registered.
void requireKnownJoints(dBodyID id, const std::string& name, const std::vector<dJointID>& known) {
  for (int i = 0; i < dBodyGetNumJoints(id); ++i) {
    const dJointID joint = dBodyGetJoint(id, i);
    if (dJointGetType(joint) == dJointTypeContact) continue;
    if (!std::binary_search(known.begin(), known.end(), joint))
      throw NotTaken{fmt::format("a joint of {} is of a kind that only dWorldStep can handle (universal, two-axis or limited ball)", name)};
    if (dJointGetFeedback(joint)) throw NotTaken{fmt::format("a joint of {} reports its forces", name)};
  }
}

JointModel registerKnown(const Joint& joint, const BodyState& bodies, std::vector<dJointID>& known) {
  const dJointID id = joint.id();
  if (!dJointGetBody(id, 0)) throw NotTaken{joint.name() + " has the environment as its first body"};
  for (int i = 0; i < 2; ++i)
    if (dJointGetBody(id, i) && bodies.find(dJointGetBody(id, i)) < 0)
      throw NotTaken{joint.name() + " connects a body that is not part of the robot"};
  known.push_back(id);
  return registerJoint(joint, bodies);
}

void registerBodies(const World& world, Model& model) {
  for (const auto& body : world.bodies()) {
    requirePlainBody(body->id, body->parts.empty() ? "a body" : body->parts.front()->name());
    model.bodies.add(body->id);
    model.places.push_back({-1, 0});
  }
  model.bones.resize(model.places.size());
  int chain = -1;  // lines have no beads and do not count
  for (const Actuator* actuator : world.actuators()) {
    if (!actuator->line()) ++chain;
    for (std::size_t link = 0; link < actuator->links().size(); ++link)
      for (int end = 0; end < 2; ++end) {
        const dBodyID bead = actuator->links()[link].bead[end];
        requirePlainBody(bead, "a bead of " + actuator->name());
        model.bodies.add(bead);
        model.places.push_back({chain, static_cast<int>(2 * link) + end});
      }
  }
  model.bodies.sort();
}

/// Reads the mass and moment of inertia that all beads of the chain have in common.
void registerBeads(const Actuator& actuator, Chain& chain) {
  for (const Link& link : actuator.links())
    for (const dBodyID bead : link.bead) {
      dMass mass;
      dBodyGetMass(bead, &mass);
      if (chain.bead_mass_g == 0) {
        chain.bead_mass_g = mass.mass;
        chain.sphere_inertia = mass.I[0];
      }
      const Eigen::Matrix3d sphere = chain.sphere_inertia * Eigen::Matrix3d::Identity();
      if (mass.mass != chain.bead_mass_g || matrixFromOde(mass.I) != sphere)
        throw NotTaken{"the beads of " + actuator.name() + " are not equal spheres"};
      if (!dBodyGetGravityMode(bead)) throw NotTaken{"a bead of " + actuator.name() + " has no weight"};
    }
}

Chain registerChain(const Actuator& actuator, const BodyState& bodies, std::vector<dJointID>& known) {
  if (!actuator.startJoint() || !actuator.endJoint()) throw NotTaken{"an end of " + actuator.name() + " is not connected"};
  Chain chain;
  chain.actuator = &actuator;
  chain.first_bead = bodies.find(actuator.links().front().bead[0]);
  registerBeads(actuator, chain);
  for (std::size_t i = 0; i < actuator.links().size(); ++i) {
    if (i > 0) chain.joints.push_back(registerKnown(*actuator.hinges()[i - 1], bodies, known));
    chain.joints.push_back(registerKnown(*actuator.links()[i].slider, bodies, known));
  }
  chain.joints.push_back(registerKnown(*actuator.endJoint(), bodies, known));
  chain.start = registerKnown(*actuator.startJoint(), bodies, known);
  return chain;
}

/// Registers the joints that belong to no chain.
void registerSkeleton(const World& world, Model& model, std::vector<dJointID>& known) {
  std::vector<dJointID> of_chains = known;
  std::sort(of_chains.begin(), of_chains.end());
  for (const auto& joint : world.joints()) {
    if (std::binary_search(of_chains.begin(), of_chains.end(), joint->id())) continue;
    const Joint::Kind kind = joint->kind();
    if (kind == Joint::Kind::universal || kind == Joint::Kind::hinge2) throw NotTaken{joint->name() + " has two axes"};
    JointModel registered = registerKnown(*joint, model.bodies, known);
    if (kind == Joint::Kind::fixed && registered.body[1] >= 0) throw NotTaken{joint->name() + " fixes two bodies to each other"};
    if (model.placeOf(registered.body[0]).chain >= 0 || model.placeOf(registered.body[1]).chain >= 0)
      throw NotTaken{joint->name() + " is attached to a bead of a chain"};
    (kind == Joint::Kind::fixed ? model.fixed : model.skeleton).push_back(registered);
  }
}

}  // namespace

void Model::readBones() {
  for (int i = 0; i < boneCount(); ++i) {
    Bone& bone = bones[static_cast<std::size_t>(i)];
    const dBodyID id = bodies.id(i);
    dMass mass;
    dBodyGetMass(id, &mass);
    bone.mass_g = mass.mass;
    bone.inertia = matrixFromOde(mass.I);
    bone.gravity = dBodyGetGravityMode(id) != 0;
    bone.gyroscopic = dBodyGetGyroscopicMode(id) != 0;
  }
}

std::string registerModel(const World& world, Model& model) {
  model = Model();
  try {
    registerBodies(world, model);
    std::vector<dJointID> known;
    for (const auto& actuator : world.actuators())
      if (!actuator->line()) model.chains.push_back(registerChain(*actuator, model.bodies, known));
    registerSkeleton(world, model, known);
    std::sort(known.begin(), known.end());
    for (int body = 0; body < model.bodies.count(); ++body) {
      const auto place = model.placeOf(body);
      const std::string name = place.chain < 0 ? world.bodies()[static_cast<std::size_t>(body)]->parts.front()->name()
                                               : "a bead of " + model.chains[static_cast<std::size_t>(place.chain)].actuator->name();
      requireKnownJoints(model.bodies.id(body), name, known);
    }
  } catch (const NotTaken& refusal) {
    return refusal.reason;
  }
  model.readBones();
  return "";
}

}  // namespace musclesim::chain
