#include "chain_bundle.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace musclesim::chain {

template <int lane_count>
ChainBundle<lane_count>::ChainBundle(const std::array<int, lane_count>& bead_counts) : bead_count_(bead_counts) {
  const int longest = *std::max_element(bead_counts.begin(), bead_counts.end());
  for (std::size_t lane = 0; lane < lane_count; ++lane) offset_[lane] = longest - bead_count_[lane];
  nodes_.resize(static_cast<std::size_t>(longest));
  beads_.resize(nodes_.size());
  axes_.resize(nodes_.size());
  std::memset(static_cast<void*>(nodes_.data()), 0, nodes_.size() * sizeof(Node));
  std::memset(static_cast<void*>(beads_.data()), 0, beads_.size() * sizeof(Bead));
  // Unused rows: with softness 1 and target 0 their force is 0.
  for (Node& node : nodes_)
    for (Pack& softness : node.softness) softness = all(1);
  for (Axis& axis : axes_) axis = {all(1), all(0), all(0), all(0), all(1)};
}

template <int lane_count>
void ChainBundle<lane_count>::setJoint(int lane, int joint, const JointRows& rows, double h_s) {
  Node& node = nodes_[index(lane, joint)];
  const auto copy = [&](int first_row, int end_row, int first, int end) {
    for (int body = 0; body < 2; ++body)
      for (int row = first_row; row < end_row; ++row)
        for (int i = first; i < end; ++i) node.jacobian[body][row][i][lane] = rows.jacobian[body][row][i];
  };
  // After the first call only entries other than the constants 0 and 1 are copied.
  if (node.present[lane] == 0)
    copy(0, 6, 0, 6);
  else if (firstPushing(joint) == 3)
    copy(3, 6, 0, 6);
  else
    copy(0, 6, 3, 6);
  node.present[lane] = 1;
  for (int row = 0; row < 6; ++row) {
    const bool holds = row < rows.row_count;
    node.target[row][lane] = holds ? rows.velocity[row] / h_s : 0;
    node.softness[row][lane] = holds ? rows.softness[row] / h_s : 1;
  }
  setFree(lane, joint);
}

template <int lane_count>
void ChainBundle<lane_count>::setInertia(int lane, const BeadInertia& inertia) {
  per_mass_[lane] = inertia.per_mass;
  per_inertia_[lane] = inertia.per_inertia;
}

template <int lane_count>
void ChainBundle<lane_count>::setFreeMotion(int lane, int bead, const Vector6& a) {
  Bead& b = beads_[index(lane, bead)];
  for (int i = 0; i < 6; ++i) b.free_motion[i][lane] = a[i];
}

template <int lane_count>
void ChainBundle<lane_count>::setFree(int lane, int joint) {
  Axis& axis = axes_[index(lane, joint)];
  axis.free[lane] = 1;
  axis.given[lane] = 0;
}

template <int lane_count>
void ChainBundle<lane_count>::setForce(int lane, int joint, double force) {
  Axis& axis = axes_[index(lane, joint)];
  axis.free[lane] = 0;
  axis.given[lane] = force;
}

template <int lane_count>
void ChainBundle<lane_count>::clearBeadForces() {
  for (Bead& bead : beads_)
    for (Pack& force : bead.outer_force) force = all(0);
}

template <int lane_count>
void ChainBundle<lane_count>::addBeadForce(int lane, int bead, const double jacobian[6], double force) {
  for (int i = 0; i < 6; ++i) beads_[index(lane, bead)].outer_force[i][lane] += force * jacobian[i];
}

template <int lane_count>
void ChainBundle<lane_count>::clearBorder() {
  border_count_ = 0;
  entries_.clear();
}

template <int lane_count>
void ChainBundle<lane_count>::addBorder(int lane, int column, int bead, const double jacobian[6]) {
  border_count_ = std::max(border_count_, column + 1);
  BorderEntry entry = {lane, column, static_cast<int>(index(lane, bead)), {}};
  std::copy_n(jacobian, 6, entry.jacobian);
  entries_.push_back(entry);
}

