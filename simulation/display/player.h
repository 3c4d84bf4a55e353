/// A finished replay as the window plays it: stored poses, no simulation.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/data/replay_gap.h"
#include "simulation/snapshot.h"

namespace musclesim {

/// Which rows of a recording are played: the first, and each that is at least 10 ms after the one before, so that a long recording at a
/// high rate fits into memory.
std::vector<std::size_t> playedRows(const std::vector<double>& time_s);

/// One simulation of the recording.
struct Trajectory {
  std::vector<Snapshot> snapshots;        ///< of the played rows; fewer if the simulation ended early
  std::vector<ReplayGap> gaps;            ///< of all rows; the same signals in every trajectory
  std::optional<std::string> divergence;  ///< why it ended early
};

/// Use it from one thread.
class Player {
 public:
  /// `time_s`: of the played rows. `trajectories`: the simulation as it is and, if effects were given, without them before it; none may be
  /// empty. `ghosts`: the measured poses of the played rows, or nothing; `ghost_source` says from what they follow, or why there are none.
  Player(std::vector<double> time_s, std::vector<Trajectory> trajectories, std::vector<std::shared_ptr<const DrawnGhost>> ghosts,
         std::string ghost_source);

  double beginS() const { return time_s_.front(); }
  double endS() const { return time_s_.back(); }
  double timeS() const { return position_s_; }
  /// The last played row that is not later than timeS().
  std::size_t row() const { return row_; }
  /// Plays on. At the end it begins again if it loops; otherwise it stays there and returns false.
  bool advance(double by_s);
  /// Clamped to the recording.
  void seek(double time_s);
  void step(int rows);
  /// To the beginning of the next interval of outsideS(), after the last one to the first. Returns false if there are none.
  bool seekNextGap();
  bool isLooping() const { return is_looping_; }
  void setLooping(bool on) { is_looping_ = on; }

  bool hasEffects() const { return trajectories_.size() > 1; }
  bool withEffects() const { return hasEffects() && current_ + 1 == trajectories_.size(); }
  void setEffects(bool on);

  bool hasGhost() const { return !ghosts_.empty(); }
  const std::string& ghostSource() const { return ghost_source_; }

  /// The signals that can be compared. One of them is chosen: first the one whose residual is the largest multiple of its noise.
  const std::vector<ReplayGap>& gaps() const { return trajectory().gaps; }
  int chosen() const { return chosen_; }
  /// Without a signal of this number the choice stays.
  void choose(int signal);
  /// The gap of the chosen signal; null if there is nothing to compare.
  const ReplayGap* gap() const { return chosen_ < 0 ? nullptr : &gaps()[static_cast<std::size_t>(chosen_)]; }
  /// Where the residual of the chosen signal leaves its noise band.
  const std::vector<std::pair<double, double>>& outsideS() const { return outside_s_; }

  /// What is to be seen now, with its ghost.
  std::shared_ptr<const Snapshot> snapshot();
  /// Why the simulation ended before the present row.
  std::optional<std::string> divergence() const;

 private:
  const Trajectory& trajectory() const { return trajectories_[current_]; }
  void takeOutside();

  std::vector<double> time_s_;
  std::vector<Trajectory> trajectories_;
  std::vector<std::shared_ptr<const DrawnGhost>> ghosts_;
  std::string ghost_source_;
  double position_s_;
  std::size_t row_ = 0, current_;
  bool is_looping_ = true;
  int chosen_;
  std::vector<std::pair<double, double>> outside_s_;
  std::shared_ptr<const Snapshot> latest_;
};

}  // namespace musclesim
