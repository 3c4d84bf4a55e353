#include "skeleton_core.h"

#include <algorithm>
#include <cmath>

namespace musclesim::chain {

namespace {

/// y <- L^-1 y
inline void forward(const Matrix6& l, double y[6]) {
  for (int i = 0; i < 6; ++i) {
    double sum = y[i];
    for (int j = 0; j < i; ++j) sum -= l(i, j) * y[j];
    y[i] = sum / l(i, i);
  }
}

}  // namespace

void SkeletonCore::reset(int bone_count, int row_count) {
  bone_count_ = bone_count;
  if (bones_.size() < static_cast<std::size_t>(bone_count)) bones_.resize(static_cast<std::size_t>(bone_count));
  for (BoneSystem& bone : bones_) {
    bone.mass.setZero();
    bone.velocity.setZero();
    bone.couplings.clear();
  }
  rows_.reset(row_count);
  if (force_.size() < static_cast<std::size_t>(row_count)) force_.resize(static_cast<std::size_t>(row_count) * 5 / 4);
  std::fill(force_.begin(), force_.end(), 0.0);
}

void SkeletonCore::couple(int row, int bone, const double jacobian[6]) {
  if (bone < 0) return;
  auto& couplings = bones_[static_cast<std::size_t>(bone)].couplings;
  auto place = std::find_if(couplings.rbegin(), couplings.rend(), [&](const Coupling& c) { return c.row == row; });
  if (place == couplings.rend()) {
    couplings.push_back({row, {}, {}});
    place = couplings.rbegin();
  }
  for (int i = 0; i < 6; ++i) place->jacobian[i] += jacobian[i];
}

void SkeletonCore::factorise(BoneSystem& bone) {
  Matrix6& m = bone.mass;
  for (int j = 0; j < 6; ++j) {
    for (int k = 0; k < j; ++k)
      for (int i = j; i < 6; ++i) m(i, j) -= m(i, k) * m(j, k);
    const double root = std::sqrt(m(j, j));
    for (int i = j; i < 6; ++i) m(i, j) /= root;
  }
}

/// D += J M^-1 J^T,  r -= J M^-1 g
void SkeletonCore::reduce(BoneSystem& bone) {
  factorise(bone);
  std::copy_n(bone.velocity.data(), 6, bone.reduced);
  forward(bone.mass, bone.reduced);
  for (std::size_t c = 0; c < bone.couplings.size(); ++c) {
    Coupling& own = bone.couplings[c];
    std::copy_n(own.jacobian, 6, own.reduced);
    forward(bone.mass, own.reduced);
    double right = 0;
    for (int i = 0; i < 6; ++i) right += own.reduced[i] * bone.reduced[i];
    force_[static_cast<std::size_t>(own.row)] -= right;
    for (std::size_t d = 0; d <= c; ++d) {
      const Coupling& other = bone.couplings[d];
      double product = 0;
      for (int i = 0; i < 6; ++i) product += own.reduced[i] * other.reduced[i];
      rows_.add(own.row, other.row, product);
    }
  }
}

/// u = M^-1 (g + J^T y)
void SkeletonCore::substitute(BoneSystem& bone) const {
  double y[6];
  std::copy_n(bone.reduced, 6, y);
  for (const Coupling& c : bone.couplings)
    for (int i = 0; i < 6; ++i) y[i] += c.reduced[i] * force_[static_cast<std::size_t>(c.row)];
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
