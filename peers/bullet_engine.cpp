/// The robot in Bullet, in its usual world of rigid bodies: joints are constraints that a solver meets by sweeps, or exactly (Dantzig).
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "engine.h"
#include "muscle_forces.h"
#include "musclesim/base/error.h"

namespace musclesim::peers {

namespace {

btVector3 toBullet(const Vector& v) {
  return {v.x(), v.y(), v.z()};
}
Vector fromBullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
btMatrix3x3 toBullet(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

/// A solver and its number of sweeps.
struct Method {
  const char* name;
  int sweep_count;
};
constexpr Method methods[] = {{"SequentialImpulse 50", 50},
                              {"SequentialImpulse 10", 10},
                              {"SequentialImpulse 250", 250},
                              {"NNCG 50", 50},
                              {"NNCG 250", 250},
                              {"Dantzig", 0}};

struct Axis {
  const BodyJoint* joint;
  btHingeConstraint* hinge = nullptr;
  btSliderConstraint* slider = nullptr;
};

struct PeerMuscle {
  const Actuator* actuator;
  double length_m;
  std::vector<int> sliders, hinges;                        ///< joints
  std::vector<std::pair<btRigidBody*, btVector3>> points;  ///< in the frame of Bullet's body
};

class BulletPeer final : public Peer {
 public:
  BulletPeer(const Mechanism& mechanism, const PeerSettings& settings)
      : mechanism_(mechanism),
        step_s_(settings.step_s),
        dispatcher_(&configuration_),
        solver_(solverOf(settings.method)),
        world_(&dispatcher_, &broad_phase_, solver_.get(), &configuration_),
        axes_(mechanism.joints.size()) {
    world_.setGravity({0, -mechanism.gravity_m_per_s2, 0});
    for (const Method& method : methods)
      if (settings.method == method.name && method.sweep_count > 0) world_.getSolverInfo().m_numIterations = method.sweep_count;
    environment_ = addBody(0, Vector::Zero(), Eigen::Matrix3d::Identity(), Vector::Zero());
    for (const RigidBody& body : mechanism.bodies) addBody(body);
    for (std::size_t j = 0; j < mechanism.joints.size(); ++j) addJoint(j);
    for (const MuscleParts& muscle : mechanism.muscles) addMuscle(muscle);
  }
  ~BulletPeer() override {
    for (const auto& constraint : constraints_) world_.removeConstraint(constraint.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void advance(const Action& pressure_ratio, int step_count) override {
    for (int i = 0; i < step_count; ++i) {
      for (std::size_t m = 0; m < muscles_.size(); ++m)
        muscles_[m].points.empty() ? pullChain(muscles_[m], pressure_ratio[m]) : pullLine(muscles_[m], pressure_ratio[m]);
      for (const Axis& axis : axes_) damp(axis);
      world_.stepSimulation(step_s_, 0);
    }
    for (const auto& body : bodies_)
      if (!fromBullet(body->getWorldTransform().getOrigin()).allFinite()) throw Error("Bullet: diverged");
  }

  Vector handM() const override {
    return fromBullet(bodyOf(mechanism_.hand.body)->getWorldTransform() * inBullet(mechanism_.hand.body, mechanism_.hand.place_m));
  }

  /// Of all joints: this world holds none of them exactly.
  double gapM() const override {
    double worst = 0;
    for (std::size_t j = 0; j < axes_.size(); ++j) {
      const BodyJoint& joint = mechanism_.joints[j];
      Vector gap = worldOf(joint.first, anchors_[j].first) - worldOf(joint.second, anchors_[j].second);
      if (axes_[j].slider) {
        const Vector along = axisInWorld(axes_[j]);
        gap -= along.dot(gap) * along;
      }
      worst = std::max(worst, gap.norm());
    }
    return worst;
  }

  double coordinate(int joint) const override {
    const Axis& axis = axes_[static_cast<std::size_t>(joint)];
    return axis.hinge ? axis.hinge->getHingeAngle() : axis.slider ? slideM(axis) : 0;
  }

  double energyJ() const override {
    double energy = 0;
    for (const auto& body : bodies_) {
      if (body->getInvMass() == 0) continue;
      const double mass_kg = 1 / body->getInvMass();
      const btVector3 spin = body->getWorldTransform().getBasis().transpose() * body->getAngularVelocity();
      energy += 0.5 * mass_kg * body->getLinearVelocity().length2() + 0.5 * spin.dot(body->getLocalInertia() * spin) +
                mass_kg * mechanism_.gravity_m_per_s2 * body->getWorldTransform().getOrigin().y();
    }
    return energy;
  }

 private:
  static std::unique_ptr<btConstraintSolver> solverOf(const std::string& method) {
    if (method == "Dantzig") {
      static btDantzigSolver dantzig;
      return std::make_unique<btMLCPSolver>(&dantzig);
    }
    if (method.starts_with("NNCG")) return std::make_unique<btNNCGConstraintSolver>();
    return std::make_unique<btSequentialImpulseConstraintSolver>();
  }

  /// Bullet's bodies have the axes of their moments of inertia.
  btRigidBody* addBody(double mass_kg, const Vector& position_m, const Eigen::Matrix3d& rotation, const Vector& inertia_kg_m2) {
    btRigidBody::btRigidBodyConstructionInfo info(mass_kg, nullptr, &nothing_, toBullet(inertia_kg_m2));
    info.m_startWorldTransform = btTransform(toBullet(rotation), toBullet(position_m));
    auto body = std::make_unique<btRigidBody>(info);
    body->setActivationState(DISABLE_DEACTIVATION);
    constexpr int no_group = 0;
    world_.addRigidBody(body.get(), no_group, no_group);
    return bodies_.emplace_back(std::move(body)).get();
  }
  void addBody(const RigidBody& rigid) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(rigid.inertia_kg_m2);
    Eigen::Matrix3d axes = principal.eigenvectors();
    if (axes.determinant() < 0) axes.col(0) *= -1;
    principal_.push_back(axes);
    addBody(rigid.mass_kg, rigid.position_m, rigid.rotation * axes, principal.eigenvalues());
  }

  btRigidBody* bodyOf(int body) const { return body == environment ? environment_ : bodies_[static_cast<std::size_t>(body) + 1].get(); }
  btVector3 inBullet(int body, const Vector& place_m) const {
    return toBullet(body == environment ? place_m : Vector(principal_[static_cast<std::size_t>(body)].transpose() * place_m));
  }
  Vector worldOf(int body, const btVector3& place_m) const { return fromBullet(bodyOf(body)->getWorldTransform() * place_m); }

  /// The constraints' first body is the joint's second one, so that coordinates count as the joint's do.
  void addJoint(std::size_t index) {
    const BodyJoint& joint = mechanism_.joints[index];
    btRigidBody &first = *bodyOf(joint.first), &second = *bodyOf(joint.second);
    const bool slides = joint.kind == Joint::Kind::slider;
    const Eigen::Matrix3d frame = joint.axes.empty() ? Eigen::Matrix3d::Identity() : frameAlong(joint.axes[0].direction, slides ? 0 : 2);
    const btTransform in_world(toBullet(frame), toBullet(joint.anchor_m));
    const btTransform in_first = first.getWorldTransform().inverse() * in_world,
                      in_second = second.getWorldTransform().inverse() * in_world;
    Axis& axis = axes_[index];
    axis.joint = &joint;
    anchors_.emplace_back(in_first.getOrigin(), in_second.getOrigin());
    std::unique_ptr<btTypedConstraint> made;
    if (joint.kind == Joint::Kind::ball) {
      made = std::make_unique<btPoint2PointConstraint>(second, first, in_second.getOrigin(), in_first.getOrigin());
    } else if (joint.kind == Joint::Kind::fixed) {
      made = std::make_unique<btFixedConstraint>(second, first, in_second, in_first);
    } else if (joint.axes.size() != 1) {
      throw Error("Bullet: the model of joint " + joint.source->name() + " is missing");
    } else if (slides) {
      auto slider = std::make_unique<btSliderConstraint>(second, first, in_second, in_first, true);
      const bool stops = std::isfinite(joint.axes[0].low) || std::isfinite(joint.axes[0].high);
      slider->setLowerLinLimit(stops ? finite(joint.axes[0].low) : 1);
      slider->setUpperLinLimit(stops ? finite(joint.axes[0].high) : -1);  // a lower limit above the upper one: none
      slider->setLowerAngLimit(0);
      slider->setUpperAngLimit(0);
      slider->setRestitutionLimLin(0);
      if (joint.axes[0].friction > 0) {
        slider->setPoweredLinMotor(true);
        slider->setTargetLinMotorVelocity(0);
        slider->setMaxLinMotorForce(joint.axes[0].friction);
      }
      axis.slider = slider.get();
      made = std::move(slider);
    } else {
      auto hinge = std::make_unique<btHingeConstraint>(second, first, in_second, in_first, true);
      limit(*hinge, joint.axes[0].low, joint.axes[0].high);
      if (joint.axes[0].friction > 0) hinge->enableAngularMotor(true, 0, joint.axes[0].friction * step_s_);
      axis.hinge = hinge.get();
      made = std::move(hinge);
    }
    world_.addConstraint(made.get());
    constraints_.push_back(std::move(made));
  }

  /// A stop of a slider that has only the other one.
  static double finite(double limit_m) {
    constexpr double out_of_reach_m = 1e3;
    return std::clamp(limit_m, -out_of_reach_m, out_of_reach_m);
  }
  static void limit(btHingeConstraint& hinge, double low_rad, double high_rad) {
    constexpr double softness = 0.9, bias = 0.3, restitution = 0;  // the first two are Bullet's defaults
    constexpr double nearly_half_turn_rad = 3.1;
    if (std::isfinite(low_rad) || std::isfinite(high_rad))
      hinge.setLimit(std::max(low_rad, -nearly_half_turn_rad), std::min(high_rad, nearly_half_turn_rad), softness, bias, restitution);
  }

  void addMuscle(const MuscleParts& parts) {
    for (const auto& pulley : parts.pulleys)
      if (pulley) throw Error("Bullet: the model of pulleys is missing");
    PeerMuscle muscle{parts.actuator, parts.length_m, parts.sliders, parts.hinges, {}};
    Vector before = Vector::Zero();
    for (const BodyPoint& point : parts.points) {
      muscle.points.emplace_back(bodyOf(point.body), inBullet(point.body, point.place_m));
      const Vector here = mechanism_.inWorld(point);
      if (muscle.points.size() > 1) muscle.length_m -= (here - before).norm();
      before = here;
    }
    muscles_.push_back(std::move(muscle));
  }

  Vector axisInWorld(const Axis& axis) const {
    const btVector3 along =
        axis.slider->getRigidBodyA().getWorldTransform().getBasis() * axis.slider->getFrameOffsetA().getBasis().getColumn(0);
    return fromBullet(along);
  }
  double slideM(const Axis& axis) const {
    const auto index = static_cast<std::size_t>(&axis - axes_.data());
    const BodyJoint& joint = *axis.joint;
    return axisInWorld(axis).dot(worldOf(joint.first, anchors_[index].first) - worldOf(joint.second, anchors_[index].second));
  }

  void pullChain(const PeerMuscle& muscle, double pressure_ratio) {
    double length_m = muscle.length_m;
    for (const int slider : muscle.sliders) length_m -= slideM(axes_[static_cast<std::size_t>(slider)]);
    const double tension_N = tensionN(*muscle.actuator, pressure_ratio, length_m);
    for (const int slider : muscle.sliders) {
      const Axis& axis = axes_[static_cast<std::size_t>(slider)];
      const btVector3 force = tension_N * toBullet(axisInWorld(axis));
      bodyOf(axis.joint->first)->applyCentralForce(force);
      bodyOf(axis.joint->second)->applyCentralForce(-force);
    }
    const double stop = hingeStopRad(*muscle.actuator, length_m);
    for (const int index : muscle.hinges) {
      const Axis& axis = axes_[static_cast<std::size_t>(index)];
      limit(*axis.hinge, -stop - axis.joint->coordinate_as_built, stop - axis.joint->coordinate_as_built);
    }
  }

  void pullLine(const PeerMuscle& muscle, double pressure_ratio) {
    double length_m = muscle.length_m, speed_m_per_s = 0;
    std::vector<btVector3> places, directions;
    for (const auto& [body, point] : muscle.points) places.push_back(body->getWorldTransform() * point);
    const auto velocity = [&](std::size_t i) {
      const btRigidBody& body = *muscle.points[i].first;
      return body.getVelocityInLocalPoint(places[i] - body.getWorldTransform().getOrigin());
    };
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const btVector3 along = places[i + 1] - places[i];
      directions.push_back(along.normalized());
      length_m += along.length();
      speed_m_per_s += directions.back().dot(velocity(i + 1) - velocity(i));
    }
    const double force_N = lineForceN(*muscle.actuator, pressure_ratio, length_m, speed_m_per_s);
    const auto pull = [&](std::size_t i, const btVector3& force) {
      btRigidBody& body = *muscle.points[i].first;
      body.applyForce(force, places[i] - body.getWorldTransform().getOrigin());
    };
    for (std::size_t i = 0; i < directions.size(); ++i) {
      pull(i, force_N * directions[i]);
      pull(i + 1, -force_N * directions[i]);
    }
  }

  void damp(const Axis& axis) {
    if (axis.joint->axes.empty() || axis.joint->axes[0].damping == 0) return;
    const double damping = axis.joint->axes[0].damping;
    btRigidBody &first = *bodyOf(axis.joint->first), &second = *bodyOf(axis.joint->second);
    if (axis.hinge) {
      const btVector3 along = second.getWorldTransform().getBasis() * axis.hinge->getAFrame().getBasis().getColumn(2);
      const btVector3 torque = -damping * along.dot(first.getAngularVelocity() - second.getAngularVelocity()) * along;
      first.applyTorque(torque);
      second.applyTorque(-torque);
    } else if (axis.slider) {
      const btVector3 along = toBullet(axisInWorld(axis));
      const btVector3 force = -damping * along.dot(first.getLinearVelocity() - second.getLinearVelocity()) * along;
      first.applyCentralForce(force);
      second.applyCentralForce(-force);
    }
  }

  const Mechanism& mechanism_;
  double step_s_;
  btEmptyShape nothing_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  std::unique_ptr<btConstraintSolver> solver_;
  btDiscreteDynamicsWorld world_;
  btRigidBody* environment_ = nullptr;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;  ///< the environment first
  std::vector<Eigen::Matrix3d> principal_;            ///< axes of inertia in the body's frame
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  std::vector<Axis> axes_;                                ///< one per joint
  std::vector<std::pair<btVector3, btVector3>> anchors_;  ///< on the joint's first and second body
  std::vector<PeerMuscle> muscles_;
};

std::unique_ptr<Peer> make(const Mechanism& mechanism, const Tree&, const PeerSettings& settings) {
  return std::make_unique<BulletPeer>(mechanism, settings);
}

std::string version() {
  return std::to_string(BT_BULLET_VERSION / 100) + "." + std::to_string(BT_BULLET_VERSION % 100);
}

std::vector<std::string> methodNames() {
  std::vector<std::string> names;
  for (const Method& method : methods) names.emplace_back(method.name);
  return names;
}

}  // namespace

}  // namespace musclesim::peers

extern "C" const musclesim::peers::PeerEngine* musclesim_peer_bullet() {
  static const musclesim::peers::PeerEngine engine{"Bullet", musclesim::peers::version(), musclesim::peers::methodNames(),
                                                   musclesim::peers::make};
  return &engine;
}
