/// `musclesim blind follow`: what a researcher would do after an answer, with the key at hand to say whether it was right.
#pragma once

#include <filesystem>
#include <functional>
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
/// - "experiment": the answer when the plant has recorded the proposed schedule and that recording is among those that are fitted to; of
///   ambiguous answers. Where no schedule was proposed, a failed one;
/// - "fresh": shrink by the answer's effects on a recording of the same plant that was not there; of answers with effects.
/// Cases that have a file are not done again. Throws as score() if key or answers are not those that were sealed, BadParameter if files
/// were made by another program or with other candidates.
void followUp(const std::filesystem::path& folder, const std::filesystem::path& key_file, const FollowUpOptions& options);

}  // namespace musclesim::blind
