/// What is left when the chains are eliminated: the bones and the rows between them.
///
///     M_b u_b - sum_i J_i,b^T y_i = g_b       for every bone b: own mass and what the chains that end on it add
///     sum_b J_i,b u_b + sum_j D_ij y_j = r_i  for every core row i: start balls, skeleton joints, free contact rows
/// Bones couple only through rows. A bone on which few rows act is eliminated first: D += J_b M_b^-1 J_b^T, r -= J_b M_b^-1 g_b. It
/// connects all rows that act on it. A bone on which many rows act is kept as six unknowns, because they mostly have nothing else in
/// common. What remains is quasi-definite,
///     [D  J; J^T  -M] (y, u) = (r, -g),
/// and is factored in the order: rows of the band, kept bones, further rows.
#pragma once

#include <span>
#include <vector>

#include "body_state.h"
#include "tiled_matrix.h"

namespace musclesim::chain {

class SkeletonCore {
 public:
  /// Rows are numbered 0 .. band - 1 (the band), then the further rows.
  struct Layout {
    int row_count = 0, band = 0;
    std::vector<char> kept;  ///< of every bone: it is not eliminated first
  };
  /// Starts a new system; everything is 0 but the bones, each of which must be set or keep its velocity.
  void reset(const Layout& layout);
  /// The same without a band and kept bones.
  void reset(int bone_count, int row_count);

  /// No row acts on the bone, and it moves as it did in the system before.
  void keepVelocity(int bone) { bones_[static_cast<std::size_t>(bone)].known = true; }
  void setBone(int bone, const Matrix6& mass, const Vector6& momentum);
  void addBone(int bone, const Matrix6& mass, const Vector6& momentum);
  void addMomentum(int bone, const Vector6& momentum) { bones_[static_cast<std::size_t>(bone)].velocity += momentum; }
  void addBlock(int row, int column, double value) { matrix_.add(place(row), place(column), value); }
  void addRight(int row, double value) { solution_[static_cast<std::size_t>(place(row))] += value; }
  /// Adds rows of six numbers to J of so many core rows, all of the band or none; bone -1 does not move.
  void couple(int first_row, int count, int bone, const double* jacobian);

  void solve();
  const Vector6& velocity(int bone) const { return bones_[static_cast<std::size_t>(bone)].velocity; }
  double force(int row) const { return solution_[static_cast<std::size_t>(place(row))]; }

 private:
  /// Of the rows that act on a bone, those of one of the matrix's tiles.
  struct TileRows {
    int tile;
    unsigned present;                ///< bit i: row i of the tile acts on the bone
    double jacobian[6][tile_width];  ///< J^T, then L^-1 J^T; 0 for others
  };
  struct BoneSystem {
    bool known = false;   ///< u is known
    int kept_place = -1;  ///< where a kept bone's six unknowns stand
    Matrix6 mass;         ///< then, below the diagonal, its Cholesky factor L
    double per_pivot[6];  ///< 1 / diagonal of L
    int first_coupled;    ///< 0 or 3: columns before it stand alone in M and L
    Vector6 velocity;     ///< first g, then u
    Vector6 reduced;      ///< L^-1 g
    std::size_t tile_count = 0;
    std::vector<TileRows> tiles;  ///< of them as many as there are tiles with rows that act on the bone
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
  std::size_t most_tiles_ = 0;   ///< of a bone's rows
  std::vector<int> tile_place_;  ///< of a tile among a bone's, bone * most_tiles + tile; -1: no row of it acts there
  TiledMatrix matrix_;
  std::vector<double> solution_;  ///< first (r, -g), then (y, u); filled up to whole tiles
};

}  // namespace musclesim::chain
