/// `musclesim blind score`: opens the key and counts.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "follow_up_score.h"

namespace musclesim::blind {

/// All judgements and their totals.
struct Score {
  nlohmann::json seal, answers;  ///< as in DIR
  std::vector<Judgement> cases;
  std::vector<FollowUp> follow_ups;  ///< empty if nothing was followed up
  nlohmann::json totals;             ///< totalsOf() all cases, those with several causes, and by kind, robot, size, effect
};

/// What was said of single and open causes.
std::vector<Claim> claimsOfOneCause(const std::vector<Judgement>& cases);

/// Rates as in rateJson(), means and medians as numbers; what no case has is absent.
nlohmann::json totalsOf(const std::vector<Judgement>& cases);

/// Checks key, recordings and answers against their SHA-256, then judges every case. Throws BadFile if one differs or an answer is missing.
Score score(const std::filesystem::path& folder, const std::filesystem::path& key_file);

/// DIR/score.json.
nlohmann::json scoreJson(const Score& score);

}  // namespace musclesim::blind
