/// Elimination and back substitution of ChainBundle.
#include <algorithm>
#include <cmath>

#include "chain_bundle.h"
#include "wide.h"

namespace musclesim::chain {

namespace {

/// y <- L^-1 y with unit lower L.
MUSCLESIM_INLINE void forward(const Pack factor[6][6], Pack y[6]) {
  for (int i = 1; i < 6; ++i)
    for (int j = 0; j < i; ++j) y[i] -= factor[i][j] * y[j];
}

}  // namespace

/// What node k subtracts from node k + 1.
struct ChainBundle::Carry {
  Pack own[6][6] = {};
  Pack right[6] = {};
};

MUSCLESIM_WIDE void ChainBundle::moveBeads() {
  const std::size_t last = nodes_.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    Bead& bead = beads_[k];
    for (int i = 0; i < 6; ++i) {
      Pack force = bead.outer_force[i] + nodes_[k].given * nodes_[k].jacobian[0][5][i];
      if (k > 0) force += nodes_[k - 1].given * nodes_[k - 1].jacobian[1][5][i];
      bead.motion[i] = bead.free_motion[i] + inertia(i) * force;
    }
  }
}

/// L D L^T of `own`, whose lower part is used up.
MUSCLESIM_INLINE void ChainBundle::factorise(Node& node, Pack own[6][6]) const {
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

/// A_k' with row 5 masked, factored.
MUSCLESIM_INLINE void ChainBundle::factoriseNode(int k, const Carry& carry) {
  Node& node = nodes_[static_cast<std::size_t>(k)];
  const Pack free = node.free;
  Pack own[6][6];
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j <= i; ++j) own[i][j] = node.own[i][j] - carry.own[i][j];
  for (int j = 0; j < 5; ++j) own[5][j] = free * (node.own[5][j] - carry.own[5][j]);
  own[5][5] = free * (node.own[5][5] - carry.own[5][5]) + (1.0 - free);
  factorise(node, own);
}

/// L^-1 times the right side, the coupling with the next node and the border.
MUSCLESIM_INLINE void ChainBundle::reduceColumns(int k, const Carry& carry) {
  const auto last = static_cast<int>(nodes_.size()) - 1;
  Node& node = nodes_[static_cast<std::size_t>(k)];
  const Pack free = node.free, next_free = k < last ? nodes_[static_cast<std::size_t>(k) + 1].free : all(1);
  for (int i = 0; i < 6; ++i) {
    Pack r = node.target[i] - dot(node.jacobian[0][i], beads_[static_cast<std::size_t>(k)].motion) - carry.right[i];
    if (k < last) r -= dot(node.jacobian[1][i], beads_[static_cast<std::size_t>(k) + 1].motion);
    node.right[i] = i == 5 ? free * r : r;
  }
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

/// What node k takes from node k + 1: W^T D^-1 times W, the right side and the border.
MUSCLESIM_INLINE void ChainBundle::carryOver(int k, Carry& carry) {
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
  for (int c = 0; c < border_count_; ++c)
    if (reaches(c, k))
      for (int i = 0; i < 6; ++i) next_border[c].value[i] -= dot(scaled[i], border[c].value);
}

MUSCLESIM_INLINE void ChainBundle::accumulateBorder(int k) {
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
MUSCLESIM_INLINE void ChainBundle::leaveToBone() {
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

Vector6 ChainBundle::boneCoupling(int lane, int i) const {
  Vector6 result;
  for (int q = 0; q < 6; ++q) result[q] = bone_coupling_[static_cast<std::size_t>(i)].value[q][lane];
  return result;
}

Vector6 ChainBundle::motion(int lane, int bead) const {
  Vector6 result;
  for (int q = 0; q < 6; ++q) result[q] = beads_[index(lane, bead)].motion[q][lane];
  return result;
}

Vector6 ChainBundle::velocity(int lane, int bead) const {
  Vector6 result;
  for (int q = 0; q < 6; ++q) result[q] = beads_[index(lane, bead)].velocity[q][lane];
  return result;
}

double ChainBundle::velocityAlong(int lane, int bead, const double jacobian[6]) const {
  return dot(beads_[index(lane, bead)].velocity, jacobian)[lane];
}

void ChainBundle::setBoneVelocity(int lane, const Vector6& u) {
  for (int q = 0; q < 6; ++q) bone_velocity_[q][lane] = u[q];
}

MUSCLESIM_INLINE void ChainBundle::substituteForces() {
  const auto last = static_cast<int>(nodes_.size()) - 1;
  Pack following[6];
  for (int q = 0; q < 6; ++q) following[q] = bone_velocity_[q];
  for (int k = last; k >= 0; --k) {
    Node& node = nodes_[static_cast<std::size_t>(k)];
    const Column* border = borderOf(k);
    for (int i = 0; i < 6; ++i) {
      Pack sum = node.right[i] - dot(node.coupling[i], following);
      for (int c = 0; c < border_count_; ++c)
        if (reaches(c, k)) sum -= border[c].value[i] * border_force_[static_cast<std::size_t>(c)].value;
      node.force[i] = sum * node.per_pivot[i];
    }
    for (int i = 4; i >= 0; --i)
      for (int j = i + 1; j < 6; ++j) node.force[i] -= node.factor[j][i] * node.force[j];
    for (int i = 0; i < 6; ++i) following[i] = node.force[i];
  }
}

/// u = a + S J^T l
MUSCLESIM_INLINE void ChainBundle::substituteVelocities() {
  for (std::size_t k = 0; k < beads_.size(); ++k)
    for (int i = 0; i < 6; ++i) {
      Pack sum = all(0);
      for (int row = 0; row < 6; ++row) {
        sum += nodes_[k].jacobian[0][row][i] * nodes_[k].force[row];
        if (k > 0) sum += nodes_[k - 1].jacobian[1][row][i] * nodes_[k - 1].force[row];
      }
      beads_[k].velocity[i] = beads_[k].motion[i] + inertia(i) * sum;
    }
  for (const BorderEntry& entry : entries_) {
    Bead& bead = beads_[static_cast<std::size_t>(entry.node)];
    const double force = border_force_[static_cast<std::size_t>(entry.column)].value[entry.lane];
    for (int i = 0; i < 6; ++i) bead.velocity[i][entry.lane] += inertia(i)[entry.lane] * entry.jacobian[i] * force;
  }
}

/// w = J u + cfm/h l - c/h of row 5
MUSCLESIM_INLINE void ChainBundle::makeSlacks() {
  for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
    Node& node = nodes_[k];
    node.slack = dot(node.jacobian[0][5], beads_[k].velocity) + dot(node.jacobian[1][5], beads_[k + 1].velocity) +
                 node.softness[5] * node.given - node.target[5];
  }
}

double ChainBundle::largestVelocity() const {
  double largest = 0;
  for (const Bead& bead : beads_)
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < lane_count; ++lane) largest = std::max(largest, std::abs(bead.velocity[i][lane]));
  return largest;
}

MUSCLESIM_WIDE void ChainBundle::eliminate() {
  moveBeads();
  fillBorder();
  Carry carry;
  for (int k = 0; k < nodeCount(); ++k) {
    factoriseNode(k, carry);
    reduceColumns(k, carry);
    accumulateBorder(k);
    if (k + 1 < nodeCount()) carryOver(k, carry);
  }
  leaveToBone();
}

MUSCLESIM_WIDE void ChainBundle::substitute() {
  substituteForces();
  substituteVelocities();
  makeSlacks();
}

}  // namespace musclesim::chain
