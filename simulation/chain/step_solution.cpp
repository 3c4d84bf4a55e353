/// The linear solve of StepProblem for given states of the bounded rows.
#include <algorithm>
#include <cmath>

#include "step_problem.h"

namespace musclesim::chain {

void StepProblem::solve(std::vector<BoundedRow>& rows) {
  takeStates(rows);
  setUpBorders();
  eliminateChains();
  numberRows();
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

double givenForce(const ContactRows& contact, int row) {
  return contact.state[row] == RowState::at_lower ? contact.lower[row] : contact.upper[row];
}

}  // namespace

/// Gives the chains their border rows and the forces of rows at bounds.
void StepProblem::setUpBorders() {
  for (std::size_t p = 0; p < bundles_.size(); ++p) {
    bundles_[p].clearBorder();
    if (bundle_dirty_[p]) bundles_[p].clearBeadForces();
  }
  for (ChainState& chain : chains_) {
    Bundle& bundle = bundles_[static_cast<std::size_t>(chain.bundle)];
    chain.border_contacts.clear();
    for (int row = 0; row < 3; ++row) bundle.addBorder(chain.lane, row, 0, chain.start.rows.jacobian[0][row]);
    if (!bundle_dirty_[static_cast<std::size_t>(chain.bundle)]) continue;
    for (std::size_t k = 0; k + 1 < chain.joints.size(); ++k) {
      const JointState& joint = chain.joints[k];
      if (joint.axisFree())
        bundle.setFree(chain.lane, static_cast<int>(k));
      else
        bundle.setForce(chain.lane, static_cast<int>(k), joint.bounded ? joint.force : 0);
    }
  }
  for (std::size_t i = 0; i < contacts_.all().size(); ++i)
    for (int row = 0; row < contacts_.all()[i].row_count; ++row) setUpContactBorder(i, row);
}

void StepProblem::setUpContactBorder(std::size_t number, int row) {
  const ContactRows& contact = contacts_.all()[number];
  const bool free = contact.state[row] == RowState::free;
  int column_of_first = -1;
  for (int side = 0; side < 2; ++side) {
    const auto place = model_.placeOf(contact.body[side]);
    if (place.chain < 0) continue;
    ChainState& chain = chains_[static_cast<std::size_t>(place.chain)];
    Bundle& bundle = bundles_[static_cast<std::size_t>(chain.bundle)];
    if (!free) {
      if (bundle_dirty_[static_cast<std::size_t>(chain.bundle)])
        bundle.addBeadForce(chain.lane, place.bead, contact.jacobian[side][row], givenForce(contact, row));
      continue;
    }
    const bool within_chain = side == 1 && place.chain == model_.placeOf(contact.body[0]).chain;
    const int column = within_chain ? column_of_first : 3 + static_cast<int>(chain.border_contacts.size());
    if (!within_chain) chain.border_contacts.push_back({RowKind::contact, static_cast<int>(number), row});
    column_of_first = column;
    bundle.addBorder(chain.lane, column, place.bead, contact.jacobian[side][row]);
  }
}

void StepProblem::eliminateChains() {
  for (std::size_t b = 0; b < bundles_.size(); ++b)
    if (bundle_dirty_[b]) bundles_[b].eliminate();
  for (std::size_t c = 0; c < chains_.size(); ++c)
    if (bundle_dirty_[static_cast<std::size_t>(chains_[c].bundle)]) findStiffStart(c);
  std::fill(bundle_dirty_.begin(), bundle_dirty_.end(), char{0});
}

int StepProblem::ownerOf(const ContactRows& contact) const {
  const int first = model_.placeOf(contact.body[0]).chain, second = model_.placeOf(contact.body[1]).chain;
  return keeps_bones_ ? order_.ownerOf(first, second) : std::max(first, second);
}

/// Numbers the core's rows in this order: the band, further rows of chains, contacts, the skeleton.
void StepProblem::numberRows() {
  chooseBand();
  int next = layout_.band = order_.rowCount();
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    chains_[c].border_rows.clear();
    for (const bool in_band : chains_[c].start_in_band)
      chains_[c].border_rows.push_back(in_band ? order_.takeRow(static_cast<int>(c)) : next++);
  }
  numberContacts(next);
  for (JointState& joint : skeleton_) {
    joint.core_row = next;
    next += joint.axisFree() ? 6 : std::min(joint.rows.row_count, 5);
  }
  layout_.row_count = next;
  for (ChainState& chain : chains_)
    for (const RowPlace& place : chain.border_contacts)
      chain.border_rows.push_back(contacts_.all()[static_cast<std::size_t>(place.owner)].core_row[place.part]);
}

