#include "chain_bundle.h"

#include <algorithm>
#include <cstring>

#include "wide.h"

namespace musclesim::chain {

ChainBundle::ChainBundle(const std::array<int, lane_count>& bead_counts) : bead_count_(bead_counts) {
  const int longest = *std::max_element(bead_counts.begin(), bead_counts.end());
  for (std::size_t lane = 0; lane < lane_count; ++lane) offset_[lane] = longest - bead_count_[lane];
  nodes_.resize(static_cast<std::size_t>(longest));
  beads_.resize(nodes_.size());
  std::memset(static_cast<void*>(nodes_.data()), 0, nodes_.size() * sizeof(Node));
  std::memset(static_cast<void*>(beads_.data()), 0, beads_.size() * sizeof(Bead));
  // Rows that hold nothing: force 0.
  for (Node& node : nodes_) {
    node.free = all(1);
    for (Pack& softness : node.softness) softness = all(1);
  }
}

void ChainBundle::setJoint(int lane, int joint, const JointRows& rows, double h_s) {
  Node& node = nodes_[index(lane, joint)];
  for (int body = 0; body < 2; ++body)
    for (int row = 0; row < 6; ++row)
      for (int i = 0; i < 6; ++i) node.jacobian[body][row][i][lane] = rows.jacobian[body][row][i];
  for (int row = 0; row < 6; ++row) {
    const bool holds = row < rows.row_count;
    node.target[row][lane] = holds ? rows.velocity[row] / h_s : 0;
    node.softness[row][lane] = holds ? rows.softness[row] / h_s : 1;
  }
  node.free[lane] = 1;
  node.given[lane] = 0;
}

void ChainBundle::setInertia(int lane, const BeadInertia& inertia) {
  per_mass_[lane] = inertia.per_mass;
  per_inertia_[lane] = inertia.per_inertia;
}

void ChainBundle::setFreeMotion(int lane, int bead, const Vector6& a) {
  Bead& b = beads_[index(lane, bead)];
  for (int i = 0; i < 6; ++i) b.free_motion[i][lane] = a[i];
}

MUSCLESIM_WIDE void ChainBundle::makeBlocks() {
  const std::size_t last = nodes_.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    Node& node = nodes_[k];
    for (int row = 0; row < 6; ++row) {
      Pack scaled[2][6];
      for (int i = 0; i < 6; ++i) {
        scaled[0][i] = inertia(i) * node.jacobian[0][row][i];
        scaled[1][i] = inertia(i) * node.jacobian[1][row][i];
      }
      for (int other = 0; other <= row; ++other) {
        node.own[row][other] = dot(scaled[0], node.jacobian[0][other]);
        if (k < last) node.own[row][other] += dot(scaled[1], node.jacobian[1][other]);
      }
      node.own[row][row] += node.softness[row];
      for (int other = 0; other < 6; ++other)
        node.next[row][other] = k < last ? dot(scaled[1], nodes_[k + 1].jacobian[0][other]) : node.jacobian[1][row][other];
    }
  }
}

void ChainBundle::setFree(int lane, int joint) {
  nodes_[index(lane, joint)].free[lane] = 1;
  nodes_[index(lane, joint)].given[lane] = 0;
}

void ChainBundle::setForce(int lane, int joint, double force) {
  nodes_[index(lane, joint)].free[lane] = 0;
  nodes_[index(lane, joint)].given[lane] = force;
}

void ChainBundle::clearBeadForces() {
  for (Bead& bead : beads_)
    for (Pack& force : bead.outer_force) force = all(0);
}

void ChainBundle::addBeadForce(int lane, int bead, const double jacobian[6], double force) {
  for (int i = 0; i < 6; ++i) beads_[index(lane, bead)].outer_force[i][lane] += force * jacobian[i];
}

void ChainBundle::clearBorder() {
  border_count_ = 0;
  entries_.clear();
}

void ChainBundle::addBorder(int lane, int column, int bead, const double jacobian[6]) {
  border_count_ = std::max(border_count_, column + 1);
  BorderEntry entry = {lane, column, static_cast<int>(index(lane, bead)), {}};
  std::copy_n(jacobian, 6, entry.jacobian);
  entries_.push_back(entry);
}

void ChainBundle::reserve(int border_count) {
  growBorder(border_count);
  entries_.reserve(lane_count * static_cast<std::size_t>(border_count));
}

void ChainBundle::growBorder(int count) {
  const auto needed = static_cast<std::size_t>(count);
  if (needed <= border_capacity_) return;
  border_capacity_ = needed + 6;
  border_.resize(nodes_.size() * border_capacity_);
  border_block_.resize(border_capacity_ * (border_capacity_ + 1) / 2);
  border_right_.resize(border_capacity_);
  border_force_.resize(border_capacity_);
  bone_coupling_.resize(border_capacity_);
  first_node_.resize(border_capacity_);
}

/// B_k,j = J_k S J_j^T for all border rows j.
void ChainBundle::fillBorder() {
  growBorder(border_count_);
  std::fill_n(first_node_.begin(), border_count_, nodeCount());
  for (const BorderEntry& entry : entries_) {
    int& first = first_node_[static_cast<std::size_t>(entry.column)];
    first = std::min(first, std::max(0, entry.node - 1));
  }
  for (int k = 0; k < nodeCount(); ++k)
    for (int c = 0; c < border_count_; ++c)
      if (reaches(c, k)) borderOf(k)[c] = Column{};
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

}  // namespace musclesim::chain
