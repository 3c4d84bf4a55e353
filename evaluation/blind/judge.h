/// Judges one answer against its key.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "statistics.h"

namespace musclesim::blind {

/// An empty optional does not apply to this kind of case.
struct Judgement {
  std::string name, robot, kind, size, truth;  ///< truth: "id@component", several joined with " + "; empty for null
  std::vector<std::string> true_ids, true_stages;
  double gap_over_noise = 0;

  std::string verdict;                                           ///< given
  std::string message;                                           ///< of a failed diagnosis
  bool verdict_right = false;                                    ///< null: no_gap; open: unexplained; else effects_found
  std::string top;                                               ///< the most probable effect, "id@component"; empty if there is none
  double top_probability = 0, none_of_these = 0, no_effect = 0;  ///< as answered
  std::optional<bool> top1, top3;                                ///< the true id is first, among the first three
  std::optional<bool> acceptable;              ///< an acceptable answer is first, and likelier than none of these and no gap
  std::optional<bool> acceptable3;             ///< an acceptable answer is among the first three
  std::optional<bool> named;                   ///< single: first, the true cause, likelier than none of these and no gap
  std::optional<bool> component;               ///< of the first entry, if its id is right
  std::optional<bool> stage;                   ///< the first entry of "where" is a true stage
  std::vector<std::string> ambiguity_set;      ///< as answered
  std::optional<bool> covered;                 ///< the truth is in the ambiguity set or chosen; of doubles both
  std::optional<bool> pair;                    ///< doubles: both causes, or acceptable ones, are chosen
  std::optional<bool> spurious;                ///< single, double: a cause was chosen that is neither a true one nor a look-alike of one
  std::optional<bool> open_detected;           ///< open: "unexplained", or no effect above probability 0.5, but not "no gap"
  std::optional<bool> false_alarm;             ///< null: a gap was seen
  std::optional<double> probability_of_truth;  ///< for doubles, of explanations that contain both
  std::optional<double> probability_of_acceptable, set_size;
  std::optional<double> reduction_percent, nominal_refit_percent;  ///< single and double
  std::optional<double> oracle_share;                              ///< single: gap reduction over that of the true effect's best fit
  bool oracle_listed = false;  ///< the answer lists that fit; otherwise the true effect is taken to remove everything
  std::optional<Claim>
      claim;  ///< the most probable of the first effect, none of these and no gap; for doubles, right if it names either cause
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