template <int lane_count>
void ChainBundle<lane_count>::reserve(int border_count) {
  growBorder(border_count);
  entries_.reserve(lane_count * static_cast<std::size_t>(border_count));
}

template <int lane_count>
void ChainBundle<lane_count>::growBorder(int count) {
  const auto needed = static_cast<std::size_t>(count);
  if (needed <= border_capacity_) return;
  border_capacity_ = needed + 6;
  border_.resize(nodes_.size() * border_capacity_);
  border_block_.resize(border_capacity_ * (border_capacity_ + 1) / 2);
  border_right_.resize(border_capacity_);
  border_force_.resize(border_capacity_);
  bone_coupling_.resize(border_capacity_);
  first_node_.resize(border_capacity_);
  last_node_.resize(border_capacity_);
}

/// B_k,j = J_k S J_j^T for all border rows j, at the nodes they couple to.
template <int lane_count>
void ChainBundle<lane_count>::fillBorder() {
  growBorder(border_count_);
  std::fill_n(first_node_.begin(), border_count_, nodeCount());
  std::fill_n(last_node_.begin(), border_count_, -1);
  for (const BorderEntry& entry : entries_) {
    int &first = first_node_[static_cast<std::size_t>(entry.column)], &last = last_node_[static_cast<std::size_t>(entry.column)];
    first = std::min(first, std::max(0, entry.node - 1));
    last = std::max(last, entry.node);
  }
  for (int c = 0; c < border_count_; ++c)
    for (int k = first_node_[static_cast<std::size_t>(c)]; k <= last_node_[static_cast<std::size_t>(c)]; ++k) borderOf(k)[c] = Column{};
  for (const BorderEntry& entry : entries_) {
    const double per_mass = per_mass_[entry.lane], per_inertia = per_inertia_[entry.lane];
    double scaled[6];
    for (int i = 0; i < 6; ++i) scaled[i] = (i < 3 ? per_mass : per_inertia) * entry.jacobian[i];
    for (int k = entry.node; k >= 0 && k >= entry.node - 1; --k) {
      const auto& jacobian = nodes_[static_cast<std::size_t>(k)].jacobian[entry.node - k];
      Column& column = borderOf(k)[entry.column];
      for (int row = 0; row < 6; ++row) {
        double sum = 0;
        for (int i = 0; i < 6; ++i) sum += jacobian[row][i][entry.lane] * scaled[i];
        column.value[row][entry.lane] += sum;
      }
    }
  }
  const auto count = static_cast<std::size_t>(border_count_);
  for (std::size_t i = 0; i < count * (count + 1) / 2; ++i) border_block_[i].value = all(0);
  for (std::size_t i = 0; i < count; ++i) border_right_[i].value = border_force_[i].value = all(0);
}

/// Terms of node k that are subtracted from node k + 1.
template <int lane_count>
struct ChainBundle<lane_count>::Carry {
  Pack own[6][6] = {};
  Pack right[6] = {};
};

template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::moveBeads() {
  const std::size_t last = nodes_.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    Bead& bead = beads_[k];
    for (int i = 0; i < 6; ++i) {
      Pack force = bead.outer_force[i] + axes_[k].given * nodes_[k].jacobian[0][5][i];
      if (k > 0) force += axes_[k - 1].given * nodes_[k - 1].jacobian[1][5][i];
      bead.motion[i] = bead.free_motion[i] + inertia(i) * force;
    }
  }
}

