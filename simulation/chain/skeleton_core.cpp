#include "skeleton_core.h"

#include <algorithm>
#include <cmath>

#include "wide.h"

namespace musclesim::chain {

void SkeletonCore::reserve(std::size_t bones, std::size_t rows) {
  if (stride_ >= rows && bones_.size() >= bones) return;
  stride_ = std::max(stride_, rows * 3 / 2 / 2 * 2 + 8);
  bones_.resize(std::max(bones_.size(), bones));
  place_.resize(bones_.size() * stride_);
  products_.resize(stride_);
  const std::size_t unknowns = stride_ + 6 * bones_.size();
  solution_.resize(unknowns + tile_width);
  matrix_.reserve(static_cast<int>(unknowns));
  for (BoneSystem& bone : bones_) {
    bone.rows.reserve(stride_);
    bone.jacobian.resize(6 * stride_);
  }
}

void SkeletonCore::reset(int bone_count, int row_count) {
  Layout layout;
  layout.row_count = row_count;
  layout.kept.resize(static_cast<std::size_t>(bone_count));
  reset(layout);
}

void SkeletonCore::reset(const Layout& layout) {
  const auto bones = layout.kept.size(), rows = static_cast<std::size_t>(layout.row_count);
  bone_count_ = static_cast<int>(bones);
  reserve(bones, rows);
  kept_unknowns_ = 0;
  for (std::size_t b = 0; b < bones; ++b) {
    BoneSystem& bone = bones_[b];
    bone.mass.setZero();
    bone.velocity.setZero();
    bone.rows.clear();
    bone.kept_place = layout.kept[b] ? layout.band + kept_unknowns_ : -1;
    if (layout.kept[b]) kept_unknowns_ += 6;
    if (!layout.kept[b]) std::fill_n(place_.begin() + static_cast<std::ptrdiff_t>(b * stride_), rows, -1);
  }
  band_ = layout.band;
  matrix_.reset(layout.row_count + kept_unknowns_);
  std::fill_n(solution_.begin(), matrix_.paddedSize(), 0.0);
}

void SkeletonCore::addBone(int bone, const Matrix6& mass, const Vector6& momentum) {
  bones_[static_cast<std::size_t>(bone)].mass += mass;
  bones_[static_cast<std::size_t>(bone)].velocity += momentum;
}

void SkeletonCore::couple(int row, int bone, const double jacobian[6]) {
  if (bone < 0) return;
  BoneSystem& system = bones_[static_cast<std::size_t>(bone)];
  if (system.kept_place >= 0) {
    matrix_.addRun(place(row), system.kept_place, jacobian, 6);
    return;
  }
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
    const double per_root = 1 / std::sqrt(m(j, j));
    for (int i = j; i < 6; ++i) m(i, j) *= per_root;
  }
}

/// Factors M and replaces J^T by L^-1 J^T, g by L^-1 g.
void SkeletonCore::reduce(BoneSystem& bone) {
  factorise(bone);
  for (int i = 0; i < 6; ++i) {
    double sum = bone.velocity[i];
    for (int j = 0; j < i; ++j) sum -= bone.mass(i, j) * bone.reduced[j];
    bone.reduced[i] = sum / bone.mass(i, i);
  }
  const std::size_t count = bone.rows.size();
  if (count == 0) return;
  for (std::size_t i = 0; i < 6; ++i) {
    double* __restrict target = bone.jacobian.data() + i * stride_;
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < i; ++j) {
      const double factor = bone.mass(row, static_cast<Eigen::Index>(j));
      const double* __restrict earlier = bone.jacobian.data() + j * stride_;
      for (std::size_t c = 0; c < count; ++c) target[c] -= factor * earlier[c];
    }
    const double per_pivot = 1 / bone.mass(row, row);
    for (std::size_t c = 0; c < count; ++c) target[c] *= per_pivot;
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
    addRight(row, -right);
    for (std::size_t d = 0; d <= c; ++d) addBlock(row, bone.rows[d], products[d]);
  }
}

/// -M and -g of a kept bone.
void SkeletonCore::enter(const BoneSystem& bone) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) matrix_.add(bone.kept_place + i, bone.kept_place + j, -bone.mass(i, j));
    solution_[static_cast<std::size_t>(bone.kept_place + i)] = -bone.velocity[i];
  }
}

/// u = M^-1 (g + J^T y)
void SkeletonCore::substitute(BoneSystem& bone) const {
  if (bone.kept_place >= 0) {
    bone.velocity = Eigen::Map<const Vector6>(solution_.data() + bone.kept_place);
    return;
  }
  Vector6 y = bone.reduced;
  for (std::size_t c = 0; c < bone.rows.size(); ++c) {
    const double pull = force(bone.rows[c]);
    for (std::size_t i = 0; i < 6; ++i) y[static_cast<Eigen::Index>(i)] += bone.jacobian[i * stride_ + c] * pull;
  }
  for (int i = 5; i >= 0; --i) {
    double sum = y[i];
    for (int j = i + 1; j < 6; ++j) sum -= bone.mass(j, i) * bone.velocity[j];
    bone.velocity[i] = sum / bone.mass(i, i);
  }
}

void SkeletonCore::solve() {
  for (int b = 0; b < bone_count_; ++b) {
    BoneSystem& bone = bones_[static_cast<std::size_t>(b)];
    bone.kept_place >= 0 ? enter(bone) : reduce(bone);
  }
  matrix_.factorise();
  matrix_.solve(solution_.data());
  for (int b = 0; b < bone_count_; ++b) substitute(bones_[static_cast<std::size_t>(b)]);
}

}  // namespace musclesim::chain
