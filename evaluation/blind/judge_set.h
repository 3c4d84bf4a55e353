/// Judges an answer as a set of causes: what was found, what is wrong, what was said of the whole set and of a remainder.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "statistics.h"

namespace musclesim::blind {

/// An effect fits a cause if it is the cause or a look-alike that the measured signals cannot separate from it (look_alikes.h). A cause
/// that the key does not demand is neither missed nor wrong. An empty optional does not apply to the plant, or the answer does not say it.
struct SetJudgement {
  int demanded = 0, found = 0;          ///< known causes that the key demands; those of them that a chosen effect fits
  int wrong = 0;                        ///< chosen effects that fit no cause of the plant
  std::optional<bool> full;             ///< every demanded cause is chosen and nothing wrong
  std::optional<double> probability;    ///< of the explanations that are full in this sense
  std::optional<bool> covered;          ///< one of the ambiguity sets, or the chosen one, is full
  std::optional<double> class_size;     ///< number of ambiguity sets
  std::optional<bool> unknown_told;     ///< a demanded unknown cause acts: "unexplained", or a significant remainder
  std::optional<bool> unknown_claimed;  ///< the same was said although none acts
  /// Of each listed effect, its inclusion probability and whether it acts. The effects that fit one cause are one claim with the sum of
  /// their probabilities; a demanded cause that is not listed is a claim of probability 0. Effects that fit an optional cause only make no
  /// claim.
  std::vector<Claim> inclusion;
  std::optional<Claim> complete;  ///< "that is all": 1 - `remainder.probability`, where the answer gives one
};

/// Key and answer as for judge(). The verdict "failed" finds nothing.
SetJudgement judgeSet(const nlohmann::json& key, const nlohmann::json& answer);

/// Whether a set of effects holds every demanded cause of the key or a look-alike, and nothing wrong. Never so with an unknown cause.
bool isWholeTruth(const nlohmann::json& key, const std::vector<std::string>& effects);

}  // namespace musclesim::blind
