#include "step_problem.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "../../robot/actuator_step.h"

namespace musclesim::chain {

namespace {

/// A contact row is soft if its softness is at least this share of its diagonal entry of A.
constexpr double least_softness_ratio = 1e-3;

/// Gyroscopic torque in Lacoursiere's implicit form, as ODE adds it: I (I - h [L]x)^-1 L / h - L / h = L x (I - h [L]x)^-1 L, L = I w.
Vector gyroscopicTorque(const Eigen::Matrix3d& inertia, const Vector& l, double h_s) {
  Eigen::Matrix3d cross;
  cross << 0, -l.z(), l.y(), l.z(), 0, -l.x(), -l.y(), l.x(), 0;
  const Eigen::Matrix3d effective = inertia - h_s * cross;
  return l.cross(effective.inverse() * l);
}

/// Sets the motor explicitly because a step of dWorldStep may have left ODE's motor at a stop.
void setViscousMotor(JointModel& joint, const MuscleSettings& settings) {
  const double dry = joint.kind == Joint::Kind::slider ? settings.slider_friction_N : settings.hinge_friction_Nm;
  joint.limits.motor_force = dry > 0 ? dInfinity : 0;
}

}  // namespace

StepProblem::StepProblem(Model& model) : model_(model) {
  std::vector<int> order(model.chains.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return model.chains[static_cast<std::size_t>(a)].beadCount() < model.chains[static_cast<std::size_t>(b)].beadCount();
  });
  chains_.resize(order.size());
  // The shortest chains go into the incomplete bundle.
  constexpr std::size_t most = Bundle::most_chains;
  for (std::size_t first = 0, end = (order.size() + most - 1) % most + 1; first < order.size(); first = end, end += most) {
    std::vector<int> counts;
    for (std::size_t i = first; i < end; ++i) {
      const auto number = static_cast<std::size_t>(order[i]);
      chains_[number].bundle = static_cast<int>(bundles_.size());
      chains_[number].lane = static_cast<int>(i - first);
      chains_[number].joints.resize(model.chains[number].joints.size());
      counts.push_back(model.chains[number].beadCount());
    }
    bundles_.emplace_back(counts);
  }
  bundle_dirty_.resize(bundles_.size());
  skeleton_.resize(model.skeleton.size());
  fixed_.resize(model.fixed.size());
  bones_.resize(model.bones.size());
  // With fewer chains, eliminating the bones costs less than keeping them.
  constexpr std::size_t chains_per_bone = 2;
  keeps_bones_ = chains_.size() > chains_per_bone * (bones_.size() - fixed_.size());
  layout_.kept.assign(bones_.size(), keeps_bones_ ? 1 : 0);
  for (const JointModel& joint : model.fixed) layout_.kept[static_cast<std::size_t>(joint.body[0])] = 0;
  findLoneBones();
  reserve();
}

/// Finds bones that have one fixation and no other joint.
void StepProblem::findLoneBones() {
  const auto join = [&](const JointModel& joint) {
    for (const int body : joint.body)
      if (body >= 0 && body < model_.boneCount()) bones_[static_cast<std::size_t>(body)].lone = false;
  };
  std::vector<int> fixations(bones_.size());
  for (const JointModel& joint : model_.fixed) {
    const auto bone = static_cast<std::size_t>(joint.body[0]);
    bones_[bone].lone = ++fixations[bone] == 1;
  }
  for (const JointModel& joint : model_.skeleton) join(joint);
  for (const Chain& chain : model_.chains) {
    join(chain.start);
    join(chain.joints.back());
  }
}

/// Allocates memory for as many contacts as a robot is expected to have, so that steps do not allocate.
void StepProblem::reserve() {
  constexpr int contacts_per_chain = 20;
  const int contact_count = 100 + contacts_per_chain * static_cast<int>(chains_.size());
  const auto links = std::accumulate(chains_.begin(), chains_.end(), std::size_t{0},
                                     [](std::size_t sum, const ChainState& chain) { return sum + chain.joints.size(); });
  contacts_.reserve(contact_count);
  rows_.reserve(links + skeleton_.size() + 3 * contact_count);
  places_.reserve(rows_.capacity());
  for (ChainState& chain : chains_) {
    chain.border_rows.reserve(3 + 3 * contacts_per_chain);
    chain.border_contacts.reserve(3 * contacts_per_chain);
  }
  for (Bundle& bundle : bundles_) bundle.reserve(3 + 3 * contacts_per_chain);
  layout_.row_count = 3 * static_cast<int>(chains_.size()) + 6 * static_cast<int>(skeleton_.size()) + contact_count;
  core_.reset(layout_);
}

