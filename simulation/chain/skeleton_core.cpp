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
  places_.resize(stride_);
  run_lengths_.resize(stride_);
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

namespace {

/// M = L L^T in place, for the rows and columns from `first` on.
template <int first>
void factoriseFrom(Matrix6& m) {
  for (int j = first; j < 6; ++j) {
    for (int k = first; k < j; ++k)
      for (int i = j; i < 6; ++i) m(i, j) -= m(i, k) * m(j, k);
    const double per_root = 1 / std::sqrt(m(j, j));
    for (int i = j; i < 6; ++i) m(i, j) *= per_root;
  }
}

}  // namespace

/// Where no chain ends on the bone, nothing couples its first three unknowns, and what is 0 is left out.
void SkeletonCore::factorise(BoneSystem& bone) {
  Matrix6& m = bone.mass;
  const bool alone = (m.bottomLeftCorner<3, 3>().array() == 0).all() && m(1, 0) == 0 && m(2, 0) == 0 && m(2, 1) == 0;
  bone.first_coupled = alone ? 3 : 0;
  if (!alone) return factoriseFrom<0>(m);
  for (int j = 0; j < 3; ++j) m(j, j) *= 1 / std::sqrt(m(j, j));
  factoriseFrom<3>(m);
}

/// Factors M and replaces J^T by L^-1 J^T, g by L^-1 g.
void SkeletonCore::reduce(BoneSystem& bone) {
  factorise(bone);
  for (int i = 0; i < 6; ++i) {
    double sum = bone.velocity[i];
    for (int j = bone.first_coupled; j < i; ++j) sum -= bone.mass(i, j) * bone.reduced[j];
    bone.reduced[i] = sum / bone.mass(i, i);
  }
  const std::size_t count = bone.rows.size();
  if (count == 0) return;
  for (int i = 0; i < 6; ++i) {
    double* __restrict target = bone.jacobian.data() + static_cast<std::size_t>(i) * stride_;
    for (int j = bone.first_coupled; j < i; ++j) {
      const double factor = bone.mass(i, j);
      const double* __restrict earlier = bone.jacobian.data() + static_cast<std::size_t>(j) * stride_;
      for (std::size_t c = 0; c < count; ++c) target[c] -= factor * earlier[c];
    }
    const double per_pivot = 1 / bone.mass(i, i);
    for (std::size_t c = 0; c < count; ++c) target[c] *= per_pivot;
  }
  addProducts(bone);
}

/// Where each of the bone's rows stands in the matrix, and how many in a row stand one behind the other from there.
void SkeletonCore::listRuns(const BoneSystem& bone) {
  const std::size_t count = bone.rows.size();
  for (std::size_t c = count; c-- > 0;) {
    places_[c] = place(bone.rows[c]);
    run_lengths_[c] = c + 1 < count && places_[c + 1] == places_[c] + 1 ? run_lengths_[c + 1] + 1 : 1;
  }
}

/// D += J M^-1 J^T,  r -= J M^-1 g
void SkeletonCore::addProducts(const BoneSystem& bone) {
  listRuns(bone);
  const double* y[6];
  for (std::size_t i = 0; i < 6; ++i) y[i] = bone.jacobian.data() + i * stride_;
  const int count = static_cast<int>(bone.rows.size());
  for (int c = 0; c < count; ++c) {
    double f[6], right = 0;
    for (int i = 0; i < 6; ++i) {
      f[i] = y[i][c];
      right += f[i] * bone.reduced[i];
    }
    const double* behind[6];
    for (int i = 0; i < 6; ++i) behind[i] = y[i] + c;
    combineSixRows(products_.data(), behind, f, count - c);
    const int row = places_[static_cast<std::size_t>(c)];
    solution_[static_cast<std::size_t>(row)] -= right;
    for (int d = c; d < count;) {
      const auto at = static_cast<std::size_t>(d);
      matrix_.addRun(row, places_[at], products_.data() + d - c, run_lengths_[at]);
      d += run_lengths_[at];
    }
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
