/// The robot in Simbody.
#include <Simbody.h>

#include <cmath>

#include "engine.h"
#include "muscle_forces.h"
#include "musclesim/base/error.h"

namespace musclesim::peers {

namespace {

using SimTK::MobilizedBody;
using SimTK::Real;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

// Simbody has neither dry friction nor stops of joints that rest, only forces. These are as steep as a step of 0.05 ms still holds.
constexpr double dry_speed_m_per_s = 0.05, dry_speed_rad_per_s = 2;  ///< at this speed dry friction has 76 % of its full force
struct Stop {
  double stiffness, damping;
};
constexpr Stop slider_stop = {1e6, 40};       ///< N/m, N s/m
constexpr Stop link_hinge_stop = {33, 2e-3};  ///< N m/rad, N m s/rad: the stiffness is musclesim's
constexpr Stop bone_hinge_stop = {5e3, 2};

Vec3 toSimbody(const Vector& v) {
  return {v.x(), v.y(), v.z()};
}
Vector fromSimbody(const Vec3& v) {
  return {v[0], v[1], v[2]};
}
SimTK::Rotation toSimbody(const Eigen::Matrix3d& m) {
  return SimTK::Rotation(SimTK::Mat33(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)), true);
}

/// A joint with one coordinate, its friction and its stops.
struct Axis {
  MobilizedBody body;
  JointAxis axis;
  double dry_speed;
  Stop stop;
  double as_built;             ///< its coordinate in the pose that was read
  bool between_links = false;  ///< a hinge whose stops move
};

struct PeerMuscle {
  const Actuator* actuator;
  double length_m;
  std::vector<int> sliders, hinges;  ///< entries of the list of axes
  std::vector<std::pair<MobilizedBody, Vec3>> points;
};

/// Muscles, friction and stops.
class RobotForces final : public SimTK::Force::Custom::Implementation {
 public:
  std::vector<Axis> axes;
  std::vector<PeerMuscle> muscles;
  Action pressure_ratio;

  void calcForce(const State& state, SimTK::Vector_<SpatialVec>& body_forces, SimTK::Vector_<Vec3>&,
                 SimTK::Vector& mobility_forces) const override {
    for (std::size_t m = 0; m < muscles.size(); ++m)
      muscles[m].points.empty() ? pullChain(state, m, mobility_forces) : pullLine(state, m, body_forces);
    for (const Axis& axis : axes)
      if (!axis.between_links) resist(state, axis, axis.axis.low, axis.axis.high, mobility_forces);
  }
  Real calcPotentialEnergy(const State&) const override { return 0; }

 private:
  static void resist(const State& state, const Axis& axis, double low, double high, SimTK::Vector& mobility_forces) {
    const double q = axis.body.getOneQ(state, 0), u = axis.body.getOneU(state, 0);
    double force = -axis.axis.friction * std::tanh(u / axis.dry_speed) - axis.axis.damping * u;
    if (q < low) force += std::max(0.0, axis.stop.stiffness * (low - q) - axis.stop.damping * u);
    if (q > high) force += std::min(0.0, axis.stop.stiffness * (high - q) - axis.stop.damping * u);
    axis.body.applyOneMobilityForce(state, 0, force, mobility_forces);
  }

  void pullChain(const State& state, std::size_t m, SimTK::Vector& mobility_forces) const {
    const PeerMuscle& muscle = muscles[m];
    double length_m = muscle.length_m;
    for (const int slider : muscle.sliders) length_m -= axes[static_cast<std::size_t>(slider)].body.getOneQ(state, 0);
    const double tension_N = tensionN(*muscle.actuator, pressure_ratio[m], length_m);
    for (const int slider : muscle.sliders)
      axes[static_cast<std::size_t>(slider)].body.applyOneMobilityForce(state, 0, tension_N, mobility_forces);
    const double stop = hingeStopRad(*muscle.actuator, length_m);
    for (const int index : muscle.hinges) {
      const Axis& hinge = axes[static_cast<std::size_t>(index)];
      resist(state, hinge, -stop - hinge.as_built, stop - hinge.as_built, mobility_forces);
    }
  }

  void pullLine(const State& state, std::size_t m, SimTK::Vector_<SpatialVec>& body_forces) const {
    const PeerMuscle& muscle = muscles[m];
    double length_m = muscle.length_m, speed_m_per_s = 0;
    std::vector<Vec3> directions;
    for (std::size_t i = 0; i + 1 < muscle.points.size(); ++i) {
      const auto& [from, start] = muscle.points[i];
      const auto& [to, end] = muscle.points[i + 1];
      const Vec3 along = to.findStationLocationInGround(state, end) - from.findStationLocationInGround(state, start);
      const double distance_m = along.norm();
      directions.push_back(along / distance_m);
      length_m += distance_m;
      speed_m_per_s +=
          SimTK::dot(directions.back(), to.findStationVelocityInGround(state, end) - from.findStationVelocityInGround(state, start));
    }
    const double force_N = lineForceN(*muscle.actuator, pressure_ratio[m], length_m, speed_m_per_s);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      muscle.points[i].first.applyForceToBodyPoint(state, muscle.points[i].second, force_N * directions[i], body_forces);
      muscle.points[i + 1].first.applyForceToBodyPoint(state, muscle.points[i + 1].second, -force_N * directions[i], body_forces);
    }
  }
};

