/// Table and figure of `musclesim bench --peers`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace musclesim::command_line {

/// The accuracy rule of the comparison: medians over several sequences of commands at both times, or at the earlier one alone.
enum class PeerRule { early_and_late, early };
inline constexpr double peer_rule_early_s = 0.1, peer_rule_late_s = 0.3, peer_rule_hand_mm = 10, peer_rule_gap_mm = 1;
inline constexpr int peer_sequence_count = 5;

/// What one engine reached with one robot, by its cheapest method and longest step that keep the accuracy rule.
struct PeerResult {
  std::string engine, version, method;
  std::string failure;  ///< why there is no result; empty: there is one
  int muscle_count = 0;
  bool chains = true;
  PeerRule rule = PeerRule::early_and_late;
  double step_ms = 0;
  double early_mm = 0, late_mm = 0;                      ///< distance of the hand from the engine's own converged path, at 0.1 s and 0.3 s
  double early_from_ours_mm = 0, late_from_ours_mm = 0;  ///< of its converged path from that of musclesim
  double gap_mm = 0;
  double ratio = 0;                              ///< CPU time over simulated time
  double step_over_ours = 0;                     ///< CPU time of a step over that of a step of musclesim
  double over_ours = 0, least = 0, largest = 0;  ///< CPU time over that of musclesim: median, least and largest of the repeats
};

/// A section of performance.md, from its first line to its last.
std::string peersSection(const std::vector<PeerResult>& results, int repeat_count, double time_limit_s);
std::string peersFigure(const std::vector<PeerResult>& results);
nlohmann::json peersJson(const std::vector<PeerResult>& results);

/// The section in a document, with its markers; empty if it has none.
std::string peersSectionOf(const std::string& document);
/// The document with its section replaced, or added at its end.
std::string withPeersSection(const std::string& document, const std::string& section);

}  // namespace musclesim::command_line
