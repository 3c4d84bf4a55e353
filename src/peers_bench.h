/// `musclesim bench --peers`: the same arm in other engines.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "options.h"

namespace musclesim::command_line {

struct PeersBenchArguments {
  std::vector<int> muscle_counts;
  int repeat_count = 3;
  double time_limit_s = 20;  ///< CPU time of a run, after which it is given up
  std::optional<std::string> out;
};

/// The text of performance.md in a folder; empty if there is none.
std::string existingPage(const std::filesystem::path& folder);
/// Returns the exit status.
int benchPeers(const ModelOptions& model, const PeersBenchArguments& arguments);

}  // namespace musclesim::command_line