std::unique_ptr<SimTK::Integrator> integratorOf(const SimTK::System& system, const std::string& method, double step_s) {
  std::unique_ptr<SimTK::Integrator> integrator;
  if (method == "Verlet")
    integrator = std::make_unique<SimTK::VerletIntegrator>(system);
  else if (method == "RungeKutta3")
    integrator = std::make_unique<SimTK::RungeKutta3Integrator>(system);
  else if (method == "RungeKuttaMerson")
    integrator = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system);
  else
    return std::make_unique<SimTK::SemiExplicitEulerIntegrator>(system, step_s);
  integrator->setFixedStepSize(step_s);
  return integrator;
}

class SimbodyPeer final : public Peer {
 public:
  SimbodyPeer(const Mechanism& mechanism, const Tree& tree, const PeerSettings& settings)
      : mechanism_(mechanism),
        tree_(tree),
        step_s_(settings.step_s),
        matter_(system_),
        forces_(system_),
        gravity_(forces_, matter_, Vec3(0, -mechanism.gravity_m_per_s2, 0)),
        robot_forces_(new RobotForces),
        custom_(forces_, robot_forces_),
        bodies_(mechanism.bodies.size()),
        axis_of_joint_(mechanism.joints.size(), -1) {
    for (const TreeNode& node : tree.nodes) addBody(node);
    for (const int loop : tree.loops) {
      const BodyJoint& joint = mechanism.joints[static_cast<std::size_t>(loop)];
      SimTK::Constraint::Ball(bodyOf(joint.first), station(joint.first, joint.anchor_m), bodyOf(joint.second),
                              station(joint.second, joint.anchor_m));
    }
    for (const MuscleParts& muscle : mechanism.muscles) addMuscle(muscle);
    robot_forces_->pressure_ratio.assign(mechanism.muscles.size(), 0.0);
    forces_.setNumberOfThreads(1);
    const State state = system_.realizeTopology();
    integrator_ = integratorOf(system_, settings.method, settings.step_s);
    integrator_->setAllowInterpolation(false);
    integrator_->initialize(state);
  }

  void advance(const Action& pressure_ratio, int step_count) override {
    step_count_ += step_count;
    try {
      if (robot_forces_->pressure_ratio != pressure_ratio) {
        robot_forces_->pressure_ratio = pressure_ratio;
        integrator_->reinitialize(SimTK::Stage::Velocity, false);  // the accelerations that it keeps are old
      }
      integrator_->stepTo(static_cast<double>(step_count_) * step_s_);
    } catch (const std::exception& error) {
      throw Error(std::string("Simbody: ") + error.what());
    }
    if (!std::isfinite(integrator_->getState().getQ().norm())) throw Error("Simbody: diverged");
  }

  Vector handM() const override {
    system_.realize(integrator_->getState(), SimTK::Stage::Position);
    const BodyPoint& hand = mechanism_.hand;
    return fromSimbody(bodyOf(hand.body).findStationLocationInGround(integrator_->getState(), toSimbody(hand.place_m)));
  }

  double gapM() const override {
    const State& state = integrator_->getState();
    system_.realize(state, SimTK::Stage::Position);
    double worst = 0;
    for (const int loop : tree_.loops) {
      const BodyJoint& joint = mechanism_.joints[static_cast<std::size_t>(loop)];
      const Vec3 gap = bodyOf(joint.first).findStationLocationInGround(state, station(joint.first, joint.anchor_m)) -
                       bodyOf(joint.second).findStationLocationInGround(state, station(joint.second, joint.anchor_m));
      worst = std::max(worst, gap.norm());
    }
    return worst;
  }

  double coordinate(int joint) const override {
    const int axis = axis_of_joint_[static_cast<std::size_t>(joint)];
    return axis < 0 ? 0 : robot_forces_->axes[static_cast<std::size_t>(axis)].body.getOneQ(integrator_->getState(), 0);
  }

  double energyJ() const override {
    system_.realize(integrator_->getState(), SimTK::Stage::Dynamics);
    return system_.calcEnergy(integrator_->getState());
  }

 private:
  MobilizedBody bodyOf(int body) const { return body == environment ? matter_.getGround() : bodies_[static_cast<std::size_t>(body)]; }
  MobilizedBody& bodyOf(int body) {
    return body == environment ? static_cast<MobilizedBody&>(matter_.updGround()) : bodies_[static_cast<std::size_t>(body)];
  }

  SimTK::Transform poseOf(int body) const {
    if (body == environment) return {};
    const RigidBody& rigid = mechanism_.bodies[static_cast<std::size_t>(body)];
    return {toSimbody(rigid.rotation.toRotationMatrix()), toSimbody(rigid.position_m)};
  }
  Vec3 station(int body, const Vector& point_m) const { return ~poseOf(body) * toSimbody(point_m); }