bool StepProblem::begin(const Conditions& conditions, const std::vector<ContactPoint>& contacts) {
  const bool same_conditions = conditions == conditions_;
  conditions_ = conditions;
  if (!contacts_.make(contacts, model_.bodies, conditions.friction_force, conditions.contact_reduction / conditions.h_s)) return false;
  model_.readBones();
  findRestingBones(same_conditions);
  addLoads();
  makeJointRows();
  setUpBundles();
  setUpBones();
  collectRows();
  arrangeCore();
  std::fill(bundle_dirty_.begin(), bundle_dirty_.end(), char{1});
  return true;
}

namespace {

bool isSame(const BodyMotion& a, const BodyMotion& b) {
  return a.velocity == b.velocity && a.spin == b.spin && a.force == b.force && a.torque == b.torque && a.position == b.position &&
         a.quaternion == b.quaternion;
}

}  // namespace

/// Finds lone bones that nothing touches and that start this step in the same state as the last one: they end it in the same state too.
void StepProblem::findRestingBones(bool same_conditions) {
  for (BoneState& state : bones_) state.touched = false;
  for (const ContactRows& contact : contacts_.all())
    for (const int body : contact.body)
      if (body >= 0 && body < model_.boneCount()) bones_[static_cast<std::size_t>(body)].touched = true;
  for (const JointModel& joint : model_.fixed) {
    BoneState& state = bones_[static_cast<std::size_t>(joint.body[0])];
    const Bone& bone = model_.bones[static_cast<std::size_t>(joint.body[0])];
    const BodyMotion& motion = model_.bodies[joint.body[0]];
    const bool alone = state.lone && !state.touched;
    state.rests = alone && state.was_alone && same_conditions && isSame(motion, state.motion_before) && bone == state.bone_before;
    state.was_alone = alone;
    if (state.rests || !alone) continue;
    state.motion_before = motion;
    state.bone_before = bone;
  }
}

/// Adds gravity. For bones it also computes the inertia in the world frame and adds the gyroscopic torque.
void StepProblem::addLoads() {
  for (int i = 0; i < model_.boneCount(); ++i) {
    BoneState& state = bones_[static_cast<std::size_t>(i)];
    if (state.rests) continue;
    const Bone& bone = model_.bones[static_cast<std::size_t>(i)];
    BodyMotion& motion = model_.bodies[i];
    state.inertia = motion.rotation * bone.inertia * motion.rotation.transpose();
    state.spin_momentum = state.inertia * motion.spin;
    if (bone.gravity) motion.force += bone.mass_g * conditions_.gravity;
    if (bone.gyroscopic) motion.torque += gyroscopicTorque(state.inertia, state.spin_momentum, conditions_.h_s);
  }
  for (const Chain& chain : model_.chains)
    for (int bead = 0; bead < chain.beadCount(); ++bead)
      model_.bodies[chain.first_bead + bead].force += chain.bead_mass_g * conditions_.gravity;
}

void StepProblem::makeJointRows() {
  auto make = [&](JointModel& joint, JointState& state) {
    makeRows(joint, model_.bodies, conditions_.h_s, conditions_.reduction, state.rows);
    if (state.rows.contact != AxisContact::none && state.rows.constant_force != 0)
      addAxisForce(joint, state.rows, state.rows.constant_force);
  };
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    Chain& chain = model_.chains[c];
    const double stop_rad = hingeStopRad(*chain.actuator);
    const MuscleSettings& settings = chain.actuator->settings();
    chain.bead_inertia = chain.sphere_inertia + beadInertiaIncrease(*chain.actuator, conditions_.h_s);
    const double tension = chain.actuator->tensionN() * conditions_.force_per_N;
    for (std::size_t k = 0; k < chain.joints.size(); ++k) {
      JointModel& joint = chain.joints[k];
      if (joint.kind == Joint::Kind::slider) joint.readLimits();
      if (joint.kind == Joint::Kind::hinge) {
        joint.readMotor();
        joint.limits.low_stop = -stop_rad;
        joint.limits.high_stop = stop_rad;
      }
      if (settings.viscous) setViscousMotor(joint, settings);
      make(joint, chains_[c].joints[k]);
      if (joint.kind == Joint::Kind::slider) addAxisForce(joint, chains_[c].joints[k].rows, tension);
    }
    make(chain.start, chains_[c].start);
  }
  for (std::size_t i = 0; i < skeleton_.size(); ++i) {
    model_.skeleton[i].readAxis();
    make(model_.skeleton[i], skeleton_[i]);
  }
  for (std::size_t i = 0; i < fixed_.size(); ++i)
    if (!bones_[static_cast<std::size_t>(model_.fixed[i].body[0])].rests) make(model_.fixed[i], fixed_[i]);
}

