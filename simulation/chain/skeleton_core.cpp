#include "skeleton_core.h"

#include <algorithm>
#include <cmath>

#include "simd_kernels.h"

namespace musclesim::chain {

void SkeletonCore::reserve(std::size_t bones, std::size_t unknowns) {
  if (most_tiles_ * tile_width >= unknowns && bones_.size() >= bones) return;
  most_tiles_ = std::max(most_tiles_, unknowns * 3 / 2 / tile_width + 1);
  bones_.resize(std::max(bones_.size(), bones));
  tile_place_.resize(bones_.size() * most_tiles_);
  solution_.resize(most_tiles_ * tile_width);
  matrix_.reserve(static_cast<int>(solution_.size()));
  for (BoneSystem& bone : bones_) bone.tiles.resize(most_tiles_);
}

void SkeletonCore::reset(int bone_count, int row_count) {
  Layout layout;
  layout.row_count = row_count;
  layout.kept.resize(static_cast<std::size_t>(bone_count));
  reset(layout);
}

void SkeletonCore::reset(const Layout& layout) {
  const auto bones = layout.kept.size();
  bone_count_ = static_cast<int>(bones);
  kept_unknowns_ = 6 * static_cast<int>(std::count_if(layout.kept.begin(), layout.kept.end(), [](char kept) { return kept != 0; }));
  reserve(bones, static_cast<std::size_t>(layout.row_count + kept_unknowns_));
  band_ = layout.band;
  int next_kept = band_;
  for (std::size_t b = 0; b < bones; ++b) {
    BoneSystem& bone = bones_[b];
    bone.known = false;
    bone.tile_count = 0;
    bone.kept_place = layout.kept[b] ? next_kept : -1;
    if (layout.kept[b]) next_kept += 6;
  }
  matrix_.reset(layout.row_count + kept_unknowns_);
  std::fill_n(tile_place_.begin(), bones * most_tiles_, -1);
  std::fill_n(solution_.begin(), matrix_.paddedSize(), 0.0);
}

void SkeletonCore::setBone(int bone, const Matrix6& mass, const Vector6& momentum) {
  bones_[static_cast<std::size_t>(bone)].mass = mass;
  bones_[static_cast<std::size_t>(bone)].velocity = momentum;
}

void SkeletonCore::addBone(int bone, const Matrix6& mass, const Vector6& momentum) {
  bones_[static_cast<std::size_t>(bone)].mass += mass;
  bones_[static_cast<std::size_t>(bone)].velocity += momentum;
}

void SkeletonCore::couple(int first_row, int count, int bone, const double* jacobian) {
  if (bone < 0) return;
  BoneSystem& system = bones_[static_cast<std::size_t>(bone)];
  if (system.kept_place >= 0) {
    for (int row = 0; row < count; ++row) matrix_.addRun(place(first_row + row), system.kept_place, jacobian + 6 * row, 6);
    return;
  }
  for (int row = 0; row < count;) {
    const auto at = static_cast<unsigned>(place(first_row + row));
    TileRows& rows = rowsOfTile(system, bone, static_cast<int>(at / tile_width));
    for (unsigned column = at % tile_width; row < count && column < tile_width; ++row, ++column) {
      rows.present |= 1U << column;
      for (int i = 0; i < 6; ++i) rows.jacobian[i][column] += jacobian[6 * row + i];
    }
  }
}

SkeletonCore::TileRows& SkeletonCore::rowsOfTile(BoneSystem& system, int bone, int tile) {
  int& known = tile_place_[static_cast<std::size_t>(bone) * most_tiles_ + static_cast<std::size_t>(tile)];
  if (known < 0) {
    known = static_cast<int>(system.tile_count++);
    TileRows& added = system.tiles[static_cast<std::size_t>(known)];
    added.tile = tile;
    added.present = 0;
    clear(added.jacobian[0], 6 * tile_width);
  }
  return system.tiles[static_cast<std::size_t>(known)];
}

namespace {

/// Factorises M = L L^T in place, starting at row and column `first`.
template <int first>
void factoriseFrom(Matrix6& m, double per_pivot[6]) {
  for (int j = first; j < 6; ++j) {
    for (int k = first; k < j; ++k)
      for (int i = j; i < 6; ++i) m(i, j) -= m(i, k) * m(j, k);
    per_pivot[j] = 1 / std::sqrt(m(j, j));
    for (int i = j; i < 6; ++i) m(i, j) *= per_pivot[j];
  }
}

/// x <- L^-1 x
template <int first>
void solveLowerFrom(const Matrix6& l, const double per_pivot[6], Vector6& x) {
  for (int i = 0; i < 6; ++i) {
    for (int j = first; j < i; ++j) x[i] -= l(i, j) * x[j];
    x[i] *= per_pivot[i];
  }
}

/// x <- L^-T x
template <int first>
void solveUpperFrom(const Matrix6& l, const double per_pivot[6], Vector6& x) {
  for (int i = 5; i >= 0; --i) {
    for (int j = i + 1; j < 6 && i >= first; ++j) x[i] -= l(j, i) * x[j];
    x[i] *= per_pivot[i];
  }
}

}  // namespace

/// If no chain ends on the bone, its first three unknowns are not coupled, and the factorisation skips the zeros.
void SkeletonCore::factorise(BoneSystem& bone) {
  Matrix6& m = bone.mass;
  const bool alone = (m.bottomLeftCorner<3, 3>().array() == 0).all() && m(1, 0) == 0 && m(2, 0) == 0 && m(2, 1) == 0;
  bone.first_coupled = alone ? 3 : 0;
  if (!alone) return factoriseFrom<0>(m, bone.per_pivot);
  for (int j = 0; j < 3; ++j) bone.per_pivot[j] = 1 / std::sqrt(m(j, j));
  factoriseFrom<3>(m, bone.per_pivot);
}

/// Factorises M and replaces J^T by L^-1 J^T and g by L^-1 g.
void SkeletonCore::reduce(BoneSystem& bone) {
  factorise(bone);
  bone.reduced = bone.velocity;
  (bone.first_coupled > 0 ? solveLowerFrom<3> : solveLowerFrom<0>)(bone.mass, bone.per_pivot, bone.reduced);
  for (TileRows& rows : bone.rows()) solveSixRows(rows.jacobian, bone.mass.data(), bone.per_pivot, bone.first_coupled);
  addProducts(bone);
}

/// D += J M^-1 J^T,  r -= J M^-1 g
void SkeletonCore::addProducts(const BoneSystem& bone) {
  for (const TileRows& rows : bone.rows()) {
    subtractCombination(solution_.data() + rows.tile * tile_width, rows.jacobian, bone.reduced.data());
    for (const TileRows& others : bone.rows())
      if (others.tile <= rows.tile) matrix_.addProducts(rows.tile, others.tile, rows.jacobian, others.jacobian, others.present);
  }
}

/// Enters -M and -g of a kept bone into the matrix and the right-hand side.
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
  bone.velocity = bone.reduced;
  for (const TileRows& rows : bone.rows()) addProduct(bone.velocity.data(), rows.jacobian, solution_.data() + rows.tile * tile_width);
  (bone.first_coupled > 0 ? solveUpperFrom<3> : solveUpperFrom<0>)(bone.mass, bone.per_pivot, bone.velocity);
}

void SkeletonCore::solve() {
  for (int b = 0; b < bone_count_; ++b) {
    BoneSystem& bone = bones_[static_cast<std::size_t>(b)];
    if (!bone.known) bone.kept_place >= 0 ? enter(bone) : reduce(bone);
  }
  matrix_.factorise();
  matrix_.solve(solution_.data());
  for (int b = 0; b < bone_count_; ++b)
    if (!bones_[static_cast<std::size_t>(b)].known) substitute(bones_[static_cast<std::size_t>(b)]);
}

}  // namespace musclesim::chain
