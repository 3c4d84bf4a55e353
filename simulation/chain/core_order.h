/// The order in which the core's rows are eliminated, so that little is filled in, and their numbers.
///
/// Rows that belong to chains, the band: the balls at their starts and contacts of their beads. Two chains are neighbours where a contact
/// acts on both. A chain with the fewest neighbours comes next; those it leaves behind become neighbours of each other (minimum degree).
#pragma once

#include <vector>

namespace musclesim::chain {

class CoreOrder {
 public:
  /// Starts with chains that have no neighbours.
  void reset(int chain_count);
  void connect(int chain, int other);
  /// Decides the order; all neighbours are known.
  void arrange();
  /// Of two chains on which a row acts: the later one, to which it belongs. Either may be -1; -1 if both are.
  int ownerOf(int chain, int other) const;

  void clearRows();
  void addRows(int chain, int count) { row_count_[static_cast<std::size_t>(chain)] += count; }
  /// Gives every chain its numbers; all rows are counted.
  void number();
  /// The chain's next number that has not been given out.
  int takeRow(int chain) { return next_row_[static_cast<std::size_t>(chain)]++; }
  int rowCount() const { return total_; }

 private:
  std::size_t count() const { return place_.size(); }
  bool connected(int a, int b) const { return neighbours_[static_cast<std::size_t>(a) * count() + static_cast<std::size_t>(b)] != 0; }
  int leastConnected() const;
  void visit(int chain);

  std::vector<char> neighbours_;  ///< chain x chain
  std::vector<int> degree_;       ///< number of neighbours that have no place yet
  std::vector<int> sequence_;     ///< chains in their order
  std::vector<int> place_;        ///< of a chain in the sequence, -1 before it is known
  std::vector<int> left_;         ///< neighbours that the chain visited last leaves behind
  std::vector<int> row_count_, next_row_;
  int total_ = 0;
};

}  // namespace musclesim::chain
