/// The core: the system of bones and rows that remains after the chains are eliminated.
///
///     M_b u_b - sum_i J_i,b^T y_i = g_b       for every bone b; M_b, g_b include what the chains that end on b add
///     sum_b J_i,b u_b + sum_j D_ij y_j = r_i  for every core row i: start balls, skeleton joints, free contact rows
/// Bones couple only through rows. A bone on which few rows act is eliminated first: D += J_b M_b^-1 J_b^T, r -= J_b M_b^-1 g_b. This
/// couples all rows that act on the bone with each other. A bone on which many rows act is kept as six unknowns, because most of these rows
/// are not coupled otherwise. The remaining system is quasi-definite,
///     [D  J; J^T  -M] (y, u) = (r, -g),
/// and is factored in this order: rows of the band, kept bones, further rows.
#pragma once

#include <span>
#include <vector>

#include "body_state.h"
#include "tiled_matrix.h"

namespace musclesim::chain {

class SkeletonCore {
 public:
  /// Rows 0 .. band - 1 are the band; the further rows follow.
  struct Layout {
    int row_count = 0, band = 0;
    std::vector<char> kept;  ///< per bone: whether it is kept, that is, not eliminated first
  };
  /// Starts a new system in which all entries are 0. Call setBone() or keepVelocity() for every bone.
  void reset(const Layout& layout);
  /// Starts a new system without a band and without kept bones.
  void reset(int bone_count, int row_count);

  /// Keeps the bone's velocity of the previous system; no row acts on the bone.
  void keepVelocity(int bone) { bones_[static_cast<std::size_t>(bone)].known = true; }
  void setBone(int bone, const Matrix6& mass, const Vector6& momentum);
  void addBone(int bone, const Matrix6& mass, const Vector6& momentum);
  void addMomentum(int bone, const Vector6& momentum) { bones_[static_cast<std::size_t>(bone)].velocity += momentum; }
  void addBlock(int row, int column, double value) { matrix_.add(place(row), place(column), value); }
  void addRight(int row, double value) { solution_[static_cast<std::size_t>(place(row))] += value; }
  /// Adds `count` rows of six numbers to J of consecutive core rows. Either all these rows are in the band or none is. Bone -1 does not
  /// move.
  void couple(int first_row, int count, int bone, const double* jacobian);

  void solve();
  const Vector6& velocity(int bone) const { return bones_[static_cast<std::size_t>(bone)].velocity; }
  double force(int row) const { return solution_[static_cast<std::size_t>(place(row))]; }

 private:
  /// The rows of one matrix tile that act on a bone.
  struct TileRows {
    int tile;
    unsigned present;                ///< bit i: row i of the tile acts on the bone
    double jacobian[6][tile_width];  ///< J^T, then L^-1 J^T; 0 for rows that do not act on the bone
  };
  struct BoneSystem {
    bool known = false;   ///< u is known
    int kept_place = -1;  ///< index of a kept bone's first unknown
    Matrix6 mass;         ///< after factorise(): its Cholesky factor L below the diagonal
    double per_pivot[6];  ///< 1 / diagonal of L
    int first_coupled;    ///< 0 or 3: columns before it have no off-diagonal entries in M and L
    Vector6 velocity;     ///< first g, then u
    Vector6 reduced;      ///< L^-1 g
    std::size_t tile_count = 0;
    std::vector<TileRows> tiles;  ///< the first tile_count entries are in use
    std::span<TileRows> rows() { return {tiles.data(), tile_count}; }
    std::span<const TileRows> rows() const { return {tiles.data(), tile_count}; }
  };
  int place(int row) const { return row < band_ ? row : row + kept_unknowns_; }
  void reserve(std::size_t bones, std::size_t unknowns);
  TileRows& rowsOfTile(BoneSystem& system, int bone, int tile);
  static void factorise(BoneSystem& bone);
  void reduce(BoneSystem& bone);
  void addProducts(const BoneSystem& bone);
  void enter(const BoneSystem& bone);
  void substitute(BoneSystem& bone) const;

  int band_ = 0, kept_unknowns_ = 0;
  std::vector<BoneSystem> bones_;
  int bone_count_ = 0;
  std::size_t most_tiles_ = 0;   ///< most tiles that the rows of a bone can touch
  std::vector<int> tile_place_;  ///< [bone * most_tiles + tile]: index of the tile in the bone's tiles; -1 if no row of it acts on the bone
  TiledMatrix matrix_;
  std::vector<double> solution_;  ///< first (r, -g), then (y, u); filled up to whole tiles
};

}  // namespace musclesim::chain