/// Counts the rows of the band, which are eliminated before the bones. Rows that would be nearly rigid if all bones were held do not belong
/// in it.
void StepProblem::chooseBand() {
  order_.clearRows();
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    order_.addRows(static_cast<int>(c), static_cast<int>(std::count(chains_[c].start_in_band, chains_[c].start_in_band + 3, true)));
  }
  for (const ContactRows& contact : contacts_.all())
    for (int row = 0; row < contact.row_count; ++row)
      if (contact.state[row] == RowState::free && isInBand(contact, row)) order_.addRows(ownerOf(contact), 1);
  order_.number();
}

/// Finds rows of the ball joint at the start that have no usable pivot. A stretched muscle whose joints stick acts as a rod: while its end
/// is held, its start cannot move along the rod. Elimination with the largest pivot first shows which rows remain without a pivot.
void StepProblem::findStiffStart(std::size_t number) {
  constexpr double least_pivot_ratio = 1e-4;
  ChainState& state = chains_[number];
  std::fill_n(state.start_in_band, 3, keeps_bones_);
  if (!keeps_bones_) return;
  const Bundle& bundle = bundles_[static_cast<std::size_t>(state.bundle)];
  Eigen::Matrix3d d = state.start_block;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) d(i, j) -= bundle.borderBlock(state.lane, i, j);
  const double least_pivot = least_pivot_ratio * d.diagonal().maxCoeff();
  bool done[3] = {};
  for (int step = 0; step < 3; ++step) {
    int p = -1;
    for (int i = 0; i < 3; ++i)
      if (!done[i] && (p < 0 || d(i, i) > d(p, p))) p = i;
    done[p] = true;
    state.start_in_band[p] = d(p, p) > least_pivot;
    if (state.start_in_band[p]) d -= (d.col(p) * d.row(p) / d(p, p)).eval();
  }
}

void StepProblem::numberContacts(int& next) {
  for (ContactRows& contact : contacts_.all())
    for (int row = 0; row < contact.row_count; ++row) {
      const bool free = contact.state[row] == RowState::free;
      contact.core_row[row] = !free ? -1 : isInBand(contact, row) ? order_.takeRow(ownerOf(contact)) : next++;
    }
}

void StepProblem::assembleCore() {
  core_.reset(layout_);
  addBones();
  for (std::size_t c = 0; c < chains_.size(); ++c) addChain(c);
  addSkeleton();
  for (std::size_t i = 0; i < contacts_.all().size(); ++i)
    for (int row = 0; row < contacts_.all()[i].row_count; ++row) addContact(i, row);
}

