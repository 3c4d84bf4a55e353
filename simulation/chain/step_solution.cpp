/// The linear solve of StepProblem for given states of the bounded rows.
#include <algorithm>
#include <cmath>

#include "step_problem.h"

namespace musclesim::chain {

void StepProblem::solve(std::vector<BoundedRow>& rows) {
  takeStates(rows);
  setUpBorders();
  eliminateChains();
  assembleCore();
  core_.solve();
  substitute();
  giveForces(rows);
}

void StepProblem::takeStates(const std::vector<BoundedRow>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RowPlace& place = places_[i];
    const auto owner = static_cast<std::size_t>(place.owner);
    if (place.kind == RowKind::contact) {
      contacts_.all()[owner].state[place.part] = rows[i].state;
      continue;
    }
    JointState& joint = place.kind == RowKind::chain_joint ? chains_[owner].joints[static_cast<std::size_t>(place.part)] : skeleton_[owner];
    joint.state = rows[i].state;
    joint.force = rows[i].state == RowState::free ? 0 : rows[i].bound();
  }
}

namespace {

bool haveBodyInCommon(const ContactRows& a, const ContactRows& b) {
  return a.body[0] == b.body[0] || a.body[0] == b.body[1] || a.body[1] == b.body[0] || a.body[1] == b.body[1];
}

double givenForce(const ContactRows& contact, int row) {
  return contact.state[row] == RowState::at_lower ? contact.lower[row] : contact.upper[row];
}

}  // namespace

/// Numbers the core's rows: start balls, skeleton, free contact rows; gives the chains their border rows and the forces of rows at bounds.
void StepProblem::setUpBorders() {
  core_row_count_ = 0;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    pairs_[p].clearBorder();
    if (pair_dirty_[p]) pairs_[p].clearBeadForces();
  }
  for (ChainState& chain : chains_) {
    ChainPair& pair = pairs_[static_cast<std::size_t>(chain.pair)];
    chain.border_rows.clear();
    for (int row = 0; row < 3; ++row) {
      pair.addBorder(chain.lane, row, 0, chain.start.rows.jacobian[0][row]);
      chain.border_rows.push_back(core_row_count_++);
    }
    if (!pair_dirty_[static_cast<std::size_t>(chain.pair)]) continue;
    for (std::size_t k = 0; k + 1 < chain.joints.size(); ++k) {
      const JointState& joint = chain.joints[k];
      if (joint.axisFree())
        pair.setFree(chain.lane, static_cast<int>(k));
      else
        pair.setForce(chain.lane, static_cast<int>(k), joint.bounded ? joint.force : 0);
    }
  }
  for (JointState& joint : skeleton_) {
    joint.core_row = core_row_count_;
    core_row_count_ += joint.axisFree() ? 6 : std::min(joint.rows.row_count, 5);
  }
  for (ContactRows& contact : contacts_.all())
    for (int row = 0; row < contact.row_count; ++row) setUpContactBorder(contact, row);
}

void StepProblem::setUpContactBorder(ContactRows& contact, int row) {
  const bool free = contact.state[row] == RowState::free;
  contact.core_row[row] = free ? core_row_count_++ : -1;
  int column_of_first = -1;
  for (int side = 0; side < 2; ++side) {
    const auto place = model_.placeOf(contact.body[side]);
    if (place.chain < 0) continue;
    ChainState& chain = chains_[static_cast<std::size_t>(place.chain)];
    ChainPair& pair = pairs_[static_cast<std::size_t>(chain.pair)];
    if (!free) {
      if (pair_dirty_[static_cast<std::size_t>(chain.pair)])
        pair.addBeadForce(chain.lane, place.bead, contact.jacobian[side][row], givenForce(contact, row));
      continue;
    }
    const bool within_chain = side == 1 && place.chain == model_.placeOf(contact.body[0]).chain;
    const int column = within_chain ? column_of_first : static_cast<int>(chain.border_rows.size());
    if (!within_chain) chain.border_rows.push_back(contact.core_row[row]);
    column_of_first = column;
    pair.addBorder(chain.lane, column, place.bead, contact.jacobian[side][row]);
  }
}

void StepProblem::eliminateChains() {
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    if (!pair_dirty_[p]) continue;
    pairs_[p].eliminate();
    pair_dirty_[p] = 0;
  }
}

void StepProblem::assembleCore() {
  core_.reset(model_.boneCount(), core_row_count_);
  addBones();
  for (std::size_t c = 0; c < chains_.size(); ++c) addChain(c);
  addSkeleton();
  for (std::size_t i = 0; i < contacts_.all().size(); ++i)
    for (int row = 0; row < contacts_.all()[i].row_count; ++row) addContact(i, row);
}

