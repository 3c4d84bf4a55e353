/// What a diagnosis says, in sentences; shared by terminal and report.
#pragma once

#include <string>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

std::string verdictSentence(const Diagnosis& diagnosis);
/// The first place holds half of the gap or more.
bool isTold(const std::vector<Place>& where);
/// And the signals rule out that it is anywhere else.
bool isLocated(const std::vector<Place>& where);
std::string whereSentence(const Diagnosis& diagnosis);
/// "muscle 1" of "muscle_1", "all components" of "all".
std::string componentWords(const std::string& component);
/// "valve_lag@muscle_1: vent_time_constant_s = 0.081 (0.077 to 0.085)".
std::string effectSentence(const FoundEffect& effect);

/// "96.2 %"; "more than 99.9 %" rather than 100 % of what is nearly all.
std::string percentWords(double percent);
/// What is removed, and what would be on another recording: "96.2 % (94.0 to 97.5 expected elsewhere, 95 %)".
std::string shrinkElsewhereWords(const Estimate& shrink_percent);
/// "3.8 %"; "less than 0.1 %" of what is nearly nothing.
std::string leftWords(double percent);
/// "93 %"; "over 99 %": nothing is certain.
std::string probabilityWords(double probability);

}  // namespace musclesim