/// Factorises `own` = L D L^T and overwrites its lower part.
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::factorise(Node& node, Pack own[6][6]) const {
  for (int p = 0; p < 6; ++p) {
    const Pack per_pivot = 1.0 / own[p][p];
    node.per_pivot[p] = per_pivot;
    for (int i = p + 1; i < 6; ++i) {
      const Pack l = own[i][p] * per_pivot;
      node.factor[i][p] = l;
      for (int j = p + 1; j <= i; ++j) own[i][j] -= l * own[j][p];
    }
  }
}

/// Masks row 5 of A_k' and factorises it.
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::factoriseNode(int k, const Carry& carry) {
  Node& node = nodes_[static_cast<std::size_t>(k)];
  const Pack free = axes_[static_cast<std::size_t>(k)].free;
  Pack own[6][6];
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j <= i; ++j) own[i][j] = node.own[i][j] - carry.own[i][j];
  for (int j = 0; j < 5; ++j) own[5][j] = free * (node.own[5][j] - carry.own[5][j]);
  own[5][5] = free * (node.own[5][5] - carry.own[5][5]) + (1.0 - free);
  factorise(node, own);
}

/// Computes three rows of r_k and subtracts the terms of node k - 1.
template <int lane_count>
template <bool push>
MUSCLESIM_INLINE void ChainBundle<lane_count>::makeThreeRights(std::size_t k, int first, const Carry& carry) {
  Node& node = nodes_[k];
  for (int i = first; i < first + 3; ++i) {
    node.right[i] = node.target[i] - dotOf<push>(node.jacobian[0][i], beads_[k].motion) - carry.right[i];
    if (k + 1 < nodes_.size()) node.right[i] -= dotOf<push>(node.jacobian[1][i], beads_[k + 1].motion);
  }
}

/// Multiplies the right-hand side, the coupling to the next node and the border by L^-1.
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::reduceColumns(int k, const Carry& carry) {
  const auto last = static_cast<int>(nodes_.size()) - 1;
  Node& node = nodes_[static_cast<std::size_t>(k)];
  const Pack free = axes_[static_cast<std::size_t>(k)].free, next_free = k < last ? axes_[static_cast<std::size_t>(k) + 1].free : all(1);
  const int pushing = firstPushing(k);
  makeThreeRights<true>(static_cast<std::size_t>(k), pushing, carry);
  makeThreeRights<false>(static_cast<std::size_t>(k), 3 - pushing, carry);
  node.right[5] *= free;
  forward(node.factor, node.right);
  for (int c = 0; c < 6; ++c) {
    Pack column[6];
    for (int i = 0; i < 6; ++i) column[i] = node.next[i][c];
    if (c == 5 && k < last)
      for (Pack& entry : column) entry *= next_free;
    column[5] *= free;
    forward(node.factor, column);
    for (int i = 0; i < 6; ++i) node.coupling[i][c] = column[i];
  }
  Column* border = borderOf(k);
  for (int c = 0; c < border_count_; ++c) {
    if (!reaches(c, k)) continue;
    border[c].value[5] *= free;
    forward(node.factor, border[c].value);
  }
}

/// Terms that node k subtracts from node k + 1: W^T D^-1 times W, the right-hand side and the border.
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::carryOver(int k, Carry& carry) {
  const Node& node = nodes_[static_cast<std::size_t>(k)];
  Pack scaled[6][6];
  for (int c = 0; c < 6; ++c)
    for (int p = 0; p < 6; ++p) scaled[c][p] = node.coupling[p][c] * node.per_pivot[p];
  for (int j = 0; j < 6; ++j) {
    Pack column[6];
    for (int p = 0; p < 6; ++p) column[p] = node.coupling[p][j];
    for (int i = j; i < 6; ++i) carry.own[i][j] = dot(scaled[i], column);
    carry.right[j] = dot(scaled[j], node.right);
  }
  const Column* border = borderOf(k);
  Column* next_border = borderOf(k + 1);
  for (int c = 0; c < border_count_; ++c) {
    if (!reaches(c, k)) continue;
    const bool couples = k < last_node_[static_cast<std::size_t>(c)];
    for (int i = 0; i < 6; ++i) next_border[c].value[i] = (couples ? next_border[c].value[i] : all(0)) - dot(scaled[i], border[c].value);
  }
}

