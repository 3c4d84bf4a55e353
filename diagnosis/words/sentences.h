/// The sentences of a diagnosis, shared by terminal and report.
#pragma once

#include <string>
#include <vector>

#include "musclesim/diagnosis/diagnosis.h"
#include "number_words.h"

namespace musclesim {

inline constexpr double stands_out_of_noise = 2;  ///< RMS of a residual over the noise floor, from which on a reader is told of it

/// The answer in a few sentences: stage, effects, gap reduction, remaining gap and alternatives.
std::string verdictSentence(const Diagnosis& diagnosis);
/// The answer in the sense of Diagnosis::verdict, the most important sentence first; some may be empty.
std::vector<std::string> answerSentences(const Diagnosis& diagnosis);
/// What a reader should know besides the answer. Each is a sentence, or empty.
struct Caveats {
  std::string rest;      ///< what stands out of the noise with the effects found
  std::string numbers;   ///< numbers of the model that are off
  std::string instead;   ///< numbers taken as exact that may be the cause instead
  std::string none;      ///< probability that no known effect is the cause
  std::string others;    ///< explanations that are as good
  std::string unsteady;  ///< the motion is sensitive
  std::string model;     ///< effects that the model has already
};
Caveats caveatsOf(const Diagnosis& diagnosis);
/// Whether a sensitive motion makes a tenth of the gap or more, so that a reader is warned.
bool isNoticeable(const Unsteady& unsteady);
/// Whether the first place is more probable than all others together and the signals rule out all others; command and pressure count as
/// one.
bool isLocated(const std::vector<Place>& where);
/// Whether the gap is located and this stage is, or may be, the place.
bool mayBeAt(const std::vector<Place>& where, const std::string& stage);
/// "Less likely, but possible", or "Also possible" if another explanation is as likely as the one that is named for its effects.
std::string likelihoodOfOthers(const Diagnosis& diagnosis);
/// Whether a cause that was found acts at a stage.
bool isFoundAt(const Diagnosis& diagnosis, const std::string& stage);
std::string whereSentence(const Diagnosis& diagnosis);
/// "muscle 1" of "muscle_1", "all components" of "all".
std::string componentWords(const std::string& component);
/// "valve_lag@muscle_1: vent_time_constant_s = 0.081 (0.077 to 0.085)".
std::string effectSentence(const FoundEffect& effect);

/// "mostly a ripple of 4.6 Hz": the shape of a signal's residual on the held-out data, if it stands out; empty otherwise.
std::string shapeOfRest(const Diagnosis& diagnosis, const std::string& signal);
/// RMS residual over sigma; 0 if sigma is 0.
double overNoise(const SignalGap& gap);

/// "0 right, 1 left": Diagnosis::muscle_names.
std::string muscleNameWords(const Diagnosis& diagnosis);
/// That the model is off by a SmallGap, and by how much; empty if it is not.
std::string smallGapSentence(const Diagnosis& diagnosis);
/// "On another recording of this plant, 94.0 to 97.5 % is expected to be removed (95 % interval)."
std::string elsewhereSentence(const Estimate& reduction_percent);

}  // namespace musclesim
