/// `musclesim blind follow`: does what a researcher would do after an answer, and uses the key to judge the outcome.
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

/// For every answered case writes DIR/follow_up/caseNNN.json:
/// - "left_out" (cases with known causes only): the answer without the true effects among the candidates;
/// - "experiment" (ambiguous answers): the answer after the plant has recorded the proposed schedule, with that recording among the fitted
///   ones; an answer that failed if no schedule was proposed;
/// - "fresh" (answers with effects): gap reduction by the answer's effects on a new recording of the same plant.
/// Skips cases that have a file. Throws as score() if key or answers are not the sealed ones, BadParameter if files were made by another
/// program or with other candidates.
void followUp(const std::filesystem::path& folder, const std::filesystem::path& key_file, const FollowUpOptions& options);

}  // namespace musclesim::blind