template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::accumulateBorder(int k) {
  const Node& node = nodes_[static_cast<std::size_t>(k)];
  const Column* border = borderOf(k);
  for (int c = 0; c < border_count_; ++c) {
    if (!reaches(c, k)) continue;
    Pack scaled[6];
    for (int p = 0; p < 6; ++p) scaled[p] = border[c].value[p] * node.per_pivot[p];
    for (int d = 0; d <= c; ++d)
      if (reaches(d, k)) border_block_[blockIndex(c, d)].value += dot(scaled, border[d].value);
    border_right_[static_cast<std::size_t>(c)].value += dot(scaled, node.right);
  }
}

/// M_B += W^T D^-1 W,  g_B += W^T D^-1 right,  J_B = -W^T D^-1 border, with W = L^-1 J of the last node's three rows.
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::leaveToBone() {
  const auto last = static_cast<int>(nodes_.size()) - 1;
  const Node& node = nodes_[static_cast<std::size_t>(last)];
  const Column* border = borderOf(last);
  for (int i = 0; i < 6; ++i) {
    Pack scaled[6];
    for (int p = 0; p < 6; ++p) scaled[p] = node.coupling[p][i] * node.per_pivot[p];
    for (int j = 0; j < 6; ++j) {
      Pack sum = all(0);
      for (int p = 0; p < 3; ++p) sum += scaled[p] * node.coupling[p][j];
      for (int lane = 0; lane < lane_count; ++lane) bone_mass_[lane](i, j) = sum[lane];
    }
    Pack sum = all(0);
    for (int p = 0; p < 3; ++p) sum += scaled[p] * node.right[p];
    for (int lane = 0; lane < lane_count; ++lane) bone_momentum_[lane][i] = sum[lane];
    for (int c = 0; c < border_count_; ++c) {
      Pack coupling = all(0);
      for (int p = 0; p < 3; ++p) coupling -= scaled[p] * border[c].value[p];
      bone_coupling_[static_cast<std::size_t>(c)].value[i] = coupling;
    }
  }
}

template <int lane_count>
Vector6 ChainBundle<lane_count>::boneCoupling(int lane, int i) const {
  Vector6 result;
  for (int q = 0; q < 6; ++q) result[q] = bone_coupling_[static_cast<std::size_t>(i)].value[q][lane];
  return result;
}

template <int lane_count>
Vector6 ChainBundle<lane_count>::motion(int lane, int bead) const {
  Vector6 result;
  for (int q = 0; q < 6; ++q) result[q] = beads_[index(lane, bead)].motion[q][lane];
  return result;
}

template <int lane_count>
Vector6 ChainBundle<lane_count>::velocity(int lane, int bead) const {
  Vector6 result;
  for (int q = 0; q < 6; ++q) result[q] = beads_[index(lane, bead)].velocity[q][lane];
  return result;
}

template <int lane_count>
double ChainBundle<lane_count>::velocityAlong(int lane, int bead, const double jacobian[6]) const {
  return dot(beads_[index(lane, bead)].velocity, jacobian)[lane];
}

template <int lane_count>
void ChainBundle<lane_count>::setBoneVelocity(int lane, const Vector6& u) {
  for (int q = 0; q < 6; ++q) bone_velocity_[q][lane] = u[q];
}

