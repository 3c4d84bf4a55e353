#include "skeleton_core.h"

#include <algorithm>
#include <cmath>

#include "wide.h"

namespace musclesim::chain {

void SkeletonCore::reset(int bone_count, int row_count) {
  const auto bones = static_cast<std::size_t>(bone_count), rows = static_cast<std::size_t>(row_count);
  bone_count_ = bone_count;
  if (stride_ < rows || bones_.size() < bones) {
    stride_ = std::max(stride_, rows * 3 / 2 / 2 * 2 + 8);
    bones_.resize(std::max(bones_.size(), bones));
    place_.resize(bones_.size() * stride_);
    products_.resize(stride_);
    force_.resize(stride_);
    for (BoneSystem& bone : bones_) {
      bone.rows.reserve(stride_);
      bone.jacobian.resize(6 * stride_);
    }
  }
  for (BoneSystem& bone : bones_) {
    bone.mass.setZero();
    bone.velocity.setZero();
    bone.rows.clear();
  }
  rows_.reset(row_count);
  std::fill_n(force_.begin(), rows, 0.0);
  for (std::size_t bone = 0; bone < bones; ++bone) std::fill_n(place_.begin() + static_cast<std::ptrdiff_t>(bone * stride_), rows, -1);
}

void SkeletonCore::couple(int row, int bone, const double jacobian[6]) {
  if (bone < 0) return;
  BoneSystem& system = bones_[static_cast<std::size_t>(bone)];
  int& place = place_[static_cast<std::size_t>(bone) * stride_ + static_cast<std::size_t>(row)];
  const bool is_new = place < 0;
  if (is_new) {
    place = static_cast<int>(system.rows.size());
    system.rows.push_back(row);
  }
  double* target = system.jacobian.data() + place;
  for (std::size_t i = 0; i < 6; ++i) target[i * stride_] = jacobian[i] + (is_new ? 0 : target[i * stride_]);
}

/// M = L L^T in place.
void SkeletonCore::factorise(BoneSystem& bone) const {
  Matrix6& m = bone.mass;
  for (int j = 0; j < 6; ++j) {
    for (int k = 0; k < j; ++k)
      for (int i = j; i < 6; ++i) m(i, j) -= m(i, k) * m(j, k);
    const double root = std::sqrt(m(j, j));
    for (int i = j; i < 6; ++i) m(i, j) /= root;
  }
}

/// Factors M and replaces J^T by L^-1 J^T, g by L^-1 g.
void SkeletonCore::reduce(BoneSystem& bone) {
  factorise(bone);
  const std::size_t count = bone.rows.size();
  for (std::size_t i = 0; i < 6; ++i) {
    double* __restrict target = bone.jacobian.data() + i * stride_;
    const auto row = static_cast<Eigen::Index>(i);
    bone.reduced[row] = bone.velocity[row];
    for (std::size_t j = 0; j < i; ++j) {
      const double factor = bone.mass(row, static_cast<Eigen::Index>(j));
      const double* __restrict earlier = bone.jacobian.data() + j * stride_;
      for (std::size_t c = 0; c < count; ++c) target[c] -= factor * earlier[c];
      bone.reduced[row] -= factor * bone.reduced[static_cast<Eigen::Index>(j)];
    }
    const double per_pivot = 1 / bone.mass(row, row);
    for (std::size_t c = 0; c < count; ++c) target[c] *= per_pivot;
    bone.reduced[row] *= per_pivot;
  }
  addProducts(bone);
}

/// D += J M^-1 J^T,  r -= J M^-1 g
void SkeletonCore::addProducts(const BoneSystem& bone) {
  const double* y[6];
  for (std::size_t i = 0; i < 6; ++i) y[i] = bone.jacobian.data() + i * stride_;
  double* products = products_.data();
  for (std::size_t c = 0; c < bone.rows.size(); ++c) {
    double f[6], right = 0;
    for (int i = 0; i < 6; ++i) {
      f[i] = y[i][c];
      right += f[i] * bone.reduced[i];
    }
    combineSixRows(products, y, f, static_cast<int>(c) + 1);
    const int row = bone.rows[c];
    force_[static_cast<std::size_t>(row)] -= right;
    for (std::size_t d = 0; d <= c; ++d) rows_.add(row, bone.rows[d], products[d]);
  }
}

/// u = M^-1 (g + J^T y)
void SkeletonCore::substitute(BoneSystem& bone) const {
  Vector6 y = bone.reduced;
  for (std::size_t c = 0; c < bone.rows.size(); ++c) {
    const double force = force_[static_cast<std::size_t>(bone.rows[c])];
    for (std::size_t i = 0; i < 6; ++i) y[static_cast<Eigen::Index>(i)] += bone.jacobian[i * stride_ + c] * force;
  }
  for (int i = 5; i >= 0; --i) {
    double sum = y[i];
    for (int j = i + 1; j < 6; ++j) sum -= bone.mass(j, i) * bone.velocity[j];
    bone.velocity[i] = sum / bone.mass(i, i);
  }
}

void SkeletonCore::solve() {
  for (int b = 0; b < bone_count_; ++b) reduce(bones_[static_cast<std::size_t>(b)]);
  rows_.factorise();
  rows_.solve(force_.data());
  for (int b = 0; b < bone_count_; ++b) substitute(bones_[static_cast<std::size_t>(b)]);
}

}  // namespace musclesim::chain
