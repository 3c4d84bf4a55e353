/// Figures of a blind check.
#pragma once

#include <string>

#include "score.h"

namespace musclesim::blind {

/// Share of right answers over the probability that was given for them, ten bins with 95 % intervals.
std::string reliabilitySvg(const Score& score);
/// Of single causes: share seen ("effects_found") and share named acceptably over the size of the gap.
std::string detectabilitySvg(const Score& score);
/// True stage against the stage of the answer.
std::string confusionSvg(const Score& score);

/// The class of an answer in the confusion figure: a stage, "none of these" or "no gap".
std::string answeredClass(const Judgement& judgement);

}  // namespace musclesim::blind
