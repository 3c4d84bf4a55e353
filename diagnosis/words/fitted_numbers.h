/// Words for numbers of the model that were fitted together with effects, or without any.
#pragma once

#include <string>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// Whether the verdict is `no_gap` because numbers of the model were fitted: the model as it was given does have a gap.
bool isExplainedByNumbers(const Diagnosis& diagnosis);
/// Sentences on numbers that differ from what was given by a tolerance or more, if their intervals exclude that; empty if none does.
std::string numbersWords(const Diagnosis& diagnosis);
/// Sentence on the share of the gap that fitted numbers alone remove, where no cause is believed; empty below 5 %.
std::string fittedNumbersSentence(const Diagnosis& diagnosis);
/// Sentence on the share that re-tuning without any effect removes, beside a rejected explanation; empty below 5 %.
std::string retunedSentence(const Diagnosis& diagnosis);

}  // namespace musclesim