/// Own mass and momentum, and the forces of rows at a bound.
void StepProblem::addBones() {
  for (int i = 0; i < model_.boneCount(); ++i) {
    const BoneState& bone = bones_[static_cast<std::size_t>(i)];
    core_.addBone(i, bone.mass, bone.momentum);
  }
  auto push = [&](int body, const double jacobian[6], double force) {
    if (body >= 0 && model_.placeOf(body).chain < 0) core_.addMomentum(body, force * Eigen::Map<const Vector6>(jacobian));
  };
  for (std::size_t i = 0; i < skeleton_.size(); ++i)
    for (int side = 0; side < 2; ++side)
      if (skeleton_[i].bounded) push(model_.skeleton[i].body[side], skeleton_[i].rows.jacobian[side][5], skeleton_[i].force);
  for (const ContactRows& contact : contacts_.all())
    for (int row = 0; row < contact.row_count; ++row)
      for (int side = 0; side < 2; ++side)
        if (contact.core_row[row] < 0) push(contact.body[side], contact.jacobian[side][row], givenForce(contact, row));
}

void StepProblem::addChain(std::size_t number) {
  const ChainState& state = chains_[number];
  const Chain& chain = model_.chains[number];
  const ChainPair& pair = pairs_[static_cast<std::size_t>(state.pair)];
  const int lane = state.lane, first_row = state.border_rows[0];
  const double per_h = 1 / conditions_.h_s;
  const Vector6 motion = pair.motion(lane, 0);
  const JointRows& start = state.start.rows;
  for (int row = 0; row < 3; ++row) {
    for (int other = 0; other <= row; ++other)
      core_.addBlock(first_row + row, first_row + other, throughBead(chain.first_bead, start.jacobian[0][row], start.jacobian[0][other]));
    core_.addBlock(first_row + row, first_row + row, start.softness[row] * per_h);
    core_.addRight(first_row + row, start.velocity[row] * per_h - Eigen::Map<const Vector6>(start.jacobian[0][row]).dot(motion));
    core_.couple(first_row + row, chain.start.body[1], start.jacobian[1][row]);
  }
  const int end_bone = chain.joints.back().body[1];
  for (int i = 0; i < static_cast<int>(state.border_rows.size()); ++i) {
    const int row = state.border_rows[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j) core_.addBlock(row, state.border_rows[static_cast<std::size_t>(j)], -pair.borderBlock(lane, i, j));
    core_.addRight(row, -pair.borderRight(lane, i));
    if (end_bone >= 0) core_.couple(row, end_bone, pair.boneCoupling(lane, i).data());
  }
  if (end_bone >= 0) core_.addBone(end_bone, pair.boneMass(lane), pair.boneMomentum(lane));
}

void StepProblem::addSkeleton() {
  const double per_h = 1 / conditions_.h_s;
  for (std::size_t i = 0; i < skeleton_.size(); ++i) {
    const JointState& joint = skeleton_[i];
    const int count = joint.axisFree() ? 6 : std::min(joint.rows.row_count, 5);
    for (int row = 0; row < count; ++row) {
      const int core_row = joint.core_row + row;
      core_.addBlock(core_row, core_row, joint.rows.softness[row] * per_h);
      core_.addRight(core_row, joint.rows.velocity[row] * per_h);
      for (int side = 0; side < 2; ++side) core_.couple(core_row, model_.skeleton[i].body[side], joint.rows.jacobian[side][row]);
    }
  }
}

/// J1 S J2^T of two rows on one bead.
double StepProblem::throughBead(int body, const double first[6], const double second[6]) const {
  const Chain& chain = model_.chains[static_cast<std::size_t>(model_.placeOf(body).chain)];
  double linear = 0, angular = 0;
  for (int i = 0; i < 3; ++i) {
    linear += first[i] * second[i];
    angular += first[3 + i] * second[3 + i];
  }
  return linear / chain.bead_mass_g + angular / chain.bead_inertia;
}

void StepProblem::addContact(std::size_t number, int row) {
  const ContactRows& contact = contacts_.all()[number];
  const int core_row = contact.core_row[row];
  if (core_row < 0) return;
  const double per_h = 1 / conditions_.h_s;
  core_.addBlock(core_row, core_row, softnessOfContact(row) * per_h);
  core_.addRight(core_row, contact.velocity[row] * per_h);
  for (int side = 0; side < 2; ++side) {
    const int body = contact.body[side];
    const double* jacobian = contact.jacobian[side][row];
    const auto place = model_.placeOf(body);
    if (place.chain < 0) {
      core_.couple(core_row, body, jacobian);
      continue;
    }
    const ChainState& chain = chains_[static_cast<std::size_t>(place.chain)];
    const Vector6 motion = pairs_[static_cast<std::size_t>(chain.pair)].motion(chain.lane, place.bead);
    core_.addRight(core_row, -Eigen::Map<const Vector6>(jacobian).dot(motion));
    for (int start = 0; start < 3 && place.bead == 0; ++start)
      core_.addBlock(core_row, chain.border_rows[static_cast<std::size_t>(start)],
                     throughBead(body, jacobian, chain.start.rows.jacobian[0][start]));
  }
  for (std::size_t number_before = 0; number_before < number; ++number_before) {
    const ContactRows& other = contacts_.all()[number_before];
    if (!haveBodyInCommon(contact, other)) continue;
    for (int other_row = 0; other_row < other.row_count; ++other_row) addContactPair(contact, row, other, other_row);
  }
  for (int other_row = 0; other_row <= row; ++other_row) addContactPair(contact, row, contact, other_row);
}