template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::substituteForces() {
  const auto last = static_cast<int>(nodes_.size()) - 1;
  Pack following[6];
  for (int q = 0; q < 6; ++q) following[q] = bone_velocity_[q];
  for (int k = last; k >= 0; --k) {
    Node& node = nodes_[static_cast<std::size_t>(k)];
    for (int i = 0; i < 6; ++i) node.force[i] = node.right[i] - dot(node.coupling[i], following);
    for (int c = 0; c < border_count_; ++c) {
      if (!reaches(c, k)) continue;
      const Pack force = border_force_[static_cast<std::size_t>(c)].value;
      for (int i = 0; i < 6; ++i) node.force[i] -= borderOf(k)[c].value[i] * force;
    }
    for (int i = 0; i < 6; ++i) node.force[i] *= node.per_pivot[i];
    for (int i = 4; i >= 0; --i)
      for (int j = i + 1; j < 6; ++j) node.force[i] -= node.factor[j][i] * node.force[j];
    for (int i = 0; i < 6; ++i) following[i] = node.force[i];
    axes_[static_cast<std::size_t>(k)].force = node.force[5];
  }
}

/// u = a + S J^T l
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::substituteVelocities() {
  for (std::size_t k = 0; k < beads_.size(); ++k) {
    const Node &own = nodes_[k], &before = nodes_[k > 0 ? k - 1 : 0];
    const bool own_pushes_high = firstPushing(static_cast<int>(k)) == 3;
    const Node &low = own_pushes_high ? before : own, &high = own_pushes_high ? own : before;
    for (int i = 0; i < 3; ++i) {
      Pack sum = all(0);
      if (k > 0)
        for (int row = 0; row < 3; ++row) sum += low.jacobian[own_pushes_high][row][i] * low.force[row];
      for (int row = 3; row < 6; ++row) sum += high.jacobian[!own_pushes_high][row][i] * high.force[row];
      beads_[k].velocity[i] = beads_[k].motion[i] + inertia(i) * sum;
    }
    for (int i = 3; i < 6; ++i) {
      Pack sum = all(0);
      for (int row = 0; row < 6; ++row) {
        sum += own.jacobian[0][row][i] * own.force[row];
        if (k > 0) sum += before.jacobian[1][row][i] * before.force[row];
      }
      beads_[k].velocity[i] = beads_[k].motion[i] + inertia(i) * sum;
    }
  }
  for (const BorderEntry& entry : entries_) {
    Bead& bead = beads_[static_cast<std::size_t>(entry.node)];
    const double force = border_force_[static_cast<std::size_t>(entry.column)].value[entry.lane];
    for (int i = 0; i < 6; ++i) bead.velocity[i][entry.lane] += inertia(i)[entry.lane] * entry.jacobian[i] * force;
  }
}

/// w = J u + cfm/h l - c/h of row 5
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::makeSlacks() {
  for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    axes_[k].slack = dot(node.jacobian[0][5], beads_[k].velocity) + dot(node.jacobian[1][5], beads_[k + 1].velocity) +
                     node.softness[5] * axes_[k].given - node.target[5];
  }
}

template <int lane_count>
double ChainBundle<lane_count>::largestVelocity() const {
  double largest = 0;
  for (const Bead& bead : beads_)
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < lane_count; ++lane) largest = std::max(largest, std::abs(bead.velocity[i][lane]));
  return largest;
}

template <int lane_count>
MUSCLESIM_SIMD void ChainBundle<lane_count>::eliminateNodes() {
  moveBeads();
  Carry carry;
  for (int k = 0; k < nodeCount(); ++k) {
    factoriseNode(k, carry);
    reduceColumns(k, carry);
    accumulateBorder(k);
    if (k + 1 < nodeCount()) carryOver(k, carry);
  }
  leaveToBone();
}

template <int lane_count>
MUSCLESIM_SIMD void ChainBundle<lane_count>::substituteAll() {
  substituteForces();
  substituteVelocities();
  makeSlacks();
}

template <int lane_count>
void ChainBundle<lane_count>::eliminate() {
  fillBorder();
  eliminateNodes();
}

template <int lane_count>
void ChainBundle<lane_count>::substitute() {
  substituteAll();
}

template class ChainBundle<2>;
template class ChainBundle<4>;

}  // namespace musclesim::chain
