/// A ChainBundle of two or four lanes, chosen by the number of chains: two chains in four lanes would take twice the memory.
#pragma once

#include <algorithm>
#include <array>
#include <variant>
#include <vector>

#include "chain_bundle.h"

namespace musclesim::chain {

/// Forwards every call to the ChainBundle; see there.
class Bundle {
  using Lanes = std::variant<ChainBundle<2>, ChainBundle<4>>;

  template <typename Call>
  decltype(auto) in(Call call) {
    return std::visit(call, lanes_);
  }
  template <typename Call>
  decltype(auto) in(Call call) const {
    return std::visit(call, lanes_);
  }

 public:
  static constexpr std::size_t most_chains = 4;

  /// `bead_counts` has one entry per chain, for one to four chains.
  explicit Bundle(const std::vector<int>& bead_counts)
      : lanes_(bead_counts.size() <= 2 ? Lanes(ChainBundle<2>(arrayOf<2>(bead_counts))) : Lanes(ChainBundle<4>(arrayOf<4>(bead_counts)))) {}

  void setJoint(int lane, int joint, const JointRows& rows, double h_s) {
    in([&](auto& b) { b.setJoint(lane, joint, rows, h_s); });
  }
  void setInertia(int lane, const BeadInertia& inertia) {
    in([&](auto& b) { b.setInertia(lane, inertia); });
  }
  void setFreeMotion(int lane, int bead, const Vector6& a) {
    in([&](auto& b) { b.setFreeMotion(lane, bead, a); });
  }
  void makeBlocks() {
    in([](auto& b) { b.makeBlocks(); });
  }
  void setFree(int lane, int joint) {
    in([&](auto& b) { b.setFree(lane, joint); });
  }
  void setForce(int lane, int joint, double force) {
    in([&](auto& b) { b.setForce(lane, joint, force); });
  }
  void clearBeadForces() {
    in([](auto& b) { b.clearBeadForces(); });
  }
  void addBeadForce(int lane, int bead, const double jacobian[6], double force) {
    in([&](auto& b) { b.addBeadForce(lane, bead, jacobian, force); });
  }
  void reserve(int border_count) {
    in([&](auto& b) { b.reserve(border_count); });
  }
  void clearBorder() {
    in([](auto& b) { b.clearBorder(); });
  }
  void addBorder(int lane, int column, int bead, const double jacobian[6]) {
    in([&](auto& b) { b.addBorder(lane, column, bead, jacobian); });
  }
  void eliminate() {
    in([](auto& b) { b.eliminate(); });
  }
  double borderBlock(int lane, int i, int j) const {
    return in([&](const auto& b) { return b.borderBlock(lane, i, j); });
  }
  double borderRight(int lane, int i) const {
    return in([&](const auto& b) { return b.borderRight(lane, i); });
  }
  const Matrix6& boneMass(int lane) const {
    return in([&](const auto& b) -> const Matrix6& { return b.boneMass(lane); });
  }
  const Vector6& boneMomentum(int lane) const {
    return in([&](const auto& b) -> const Vector6& { return b.boneMomentum(lane); });
  }
  Vector6 boneCoupling(int lane, int i) const {
    return in([&](const auto& b) { return b.boneCoupling(lane, i); });
  }
  Vector6 motion(int lane, int bead) const {
    return in([&](const auto& b) { return b.motion(lane, bead); });
  }
  void setBoneVelocity(int lane, const Vector6& u) {
    in([&](auto& b) { b.setBoneVelocity(lane, u); });
  }
  void setBorderForce(int lane, int column, double force) {
    in([&](auto& b) { b.setBorderForce(lane, column, force); });
  }
  void substitute() {
    in([](auto& b) { b.substitute(); });
  }
  double axisForce(int lane, int joint) const {
    return in([&](const auto& b) { return b.axisForce(lane, joint); });
  }
  double axisSlack(int lane, int joint) const {
    return in([&](const auto& b) { return b.axisSlack(lane, joint); });
  }
  double axisDiagonal(int lane, int joint) const {
    return in([&](const auto& b) { return b.axisDiagonal(lane, joint); });
  }
  Vector6 velocity(int lane, int bead) const {
    return in([&](const auto& b) { return b.velocity(lane, bead); });
  }
  double velocityAlong(int lane, int bead, const double jacobian[6]) const {
    return in([&](const auto& b) { return b.velocityAlong(lane, bead, jacobian); });
  }
  double largestVelocity() const {
    return in([](const auto& b) { return b.largestVelocity(); });
  }

 private:
  template <int lane_count>
  static std::array<int, lane_count> arrayOf(const std::vector<int>& bead_counts) {
    std::array<int, lane_count> counts = {};
    std::copy(bead_counts.begin(), bead_counts.end(), counts.begin());
    return counts;
  }

  Lanes lanes_;
};

}  // namespace musclesim::chain
