/// Numbers the core's rows in an elimination order that causes little fill-in.
///
/// The band is the set of rows that belong to chains: the ball joints at their starts and the contacts of their beads. Two chains are
/// neighbours if a contact acts on both. The chain with the fewest neighbours is always eliminated next; its remaining neighbours then
/// become neighbours of each other (minimum degree).
#pragma once

#include <vector>

namespace musclesim::chain {

class CoreOrder {
 public:
  /// Starts with chains that have no neighbours.
  void reset(int chain_count);
  void connect(int chain, int other);
  /// Computes the order. Call it after all connect() calls.
  void arrange();
  /// The chain that owns a row acting on two chains: the later of the two. Either may be -1 (none); returns -1 if both are.
  int ownerOf(int chain, int other) const;

  void clearRows();
  void addRows(int chain, int count) { row_count_[static_cast<std::size_t>(chain)] += count; }
  /// Gives every chain its row numbers. Call it after all addRows() calls.
  void number();
  /// Returns the chain's next unused row number.
  int takeRow(int chain) { return next_row_[static_cast<std::size_t>(chain)]++; }
  int rowCount() const { return total_; }

 private:
  std::size_t count() const { return place_.size(); }
  bool connected(int a, int b) const { return neighbours_[static_cast<std::size_t>(a) * count() + static_cast<std::size_t>(b)] != 0; }
  int leastConnected() const;
  void visit(int chain);

  std::vector<char> neighbours_;  ///< chain x chain
  std::vector<int> degree_;       ///< per chain: number of neighbours without a place so far
  std::vector<int> sequence_;     ///< chains in their order
  std::vector<int> place_;        ///< per chain: its place in the sequence, -1 before it is known
  std::vector<int> left_;         ///< remaining neighbours of the chain visited last
  std::vector<int> row_count_, next_row_;
  int total_ = 0;
};

}  // namespace musclesim::chain