  void addBody(const TreeNode& node) {
    const RigidBody& rigid = mechanism_.bodies[static_cast<std::size_t>(node.body)];
    const Eigen::Matrix3d& I = rigid.inertia_kg_m2;
    const SimTK::Body::Rigid body(
        SimTK::MassProperties(rigid.mass_kg, Vec3(0), SimTK::Inertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2))));
    MobilizedBody& parent = bodyOf(node.parent);
    const bool free = node.joint < 0;
    const BodyJoint joint = free ? BodyJoint{.kind = Joint::Kind::ball, .first = 0, .second = 0, .anchor_m = rigid.position_m, .axes = {}}
                                 : mechanism_.joints[static_cast<std::size_t>(node.joint)];
    Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
    const bool slides = joint.kind == Joint::Kind::slider;
    if (!joint.axes.empty()) frame = frameAlong(node.reversed ? Vector(-joint.axes[0].direction) : joint.axes[0].direction, slides ? 0 : 2);
    const SimTK::Transform in_world(toSimbody(frame), toSimbody(joint.anchor_m));
    const SimTK::Transform in_parent = ~poseOf(node.parent) * in_world, in_body = ~poseOf(node.body) * in_world;
    MobilizedBody& made = bodies_[static_cast<std::size_t>(node.body)];
    if (free)
      made = MobilizedBody::Free(parent, in_parent, body, in_body);
    else if (joint.kind == Joint::Kind::ball)
      made = MobilizedBody::Ball(parent, in_parent, body, in_body);
    else if (joint.kind == Joint::Kind::fixed)
      made = MobilizedBody::Weld(parent, in_parent, body, in_body);
    else if (joint.axes.size() != 1)
      throw Error("Simbody: the model of joint " + joint.source->name() + " is missing");
    else if (slides)
      made = MobilizedBody::Slider(parent, in_parent, body, in_body);
    else
      made = MobilizedBody::Pin(parent, in_parent, body, in_body);
    if (joint.axes.empty()) return;
    axis_of_joint_[static_cast<std::size_t>(node.joint)] = static_cast<int>(robot_forces_->axes.size());
    robot_forces_->axes.push_back({made, joint.axes[0], slides ? dry_speed_m_per_s : dry_speed_rad_per_s,
                                   slides ? slider_stop : bone_hinge_stop, joint.coordinate_as_built});
  }

  void addMuscle(const MuscleParts& parts) {
    PeerMuscle muscle{parts.actuator, parts.length_m, {}, {}, {}};
    const auto axisOf = [this](int joint) { return axis_of_joint_[static_cast<std::size_t>(joint)]; };
    for (const int slider : parts.sliders) muscle.sliders.push_back(axisOf(slider));
    for (const int hinge : parts.hinges) {
      muscle.hinges.push_back(axisOf(hinge));
      Axis& axis = robot_forces_->axes[static_cast<std::size_t>(muscle.hinges.back())];
      axis.stop = link_hinge_stop;
      axis.between_links = true;
    }
    for (const auto& pulley : parts.pulleys)
      if (pulley) throw Error("Simbody: the model of pulleys is missing");
    Vector before = Vector::Zero();
    for (const BodyPoint& point : parts.points) {
      muscle.points.emplace_back(bodyOf(point.body), toSimbody(point.place_m));
      const Vector here = mechanism_.inWorld(point);
      if (muscle.points.size() > 1) muscle.length_m -= (here - before).norm();
      before = here;
    }
    robot_forces_->muscles.push_back(std::move(muscle));
  }

  const Mechanism& mechanism_;
  const Tree& tree_;
  double step_s_;
  long step_count_ = 0;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::Force::UniformGravity gravity_;
  RobotForces* robot_forces_;  ///< belongs to custom_
  SimTK::Force::Custom custom_;
  std::vector<MobilizedBody> bodies_;
  std::vector<int> axis_of_joint_;
  std::unique_ptr<SimTK::Integrator> integrator_;
};

std::unique_ptr<Peer> make(const Mechanism& mechanism, const Tree& tree, const PeerSettings& settings) {
  try {
    return std::make_unique<SimbodyPeer>(mechanism, tree, settings);
  } catch (const SimTK::Exception::Base& error) {
    throw Error(std::string("Simbody refuses the model: ") + error.what());
  }
}

std::string version() {
  int major = 0, minor = 0, build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  return std::to_string(major) + "." + std::to_string(minor);
}

}  // namespace

}  // namespace musclesim::peers

extern "C" const musclesim::peers::PeerEngine* musclesim_peer_simbody() {
  static const musclesim::peers::PeerEngine engine{
      "Simbody", musclesim::peers::version(), {"SemiExplicitEuler", "Verlet", "RungeKutta3", "RungeKuttaMerson"}, musclesim::peers::make};
  return &engine;
}
