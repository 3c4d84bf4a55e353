#include "player.h"

#include <algorithm>
#include <cmath>

namespace musclesim {

std::vector<std::size_t> playedRows(const std::vector<double>& time_s) {
  constexpr double interval_s = 0.01, rounding_s = 1e-9;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < time_s.size(); ++row)
    if (rows.empty() || time_s[row] - time_s[rows.back()] >= interval_s - rounding_s) rows.push_back(row);
  return rows;
}

Player::Player(std::vector<double> time_s, std::vector<Trajectory> trajectories, std::vector<std::shared_ptr<const DrawnGhost>> ghosts,
               std::string ghost_source)
    : time_s_(std::move(time_s)),
      trajectories_(std::move(trajectories)),
      ghosts_(std::move(ghosts)),
      ghost_source_(std::move(ghost_source)),
      position_s_(time_s_.front()),
      current_(trajectories_.size() - 1),
      chosen_(widestGap(trajectories_.front().gaps)) {
  takeOutside();
}

void Player::takeOutside() {
  outside_s_ = gap() ? gap()->outsideS() : std::vector<std::pair<double, double>>();
}

bool Player::advance(double by_s) {
  const double duration_s = endS() - beginS();
  double next_s = position_s_ + by_s;
  const bool is_over = next_s >= endS();
  if (is_over && is_looping_ && duration_s > 0) next_s = beginS() + std::fmod(next_s - beginS(), duration_s);
  seek(next_s);
  return !is_over || is_looping_;
}

void Player::seek(double time_s) {
  position_s_ = std::clamp(time_s, beginS(), endS());
  const auto after = std::ranges::upper_bound(time_s_, position_s_);
  row_ = static_cast<std::size_t>(after - time_s_.begin()) - 1;
  latest_ = nullptr;
}

void Player::step(int rows) {
  const auto last = static_cast<long>(time_s_.size()) - 1;
  seek(time_s_[static_cast<std::size_t>(std::clamp(static_cast<long>(row_) + rows, 0L, last))]);
}

bool Player::seekNextGap() {
  if (outside_s_.empty()) return false;
  const auto next = std::ranges::find_if(outside_s_, [this](const auto& interval) { return interval.first > position_s_; });
  seek(next == outside_s_.end() ? outside_s_.front().first : next->first);
  return true;
}

void Player::setEffects(bool on) {
  current_ = on ? trajectories_.size() - 1 : 0;
  takeOutside();
  latest_ = nullptr;
}

void Player::choose(int signal) {
  if (signal < 0 || signal >= static_cast<int>(gaps().size())) return;
  chosen_ = signal;
  takeOutside();
}

std::shared_ptr<const Snapshot> Player::snapshot() {
  if (latest_) return latest_;
  const std::vector<Snapshot>& all = trajectory().snapshots;
  Snapshot now = all[std::min(row_, all.size() - 1)];
  if (hasGhost()) now.ghost = ghosts_[row_];
  return latest_ = std::make_shared<const Snapshot>(std::move(now));
}

std::optional<std::string> Player::divergence() const {
  return row_ < trajectory().snapshots.size() ? std::nullopt : trajectory().divergence;
}

}  // namespace musclesim
