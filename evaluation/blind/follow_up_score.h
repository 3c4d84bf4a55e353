/// Scores the results of `musclesim blind follow` against the key.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "judge.h"

namespace musclesim::blind {

/// Gap reduction by an answer's effects on a new recording of the same plant, and the reduction that the answer reported.
struct FreshReduction {
  double reduction_percent = 0, reported_percent = 0;
  std::optional<std::pair<double, double>> interval_percent = {};  ///< empty if the answer gives none
  bool diverged = false;                                           ///< the model with the effects diverged
  /// Both for an answer with an interval.
  bool isWithin() const {
    return !diverged && reduction_percent >= interval_percent->first && reduction_percent <= interval_percent->second;
  }
  double width() const { return interval_percent->second - interval_percent->first; }
};

/// The follow-up of one answer; parts that were not tried are empty.
struct FollowUp {
  Judgement answer;
  std::optional<Judgement> left_out;    ///< without the true effects among the candidates
  std::optional<Judgement> experiment;  ///< with the proposed schedule recorded; failed if none was proposed
  std::optional<FreshReduction> fresh;
};

/// The answer without the true effect among the candidates; the first class that applies.
enum class WithoutTruth {
  failed,
  confidently_wrong,  ///< an effect with more than 0.9 that is in none of the next three classes
  look_alike,         ///< first is an effect that the measured signals cannot distinguish from the true one
  named_before,       ///< first is an effect from the ambiguity set of the answer with the true effect
  class_mate,         ///< first, with more than 0.9, is an effect that some recordings cannot distinguish from the true one (areOfOneClass)
  unexplained,        ///< this verdict, or no effect is more probable than none of these and no gap
  unsure              ///< another effect comes first, with 0.9 or less
};
WithoutTruth withoutTruth(const Judgement& answer, const Judgement& with_truth);

/// The follow-ups in DIR/follow_up that belong to the present answers. `cases`: of the key.
std::vector<FollowUp> followUpsOf(const std::filesystem::path& folder, const nlohmann::json& cases);
/// Rates as in totalsOf(); empty if there is nothing to count.
nlohmann::json followUpTotals(const std::vector<FollowUp>& follow_ups);
/// The faults of a follow-up in words; empty if there are none.
std::vector<std::string> missesOf(const FollowUp& follow_up);

}  // namespace musclesim::blind
