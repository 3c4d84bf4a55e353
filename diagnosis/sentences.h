/// What a diagnosis says, in sentences; shared by terminal and report.
#pragma once

#include <string>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

std::string verdictSentence(const Diagnosis& diagnosis);
std::string whereSentence(const Diagnosis& diagnosis);
/// "valve_lag@muscle_1: vent_time_constant_s = 0.081 (0.077 to 0.085)".
std::string effectSentence(const FoundEffect& effect);

}  // namespace musclesim
