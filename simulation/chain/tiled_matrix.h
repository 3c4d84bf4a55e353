/// Sparse symmetric systems of about ten to several hundred rows.
///
/// The lower part is divided into tiles of eight by eight entries; only tiles with non-zero entries are stored. A = L D L^T is computed
/// without pivoting. For a quasi-definite matrix (one diagonal block positive definite, the other negative definite) this factorisation
/// exists in any order of the rows; the order decides how many tiles are filled in.
#pragma once

#include <algorithm>
#include <vector>

#include "simd_kernels.h"

namespace musclesim::chain {

class TiledMatrix {
 public:
  /// Allocates memory for `size` rows.
  void reserve(int size);
  /// Sets all entries to 0.
  void reset(int size);
  int size() const { return size_; }
  /// Adds to an entry and its mirror image, which share one place in memory.
  void add(int row, int column, double value) { row >= column ? at(row, column) += value : at(column, row) += value; }

  /// Adds to the entries (index, first), (index, first + 1), ..., which must all be on one side of the diagonal.
  void addRun(int index, int first, const double* values, int count) {
    for (int i = 0; i < count;) {
      const int end = std::min(count, (first + i) / tile_width * tile_width + tile_width - first);
      const bool in_row = index > first;
      double* entry = in_row ? &at(index, first + i) : &at(first + i, index);
      for (; i < end; ++i, entry += in_row ? tile_width : 1) *entry += values[i];
    }
  }

  /// Adds left^T right to a tile. Bit i of `columns` is set where column i of `right` is not 0.
  void addProducts(int tile_row, int tile_column, const double left[6][tile_width], const double right[6][tile_width], unsigned columns) {
    addTileProducts(tile(makeTile(tile_row, tile_column)), left, right, columns);
  }

  void factorise();
  /// x <- A^-1 x, after factorise(). x must have paddedSize() entries; solve() overwrites the entries beyond size().
  void solve(double* x) const;
  int paddedSize() const { return tile_width * tile_count_; }
  /// Number of stored tiles.
  int tileCount() const { return used_; }

 private:
  /// An entry of the lower part; creates its tile if necessary.
  double& at(int row, int column) {
    const auto r = static_cast<unsigned>(row), c = static_cast<unsigned>(column);
    return tile(makeTile(static_cast<int>(r / tile_width), static_cast<int>(c / tile_width)))[c % tile_width * tile_width + r % tile_width];
  }
  int& number(int tile_row, int tile_column) { return numbers_[static_cast<std::size_t>(tile_column * tile_count_ + tile_row)]; }
  int number(int tile_row, int tile_column) const { return numbers_[static_cast<std::size_t>(tile_column * tile_count_ + tile_row)]; }
  int makeTile(int tile_row, int tile_column) {
    const int known = number(tile_row, tile_column);
    return known >= 0 ? known : addTile(tile_row, tile_column);
  }
  int addTile(int tile_row, int tile_column);
  double* tile(int number) { return entries_.data() + static_cast<std::size_t>(number) * tile_size; }
  const double* tile(int number) const { return entries_.data() + static_cast<std::size_t>(number) * tile_size; }
  void listColumn(int tile_column) const;
  void eliminate(int tile_column);

  int size_ = 0, tile_count_ = 0, used_ = 0;
  std::vector<int> numbers_;               ///< index of each tile, by tile column, then tile row; -1 if the tile is not stored
  std::vector<double> entries_;            ///< the tiles one after another, each in column-major order
  std::vector<double> per_pivots_;         ///< reciprocals of D
  std::vector<double> scaled_;             ///< L D of one tile column
  mutable std::vector<int> rows_;          ///< tile rows below the diagonal of one tile column
  mutable std::vector<int> column_tiles_;  ///< their tiles
  std::vector<double*> targets_;
};

}  // namespace musclesim::chain
