/// What is left when the chains are eliminated: the bones and the rows between them.
///
///     M_b u_b - sum_i J_i,b^T y_i = g_b       for every bone b: own mass and what the chains that end on it add
///     sum_b J_i,b u_b + sum_j D_ij y_j = r_i  for every core row i: start balls, skeleton joints, free contact rows
/// Bones couple only through rows, so M = block diagonal and  (D + J M^-1 J^T) y = r - J M^-1 g  is symmetric positive definite.
#pragma once

#include <vector>

#include "body_state.h"
#include "dense_cholesky.h"

namespace musclesim::chain {

class SkeletonCore {
 public:
  /// Starts a new system; everything is 0.
  void reset(int bone_count, int row_count);

  void addBone(int bone, const Matrix6& mass, const Vector6& momentum) {
    bones_[static_cast<std::size_t>(bone)].mass += mass;
    bones_[static_cast<std::size_t>(bone)].velocity += momentum;
  }
  void addMomentum(int bone, const Vector6& momentum) { bones_[static_cast<std::size_t>(bone)].velocity += momentum; }
  void addBlock(int row, int column, double value) { rows_.add(row, column, value); }
  void addRight(int row, double value) { force_[static_cast<std::size_t>(row)] += value; }
  /// Adds to J_row,bone; bone -1 does not move.
  void couple(int row, int bone, const double jacobian[6]);

  void solve();
  const Vector6& velocity(int bone) const { return bones_[static_cast<std::size_t>(bone)].velocity; }
  double force(int row) const { return force_[static_cast<std::size_t>(row)]; }

 private:
  /// Rows that act on a bone are numbered as they come; component i of row c stands at jacobian[i * stride + c].
  struct BoneSystem {
    Matrix6 mass;      ///< then its Cholesky factor L
    Vector6 velocity;  ///< first g, then u
    Vector6 reduced;   ///< L^-1 g
    std::vector<int> rows;
    std::vector<double> jacobian;  ///< J^T, then L^-1 J^T
  };
  void factorise(BoneSystem& bone) const;
  void reduce(BoneSystem& bone);
  void addProducts(const BoneSystem& bone);
  void substitute(BoneSystem& bone) const;

  std::vector<BoneSystem> bones_;
  int bone_count_ = 0;
  std::size_t stride_ = 0;        ///< of the bones' Jacobians
  std::vector<int> place_;        ///< of a row among a bone's rows, bone * stride + row; -1: it does not act there
  std::vector<double> products_;  ///< of one row with all rows before it
  DenseCholesky rows_;
  std::vector<double> force_;  ///< first r, then y
};

}  // namespace musclesim::chain
