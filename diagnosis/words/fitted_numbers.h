/// Words for numbers of the model that were fitted together with effects, or without any.
#pragma once

#include <string>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// Whether the verdict is `no_gap` because numbers of the model were fitted: the model as it was given does have a gap.
bool isExplainedByNumbers(const Diagnosis& diagnosis);
/// The numbers that are off by more than their tolerances let expect; empty if there are none.
std::string numbersWords(const Diagnosis& diagnosis);
/// What the numbers of the model take in where no cause is believed; empty if that is not worth telling.
std::string fittedNumbersSentence(const Diagnosis& diagnosis);
/// What re-tuning the model without any effect removes, beside a rejected explanation; empty if that is not worth telling.
std::string retunedSentence(const Diagnosis& diagnosis);

}  // namespace musclesim
