/// What `musclesim blind follow` noted, against the key.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "judge.h"

namespace musclesim::blind {

/// Shrink by an answer's effects on a recording of the same plant that was not there, and what the answer promised.
struct FreshReduction {
  double reduction_percent = 0, reported_percent = 0, low_percent = 0, high_percent = 0;
  bool diverged = false;  ///< the model with the effects did
  bool isWithin() const { return !diverged && reduction_percent >= low_percent && reduction_percent <= high_percent; }
  double width() const { return high_percent - low_percent; }
};

/// What came of one answer; what was not tried is empty.
struct FollowUp {
  Judgement answer;
  std::optional<Judgement> left_out;    ///< without the true effects among the candidates
  std::optional<Judgement> experiment;  ///< with the proposed schedule recorded; failed where none was proposed
  std::optional<FreshReduction> fresh;
};

/// What the answer turns to without the true effect, the first that applies.
enum class WithoutTruth {
  failed,
  confidently_wrong,  ///< an effect with more than 0.9 that is none of the next three
  look_alike,         ///< one that the measured signals cannot separate comes first
  named_before,       ///< one that the answer with the true effect had beside it in its ambiguity set does
  class_mate,         ///< one that other recordings cannot tell from the true effect (areOfOneClass) does, with more than 0.9
  unexplained,        ///< or no effect is likelier than none of these and no gap
  unsure              ///< another effect comes first, with 0.9 or less
};
WithoutTruth withoutTruth(const Judgement& answer, const Judgement& with_truth);

/// Of the files of DIR/follow_up that belong to the present answers. `cases`: of the key.
std::vector<FollowUp> followUpsOf(const std::filesystem::path& folder, const nlohmann::json& cases);
/// Rates as in totalsOf(); empty if there is nothing to count.
nlohmann::json followUpTotals(const std::vector<FollowUp>& follow_ups);
/// In words, what is not as it should be; empty if all is.
std::vector<std::string> missesOf(const FollowUp& follow_up);

}  // namespace musclesim::blind
