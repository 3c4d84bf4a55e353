/// Figures of a check on withheld causes.
#pragma once

#include <string>

#include "score.h"

namespace musclesim::blind {

/// Reliability: share of right answers over the probability given, ten bins with 95 % intervals.
std::string reliabilitySvg(const Score& score);
/// Detectability of single causes: share found ("effects_found") and share named acceptably, over the size of the gap.
std::string detectabilitySvg(const Score& score);
/// Confusion: true stage against the stage of the answer.
std::string confusionSvg(const Score& score);

/// The class of an answer in the confusion figure: a stage, "none" or "no gap".
std::string answeredClass(const Judgement& judgement);

}  // namespace musclesim::blind