/// Adds each bone's own mass and momentum and the forces of rows at a bound.
void StepProblem::addBones() {
  for (int i = 0; i < model_.boneCount(); ++i) {
    const BoneState& bone = bones_[static_cast<std::size_t>(i)];
    bone.rests ? core_.keepVelocity(i) : core_.setBone(i, bone.mass, bone.momentum);
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
  const Bundle& bundle = bundles_[static_cast<std::size_t>(state.bundle)];
  const int lane = state.lane;
  const int* rows = state.border_rows.data();
  const double per_h = 1 / conditions_.h_s;
  const Vector6 motion = bundle.motion(lane, 0);
  const JointRows& start = state.start.rows;
  for (int row = 0; row < 3; ++row) {
    for (int other = 0; other <= row; ++other) core_.addBlock(rows[row], rows[other], state.start_block(row, other));
    core_.addRight(rows[row], start.velocity[row] * per_h - Eigen::Map<const Vector6>(start.jacobian[0][row]).dot(motion));
    core_.couple(rows[row], 1, chain.start.body[1], start.jacobian[1][row]);
  }
  const int end_bone = chain.joints.back().body[1];
  for (int i = 0; i < static_cast<int>(state.border_rows.size()); ++i) {
    const int row = state.border_rows[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j) core_.addBlock(row, state.border_rows[static_cast<std::size_t>(j)], -bundle.borderBlock(lane, i, j));
    core_.addRight(row, -bundle.borderRight(lane, i));
    if (end_bone >= 0) core_.couple(row, 1, end_bone, bundle.boneCoupling(lane, i).data());
  }
  if (end_bone >= 0) core_.addBone(end_bone, bundle.boneMass(lane), bundle.boneMomentum(lane));
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
    }
    for (int side = 0; side < 2; ++side) core_.couple(joint.core_row, count, model_.skeleton[i].body[side], joint.rows.jacobian[side][0]);
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
      core_.couple(core_row, 1, body, jacobian);
      continue;
    }
    const ChainState& chain = chains_[static_cast<std::size_t>(place.chain)];
    const Vector6 motion = bundles_[static_cast<std::size_t>(chain.bundle)].motion(chain.lane, place.bead);
    core_.addRight(core_row, -Eigen::Map<const Vector6>(jacobian).dot(motion));
    for (int start = 0; start < 3 && place.bead == 0; ++start)
      core_.addBlock(core_row, chain.border_rows[static_cast<std::size_t>(start)],
                     throughBead(body, jacobian, chain.start.rows.jacobian[0][start]));
  }
  for (int side = 0; side < 2; ++side)
    if (model_.placeOf(contact.body[side]).chain >= 0) addSharedBead(contact, row, side);
}

/// Contact rows couple through a bead that both act on. Adds the coupling with the contact's rows up to this one and with the rows of
/// earlier contacts.
void StepProblem::addSharedBead(const ContactRows& contact, int row, int side) {
  const int body = contact.body[side];
  const auto add = [&](const ContactRows& other, int other_side, int other_row) {
    if (other.core_row[other_row] >= 0)
      core_.addBlock(contact.core_row[row], other.core_row[other_row],
                     throughBead(body, contact.jacobian[side][row], other.jacobian[other_side][other_row]));
  };
  for (int other_row = 0; other_row <= row; ++other_row) add(contact, side, other_row);
  for (int i = contact.before[side]; i >= 0;) {
    const ContactRows& other = contacts_.all()[static_cast<std::size_t>(i)];
    const int other_side = other.body[0] == body ? 0 : 1;
    for (int other_row = 0; other_row < other.row_count; ++other_row) add(other, other_side, other_row);
    i = other.before[other_side];
  }
}

void StepProblem::substitute() {
  const Vector6 rest = Vector6::Zero();
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const ChainState& chain = chains_[c];
    Bundle& bundle = bundles_[static_cast<std::size_t>(chain.bundle)];
    const int end_bone = model_.chains[c].joints.back().body[1];
    bundle.setBoneVelocity(chain.lane, end_bone >= 0 ? core_.velocity(end_bone) : rest);
    for (std::size_t i = 0; i < chain.border_rows.size(); ++i)
      bundle.setBorderForce(chain.lane, static_cast<int>(i), core_.force(chain.border_rows[i]));
  }
  velocity_scale_ = force_scale_ = 0;
  for (Bundle& bundle : bundles_) {
    bundle.substitute();
    velocity_scale_ = std::max(velocity_scale_, bundle.largestVelocity());
  }
  for (int i = 0; i < model_.boneCount(); ++i)
    velocity_scale_ = std::max(velocity_scale_, core_.velocity(i).head<3>().cwiseAbs().maxCoeff());
  for (int row = 0; row < layout_.row_count; ++row) force_scale_ = std::max(force_scale_, std::abs(core_.force(row)));
}

void StepProblem::giveForces(std::vector<BoundedRow>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RowPlace& place = places_[i];
    const auto owner = static_cast<std::size_t>(place.owner);
    const bool free = rows[i].state == RowState::free;
    if (place.kind == RowKind::chain_joint) {
      const ChainState& chain = chains_[owner];
      const Bundle& bundle = bundles_[static_cast<std::size_t>(chain.bundle)];
      (free ? rows[i].force : rows[i].slack) = free ? bundle.axisForce(chain.lane, place.part) : bundle.axisSlack(chain.lane, place.part);
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
  return bundles_[static_cast<std::size_t>(chain.bundle)].velocityAlong(chain.lane, place.bead, jacobian);
}

}  // namespace musclesim::chain
