#include "tiled_matrix.h"

#include <algorithm>

namespace musclesim::chain {

void TiledMatrix::reserve(int size) {
  const auto count = static_cast<std::size_t>((size + tile_width - 1) / tile_width);
  numbers_.reserve(count * count);
  entries_.reserve(tile_size * count * (count + 1) / 2);
  per_pivots_.reserve(tile_width * count);
  scaled_.reserve(tile_size * count);
  for (std::vector<int>* list : {&rows_, &column_tiles_}) list->reserve(count);
  targets_.reserve(count);
}

/// Fills the last tile with rows of the unit matrix.
void TiledMatrix::reset(int size) {
  size_ = size;
  tile_count_ = (size + tile_width - 1) / tile_width;
  used_ = 0;
  const auto count = static_cast<std::size_t>(tile_count_);
  numbers_.assign(count * count, -1);
  per_pivots_.resize(tile_width * count);
  scaled_.resize(tile_size * count);
  for (int i = 0; i < tile_count_; ++i) makeTile(i, i);
  for (int i = size; i < paddedSize(); ++i) at(i, i) = 1;
}

int TiledMatrix::addTile(int tile_row, int tile_column) {
  const auto end = static_cast<std::size_t>(used_ + 1) * tile_size;
  if (entries_.size() < end) entries_.resize(std::max(end, entries_.capacity()));
  clear(tile(used_), tile_size);
  return number(tile_row, tile_column) = used_++;
}

void TiledMatrix::listColumn(int tile_column) const {
  rows_.clear();
  column_tiles_.clear();
  for (int row = tile_column + 1; row < tile_count_; ++row)
    if (const int known = number(row, tile_column); known >= 0) {
      rows_.push_back(row);
      column_tiles_.push_back(known);
    }
}

/// Computes L and D of a tile column and subtracts L D L^T from the columns after it.
void TiledMatrix::eliminate(int tile_column) {
  double* per_pivots = per_pivots_.data() + tile_column * tile_width;
  double* diagonal = tile(number(tile_column, tile_column));
  factoriseTile(diagonal, per_pivots);
  listColumn(tile_column);
  const std::size_t count = rows_.size();
  for (std::size_t i = 0; i < count; ++i) solveTile(tile(column_tiles_[i]), scaled_.data() + i * tile_size, diagonal, per_pivots);
  for (std::size_t k = 0; k < count; ++k) {
    // makeTile() may move tiles in memory, so the pointers are taken after all tiles exist.
    for (std::size_t i = k; i < count; ++i) makeTile(rows_[i], rows_[k]);
    targets_.clear();
    for (std::size_t i = k; i < count; ++i) targets_.push_back(tile(number(rows_[i], rows_[k])));
    subtractTileProducts(targets_.data(), scaled_.data() + k * tile_size, tile(column_tiles_[k]), static_cast<int>(count - k));
  }
}

void TiledMatrix::factorise() {
  for (int column = 0; column < tile_count_; ++column) eliminate(column);
}

void TiledMatrix::solve(double* x) const {
  for (int i = size_; i < paddedSize(); ++i) x[i] = 0;
  for (int column = 0; column < tile_count_; ++column) {
    double* part = x + column * tile_width;
    solveLower(tile(number(column, column)), part);
    listColumn(column);
    for (std::size_t i = 0; i < rows_.size(); ++i) subtractProduct(x + rows_[i] * tile_width, tile(column_tiles_[i]), part);
  }
  for (int i = 0; i < paddedSize(); ++i) x[i] *= per_pivots_[static_cast<std::size_t>(i)];
  for (int column = tile_count_ - 1; column >= 0; --column) {
    double* part = x + column * tile_width;
    listColumn(column);
    for (std::size_t i = 0; i < rows_.size(); ++i) subtractTransposed(part, tile(column_tiles_[i]), x + rows_[i] * tile_width);
    solveUpper(tile(number(column, column)), part);
  }
}

}  // namespace musclesim::chain
