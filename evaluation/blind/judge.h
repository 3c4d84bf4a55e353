/// Judges one answer against its key.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "judge_set.h"
#include "statistics.h"

namespace musclesim::blind {

/// An empty optional does not apply to this kind of case.
struct Judgement {
  std::string name, robot, kind, size, truth;  ///< truth: "id@component", several joined with " + "; empty for null
  std::vector<std::string> true_ids, true_stages;
  double gap_over_noise = 0;

  std::string verdict;         ///< given
  std::string message;         ///< of a failed diagnosis
  bool verdict_right = false;  ///< null: no_gap, or no false alarm with effects_found; open: unexplained; else effects_found
  std::string top;             ///< the most probable effect, "id@component"; empty if there is none
  double top_probability = 0, none_of_these = 0, no_effect = 0;  ///< as answered
  std::optional<bool> top1, top3;                                ///< the true id is first, among the first three
  std::optional<bool> acceptable;          ///< an acceptable answer is first, and likelier than none of these and no gap
  std::optional<bool> acceptable3;         ///< an acceptable answer is among the first three
  std::optional<bool> named;               ///< single: first, the true cause, likelier than none of these and no gap
  std::optional<bool> component;           ///< of the first entry, if its id is right
  std::optional<bool> stage;               ///< the first entry of "where" is a true stage
  std::vector<std::string> ambiguity_set;  ///< as answered
  std::optional<bool> covered;             ///< single: the truth is in the ambiguity set or chosen; several: SetJudgement::covered
  SetJudgement set;                        ///< the answer as a set of causes
  std::optional<bool> spurious;            ///< known causes: one was chosen that is neither a true one nor a look-alike of one
  std::optional<bool> open_detected;       ///< open: "unexplained", or no effect above probability 0.5, but not "no gap"
  /// null: anything but "no gap", "not excited", or effects found with none chosen, which only corrects the model's numbers
  std::optional<bool> false_alarm;
  std::optional<double> probability_of_truth;  ///< several causes: SetJudgement::probability
  std::optional<double> probability_of_acceptable;
  std::optional<double> set_size;  ///< effects in the ambiguity set; several causes: SetJudgement::class_size
  std::optional<double> reduction_percent, nominal_refit_percent;  ///< known causes
  /// Gap reduction over that of the true effect's best fit or, of several causes, over the key's `oracle_shrink_percent`. Empty where the
  /// true effects remove less than a fifth of the gap: errors of numbers or an unknown cause made it.
  std::optional<double> oracle_share;
  bool oracle_listed = false;  ///< the answer lists that fit; otherwise the true effect is taken to remove what the key says
  std::optional<Claim>
      claim;  ///< the most probable of the first effect, none of these and no gap; for several causes, right if it names one of them
  double seconds = 0;

  /// The largest probability given: of the first effect, of none of these, of no gap.
  double confidence() const;
  /// Whether an effect has it.
  bool namesEffect() const { return !top.empty() && top_probability >= confidence(); }
};

/// Key of one case as `blind make` wrote it, answer as diagnosis.json. Throws nlohmann::json::exception if members are missing in the key.
Judgement judge(const std::string& name, const nlohmann::json& key, const nlohmann::json& answer);

/// Whether the truth is the single best of an answer.
bool namesTruth(const Judgement& answer);
/// Whether an answer to a single cause names an effect and cannot tell it from others.
bool isAmbiguous(const Judgement& answer);

}  // namespace musclesim::blind
