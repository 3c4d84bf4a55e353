#include "core_order.h"

#include <algorithm>
#include <utility>

namespace musclesim::chain {

void CoreOrder::reset(int chain_count) {
  const auto chains = static_cast<std::size_t>(chain_count);
  neighbours_.assign(chains * chains, 0);
  degree_.assign(chains, 0);
  sequence_.clear();
  sequence_.reserve(chains);
  left_.reserve(chains);
  place_.assign(chains, -1);
  row_count_.assign(chains, 0);
  next_row_.resize(chains);
}

void CoreOrder::connect(int chain, int other) {
  if (chain == other || connected(chain, other)) return;
  for (const auto& [a, b] : {std::pair{chain, other}, std::pair{other, chain}}) {
    neighbours_[static_cast<std::size_t>(a) * count() + static_cast<std::size_t>(b)] = 1;
    ++degree_[static_cast<std::size_t>(a)];
  }
}

/// The chain with the fewest neighbours among the chains without a place.
int CoreOrder::leastConnected() const {
  int least = -1;
  for (int chain = 0; chain < static_cast<int>(count()); ++chain)
    if (place_[static_cast<std::size_t>(chain)] < 0 &&
        (least < 0 || degree_[static_cast<std::size_t>(chain)] < degree_[static_cast<std::size_t>(least)]))
      least = chain;
  return least;
}

void CoreOrder::visit(int chain) {
  place_[static_cast<std::size_t>(chain)] = static_cast<int>(sequence_.size());
  sequence_.push_back(chain);
  left_.clear();
  for (int other = 0; other < static_cast<int>(count()); ++other)
    if (connected(chain, other) && place_[static_cast<std::size_t>(other)] < 0) left_.push_back(other);
  for (const int other : left_) --degree_[static_cast<std::size_t>(other)];
  for (const int a : left_)
    for (const int b : left_) connect(a, b);
}

void CoreOrder::arrange() {
  while (sequence_.size() < count()) visit(leastConnected());
}

int CoreOrder::ownerOf(int chain, int other) const {
  if (chain < 0 || other < 0) return std::max(chain, other);
  return place_[static_cast<std::size_t>(chain)] > place_[static_cast<std::size_t>(other)] ? chain : other;
}

void CoreOrder::clearRows() {
  std::fill(row_count_.begin(), row_count_.end(), 0);
}

void CoreOrder::number() {
  total_ = 0;
  for (const int chain : sequence_) {
    next_row_[static_cast<std::size_t>(chain)] = total_;
    total_ += row_count_[static_cast<std::size_t>(chain)];
  }
}

}  // namespace musclesim::chain