/// Two contact rows couple through the beads that both act on.
void StepProblem::addContactPair(const ContactRows& contact, int row, const ContactRows& other, int other_row) {
  if (other_row >= other.row_count || other.core_row[other_row] < 0) return;
  for (int side = 0; side < 2; ++side) {
    const int body = contact.body[side];
    if (model_.placeOf(body).chain < 0) continue;
    for (int other_side = 0; other_side < 2; ++other_side)
      if (other.body[other_side] == body)
        core_.addBlock(contact.core_row[row], other.core_row[other_row],
                       throughBead(body, contact.jacobian[side][row], other.jacobian[other_side][other_row]));
  }
}

void StepProblem::substitute() {
  const Vector6 rest = Vector6::Zero();
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const ChainState& chain = chains_[c];
    ChainPair& pair = pairs_[static_cast<std::size_t>(chain.pair)];
    const int end_bone = model_.chains[c].joints.back().body[1];
    pair.setBoneVelocity(chain.lane, end_bone >= 0 ? core_.velocity(end_bone) : rest);
    for (std::size_t i = 0; i < chain.border_rows.size(); ++i)
      pair.setBorderForce(chain.lane, static_cast<int>(i), core_.force(chain.border_rows[i]));
  }
  velocity_scale_ = force_scale_ = 0;
  for (ChainPair& pair : pairs_) {
    pair.substitute();
    velocity_scale_ = std::max(velocity_scale_, pair.largestVelocity());
  }
  for (int i = 0; i < model_.boneCount(); ++i)
    velocity_scale_ = std::max(velocity_scale_, core_.velocity(i).head<3>().cwiseAbs().maxCoeff());
  for (int row = 0; row < core_row_count_; ++row) force_scale_ = std::max(force_scale_, std::abs(core_.force(row)));
}

void StepProblem::giveForces(std::vector<BoundedRow>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RowPlace& place = places_[i];
    const auto owner = static_cast<std::size_t>(place.owner);
    const bool free = rows[i].state == RowState::free;
    if (place.kind == RowKind::chain_joint) {
      const ChainState& chain = chains_[owner];
      const ChainPair& pair = pairs_[static_cast<std::size_t>(chain.pair)];
      (free ? rows[i].force : rows[i].slack) = free ? pair.axisForce(chain.lane, place.part) : pair.axisSlack(chain.lane, place.part);
    } else if (place.kind == RowKind::skeleton_joint) {
      (free ? rows[i].force : rows[i].slack) = free ? core_.force(skeleton_[owner].core_row + 5) : slackOfSkeleton(owner);
    } else {
      const ContactRows& contact = contacts_.all()[owner];
      (free ? rows[i].force : rows[i].slack) = free ? core_.force(contact.core_row[place.part]) : slackOfContact(contact, place.part);
    }
  }
}

double StepProblem::slackOfSkeleton(std::size_t number) const {
  const JointState& joint = skeleton_[number];
  double slack = (joint.rows.softness[5] * joint.force - joint.rows.velocity[5]) / conditions_.h_s;
  for (int side = 0; side < 2; ++side) slack += alongBody(model_.skeleton[number].body[side], joint.rows.jacobian[side][5]);
  return slack;
}

double StepProblem::slackOfContact(const ContactRows& contact, int row) const {
  double slack = (softnessOfContact(row) * givenForce(contact, row) - contact.velocity[row]) / conditions_.h_s;
  for (int side = 0; side < 2; ++side) slack += alongBody(contact.body[side], contact.jacobian[side][row]);
  return slack;
}

/// Velocity / h of a body along a row.
double StepProblem::alongBody(int body, const double jacobian[6]) const {
  if (body < 0) return 0;
  const auto place = model_.placeOf(body);
  if (place.chain < 0) return core_.velocity(body).dot(Eigen::Map<const Vector6>(jacobian));
  const ChainState& chain = chains_[static_cast<std::size_t>(place.chain)];
  return pairs_[static_cast<std::size_t>(chain.pair)].velocityAlong(chain.lane, place.bead, jacobian);
}

}  // namespace musclesim::chain