/// Adds J5^T force to the loads of the joint's bodies.
void StepProblem::addAxisForce(const JointModel& joint, const JointRows& rows, double force) {
  for (int side = 0; side < 2; ++side) {
    if (joint.body[side] < 0) continue;
    BodyMotion& motion = model_.bodies[joint.body[side]];
    for (int i = 0; i < 3; ++i) {
      motion.force[i] += force * rows.jacobian[side][5][i];
      motion.torque[i] += force * rows.jacobian[side][5][3 + i];
    }
  }
}

void StepProblem::setUpBundles() {
  const double per_h = 1 / conditions_.h_s;
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const Chain& chain = model_.chains[c];
    ChainState& state = chains_[c];
    Bundle& bundle = bundles_[static_cast<std::size_t>(state.bundle)];
    const BeadInertia inertia = {1 / chain.bead_mass_g, 1 / chain.bead_inertia};
    bundle.setInertia(state.lane, inertia);
    for (int k = 0; k < chain.beadCount(); ++k) {
      bundle.setJoint(state.lane, k, state.joints[static_cast<std::size_t>(k)].rows, conditions_.h_s);
      const BodyMotion& motion = model_.bodies[chain.first_bead + k];
      Vector6 a;
      a << per_h * motion.velocity + inertia.per_mass * motion.force, per_h * motion.spin + inertia.per_inertia * motion.torque;
      bundle.setFreeMotion(state.lane, k, a);
    }
    setUpStart(c);
  }
  for (Bundle& bundle : bundles_) bundle.makeBlocks();
}

void StepProblem::setUpStart(std::size_t number) {
  ChainState& state = chains_[number];
  const JointRows& start = state.start.rows;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j)
      state.start_block(i, j) = state.start_block(j, i) =
          throughBead(model_.chains[number].first_bead, start.jacobian[0][i], start.jacobian[0][j]);
    state.start_block(i, i) += start.softness[i] / conditions_.h_s;
  }
}

/// M = diag(m, R I R^T), g = M v/h + f; a fixation (J = 1) adds h/cfm to M and (h/cfm) c/h to g.
void StepProblem::setUpBones() {
  const double per_h = 1 / conditions_.h_s;
  for (int i = 0; i < model_.boneCount(); ++i) {
    BoneState& state = bones_[static_cast<std::size_t>(i)];
    if (state.rests) continue;
    const Bone& bone = model_.bones[static_cast<std::size_t>(i)];
    const BodyMotion& motion = model_.bodies[i];
    const Eigen::Matrix3d& inertia = state.inertia;
    state.mass.topLeftCorner<3, 3>().diagonal().setConstant(bone.mass_g);
    state.mass.bottomRightCorner<3, 3>() = inertia;
    state.momentum << per_h * bone.mass_g * motion.velocity + motion.force, per_h * state.spin_momentum + motion.torque;
    state.per_mass = 1 / bone.mass_g;
    state.per_inertia = 3 / inertia.trace();
  }
  for (std::size_t f = 0; f < fixed_.size(); ++f) {
    BoneState& state = bones_[static_cast<std::size_t>(model_.fixed[f].body[0])];
    if (state.rests) continue;
    const JointRows& rows = fixed_[f].rows;
    for (int row = 0; row < 6; ++row) {
      const double stiffness = conditions_.h_s / rows.softness[row];
      state.mass(row, row) += stiffness;
      state.momentum[row] += stiffness * rows.velocity[row] * per_h;
    }
  }
}

void StepProblem::collectRow(JointState& joint, RowPlace place, double diagonal) {
  const AxisContact contact = joint.rows.contact;
  const bool dry_friction = contact == AxisContact::motor && joint.rows.upper < dInfinity;
  joint.bounded = dry_friction || contact == AxisContact::low_stop || contact == AxisContact::high_stop;
  if (contact != joint.contact_before || !joint.bounded) joint.state = RowState::free;
  joint.contact_before = contact;
  if (!joint.bounded) return;
  BoundedRow row;
  row.lower = joint.rows.lower;
  row.upper = joint.rows.upper;
  row.state = joint.state;
  row.diagonal = diagonal;
  row.group = place.kind == RowKind::chain_joint ? place.owner : static_cast<int>(chains_.size()) + place.owner;
  rows_.push_back(row);
  places_.push_back(place);
}

