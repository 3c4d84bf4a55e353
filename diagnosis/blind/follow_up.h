/// `musclesim blind follow`: what a researcher would do after an answer, with the key at hand to say whether it was right.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace musclesim::blind {

struct FollowUpOptions {
  int job_count = 0;                    ///< cases at once; 0: one per core
  std::vector<std::string> candidates;  ///< as in RunOptions
  std::function<void(int done, int count)> progress = [](int, int) {};
  std::function<bool()> interrupted = [] { return false; };
};

/// For every case that was answered, in DIR/follow_up/caseNNN.json:
/// - "left_out": the answer when the true effects are not among the candidates; of single and double cases;
/// - "experiment": the plant records the schedule that the answer proposes and is diagnosed again with that recording among those that are
///   fitted to; of answers whose ambiguity set holds the truth beside others;
/// - "fresh": shrink by the answer's effects on a recording of the same plant that was not there; of answers with effects.
/// Cases that have a file are not done again. Throws as score() if key or answers are not those that were sealed.
void followUp(const std::filesystem::path& folder, const std::filesystem::path& key_file, const FollowUpOptions& options);

/// What the files in DIR/follow_up add up to: rates as in totalsOf(); empty if there is none.
nlohmann::json followUpTotals(const std::filesystem::path& folder);

}  // namespace musclesim::blind
