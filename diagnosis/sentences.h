/// What a diagnosis says, in sentences; shared by terminal and report.
#pragma once

#include <string>
#include <vector>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// The answer in a few sentences: where, which and how far; what is left; what else would do.
std::vector<std::string> verdictSentences(const Diagnosis& diagnosis);
/// All of them in a row.
std::string verdictSentence(const Diagnosis& diagnosis);
/// The first place is likelier than all others together.
bool isTold(const std::vector<Place>& where);
/// And the signals rule out that it is anywhere else; command and pressure count as one place.
bool isLocated(const std::vector<Place>& where);
/// Whether the gap is located and this stage is, or may be, the place.
bool mayBeAt(const std::vector<Place>& where, const std::string& stage);
std::string whereSentence(const Diagnosis& diagnosis);
/// "muscle 1" of "muscle_1", "all components" of "all".
std::string componentWords(const std::string& component);
/// "valve_lag@muscle_1: vent_time_constant_s = 0.081 (0.077 to 0.085)".
std::string effectSentence(const FoundEffect& effect);

/// "0.081 (0.077 to 0.085)": as many decimals as the interval bears. "8" where there is none, and words where nothing determines it.
std::string estimateWords(const Estimate& estimate);
/// Whether a parameter was not fitted since nothing in the data depends on it.
bool isLeftOut(const Estimate& estimate);
/// "mostly a ripple of 4.6 Hz": what a signal's residual looks like on the data held back, where it stands out; empty otherwise.
std::string shapeOfRest(const Diagnosis& diagnosis, const std::string& signal);
/// RMS residual over the noise floor; 0 without a floor.
double overNoise(const SignalGap& gap);

/// "1 number", "2 numbers".
std::string counted(std::size_t count, const std::string& one, const std::string& several = "");
/// "96.2 %"; "more than 99.9 %" rather than 100 % of what is nearly all.
std::string percentWords(double percent);
/// "On another recording of this plant 94.0 to 97.5 % are expected (95 %)."
std::string elsewhereSentence(const Estimate& reduction_percent);
/// "3.8 %"; "less than 0.1 %" of what is nearly nothing.
std::string leftWords(double percent);
/// "93 %"; "over 99 %": nothing is certain.
std::string probabilityWords(double probability);

}  // namespace musclesim