double StepProblem::diagonalOf(const ContactRows& contact, int row) const {
  double sum = softnessOfContact(row) / conditions_.h_s;
  for (int side = 0; side < 2; ++side) {
    const int body = contact.body[side];
    if (body < 0) continue;
    const auto place = model_.placeOf(body);
    const auto chain = static_cast<std::size_t>(place.chain);
    const double per_mass = place.chain < 0 ? bones_[static_cast<std::size_t>(body)].per_mass : 1 / model_.chains[chain].bead_mass_g;
    const double per_inertia = place.chain < 0 ? bones_[static_cast<std::size_t>(body)].per_inertia : 1 / model_.chains[chain].bead_inertia;
    const double* j = contact.jacobian[side][row];
    for (int i = 0; i < 3; ++i) sum += per_mass * j[i] * j[i] + per_inertia * j[3 + i] * j[3 + i];
  }
  return sum;
}

void StepProblem::arrangeCore() {
  order_.reset(static_cast<int>(chains_.size()));
  if (!keeps_bones_) return;
  for (const ContactRows& contact : contacts_.all()) {
    const int chains[2] = {model_.placeOf(contact.body[0]).chain, model_.placeOf(contact.body[1]).chain};
    if (chains[0] >= 0 && chains[1] >= 0) order_.connect(chains[0], chains[1]);
  }
  order_.arrange();
}

void StepProblem::collectRows() {
  rows_.clear();
  places_.clear();
  for (std::size_t c = 0; c < chains_.size(); ++c)
    for (std::size_t k = 0; k + 1 < chains_[c].joints.size(); ++k)
      collectRow(chains_[c].joints[k], {RowKind::chain_joint, static_cast<int>(c), static_cast<int>(k)},
                 bundles_[static_cast<std::size_t>(chains_[c].bundle)].axisDiagonal(chains_[c].lane, static_cast<int>(k)));
  for (std::size_t i = 0; i < skeleton_.size(); ++i) {
    double diagonal = skeleton_[i].rows.softness[5] / conditions_.h_s;
    for (int side = 0; side < 2; ++side) {
      const int body = model_.skeleton[i].body[side];
      if (body < 0) continue;
      const double* j = skeleton_[i].rows.jacobian[side][5];
      const BoneState& bone = bones_[static_cast<std::size_t>(body)];
      for (int q = 0; q < 3; ++q) diagonal += bone.per_mass * j[q] * j[q] + bone.per_inertia * j[3 + q] * j[3 + q];
    }
    collectRow(skeleton_[i], {RowKind::skeleton_joint, static_cast<int>(i), 0}, diagonal);
  }
  for (std::size_t i = 0; i < contacts_.all().size(); ++i) {
    ContactRows& contact = contacts_.all()[i];
    for (int row = 0; row < contact.row_count; ++row) {
      BoundedRow bounded;
      bounded.lower = contact.lower[row];
      bounded.upper = contact.upper[row];
      bounded.state = contact.state[row];
      bounded.diagonal = diagonalOf(contact, row);
      contact.soft[row] = softnessOfContact(row) / conditions_.h_s > least_softness_ratio * bounded.diagonal;
      bounded.group = static_cast<int>(chains_.size() + skeleton_.size() + i);
      rows_.push_back(bounded);
      places_.push_back({RowKind::contact, static_cast<int>(i), row});
    }
  }
}

void StepProblem::changed(int row) {
  const RowPlace& place = places_[static_cast<std::size_t>(row)];
  auto touch = [&](int chain) { bundle_dirty_[static_cast<std::size_t>(chains_[static_cast<std::size_t>(chain)].bundle)] = 1; };
  if (place.kind == RowKind::chain_joint) return touch(place.owner);
  if (place.kind == RowKind::skeleton_joint) return;
  for (const int body : contacts_.all()[static_cast<std::size_t>(place.owner)].body)
    if (const int chain = model_.placeOf(body).chain; chain >= 0) touch(chain);
}

void StepProblem::end(std::vector<Vector6>& u) {
  takeStates(rows_);
  for (int i = 0; i < model_.boneCount(); ++i) u[static_cast<std::size_t>(i)] = core_.velocity(i);
  for (std::size_t c = 0; c < chains_.size(); ++c)
    for (int k = 0; k < model_.chains[c].beadCount(); ++k)
      u[static_cast<std::size_t>(model_.chains[c].first_bead + k)] =
          bundles_[static_cast<std::size_t>(chains_[c].bundle)].velocity(chains_[c].lane, k);
}

void StepProblem::forget() {
  for (ChainState& chain : chains_)
    for (JointState& joint : chain.joints) joint.contact_before = AxisContact::none;
  for (JointState& joint : skeleton_) joint.contact_before = AxisContact::none;
  for (BoneState& bone : bones_) bone.was_alone = false;
  contacts_.clear();
}

}  // namespace musclesim::chain
