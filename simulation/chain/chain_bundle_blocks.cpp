/// The blocks A_k and A_k,k+1 of ChainBundle.
#include "chain_bundle.h"

namespace musclesim::chain {

/// Blocks of a slider, with J = (0 1; d t) and (0 -1; -d t), and of the hinge or ball joint after it, with J = (1 C; 0 e).
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::makeSliderBlocks(std::size_t k) {
  Node& node = nodes_[k];
  const auto& following = nodes_[k + 1].jacobian[0];
  const Pack per_inertia = node.present * per_inertia_;
  for (int row = 0; row < 3; ++row) {
    for (int other = 0; other < row; ++other) node.own[row][other] = all(0);
    node.own[row][row] = per_inertia + per_inertia + node.softness[row];
    for (int other = 0; other < 6; ++other) node.next[row][other] = -per_inertia * following[other][3 + row];
  }
  for (int row = 3; row < 6; ++row) {
    Pack scaled[6];
    for (int i = 0; i < 6; ++i) scaled[i] = inertia(i) * node.jacobian[0][row][i];
    for (int other = 0; other < 3; ++other) node.own[row][other] = all(0);
    for (int other = 3; other <= row; ++other) node.own[row][other] = 2.0 * dot(scaled, node.jacobian[0][other]);
    node.own[row][row] += node.softness[row];
    for (int i = 0; i < 3; ++i) scaled[i] = -scaled[i];
    for (int other = 0; other < 3; ++other) node.next[row][other] = plusTurn(scaled[other], scaled, following[other]);
    for (int other = 3; other < 6; ++other) node.next[row][other] = dotOf<false>(scaled, following[other]);
  }
}

/// Blocks of a hinge, with J = (1 C; 0 e) and (-1 D; 0 -e), and of the slider after it, with J = (0 1; d t).
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::makeHingeBlocks(std::size_t k) {
  Node& node = nodes_[k];
  const auto& following = nodes_[k + 1].jacobian[0];
  const Pack per_mass = node.present * per_mass_;
  for (int row = 0; row < 3; ++row) {
    Pack scaled[2][6];
    for (int body = 0; body < 2; ++body)
      for (int i = 3; i < 6; ++i) scaled[body][i] = per_inertia_ * node.jacobian[body][row][i];
    for (int other = 0; other <= row; ++other) {
      const Pack push = other == row ? per_mass : all(0);
      node.own[row][other] = plusTurn(push, scaled[0], node.jacobian[0][other]) + plusTurn(push, scaled[1], node.jacobian[1][other]);
    }
    node.own[row][row] += node.softness[row];
    for (int other = 0; other < 3; ++other) node.next[row][other] = scaled[1][3 + other];
    for (int other = 3; other < 6; ++other)
      node.next[row][other] = plusTurn(-per_mass * following[other][row], scaled[1], following[other]);
  }
  for (int row = 3; row < 6; ++row) {
    Pack scaled[6];
    for (int i = 3; i < 6; ++i) scaled[i] = per_inertia_ * node.jacobian[0][row][i];
    for (int other = 0; other < 3; ++other)
      node.own[row][other] = dotOf<false>(scaled, node.jacobian[0][other]) - dotOf<false>(scaled, node.jacobian[1][other]);
    for (int other = 3; other <= row; ++other) node.own[row][other] = 2.0 * dotOf<false>(scaled, node.jacobian[0][other]);
    node.own[row][row] += node.softness[row];
    for (int other = 0; other < 3; ++other) node.next[row][other] = -scaled[3 + other];
    for (int other = 3; other < 6; ++other) node.next[row][other] = -dotOf<false>(scaled, following[other]);
  }
}

/// Blocks of the ball joint, with J = (1 C; 0 0) on its bead. The bone B takes the place of a next node.
template <int lane_count>
MUSCLESIM_INLINE void ChainBundle<lane_count>::makeBallBlocks(std::size_t k) {
  Node& node = nodes_[k];
  const Pack per_mass = node.present * per_mass_;
  for (int row = 0; row < 6; ++row) {
    Pack scaled[6];
    for (int i = 3; i < 6; ++i) scaled[i] = per_inertia_ * node.jacobian[0][row][i];
    for (int other = 0; other <= row; ++other)
      node.own[row][other] = row < 3 ? plusTurn(other == row ? per_mass : all(0), scaled, node.jacobian[0][other]) : all(0);
    node.own[row][row] += node.softness[row];
    for (int i = 0; i < 6; ++i) node.next[row][i] = node.jacobian[1][row][i];
  }
}

template <int lane_count>
MUSCLESIM_SIMD void ChainBundle<lane_count>::makeAllBlocks() {
  const std::size_t last = nodes_.size() - 1;
  for (std::size_t k = 0; k < last; k += 2) {
    makeSliderBlocks(k);
    if (k + 1 < last) makeHingeBlocks(k + 1);
  }
  makeBallBlocks(last);
  for (std::size_t k = 0; k < nodes_.size(); ++k) axes_[k].diagonal = nodes_[k].own[5][5];
}

template <int lane_count>
void ChainBundle<lane_count>::makeBlocks() {
  makeAllBlocks();
}

template void ChainBundle<2>::makeAllBlocks();
template void ChainBundle<4>::makeAllBlocks();
template void ChainBundle<2>::makeBlocks();
template void ChainBundle<4>::makeBlocks();

}  // namespace musclesim::chain
