/// What is odd about recordings before anything is diagnosed.
#pragma once

#include <string>
#include <vector>

#include "plant.h"

namespace musclesim {

/// Whether some command changes by more than 0.02.
bool commandsMove(const std::vector<Recording>& recordings);

/// The first row in which some command differs from the first row's by more than 0.02; 0 if there is none.
int firstChange(const Recording& recording);

/// Whether a signal has the same value in every row of every recording that has it.
bool neverChanges(const std::vector<Recording>& recordings, const std::string& name);

/// Gaps in time (more than ten usual steps) and rows without a number, in sentences.
std::vector<std::string> dataNotes(const std::vector<Recording>& recordings);

/// Whether both have the same commands at the same times.
bool sameCommands(const Recording& a, const Recording& b);

/// The same commands at the same times, or what a sidecar calls a repeat.
bool isRepeat(const Recording& a, const Recording& b);

/// Throws BadFile if one recording is another one again: what they differ by would pass for noise, and the held-out one would be known.
void requireDifferentMeasurements(const std::vector<Recording>& recordings);

/// Throws BadFile if a signal's size is about a thousand times that of the model's or a thousandth of it: m in place of mm, kPa in
/// place of fractions.
void requireUnits(const Plant& plant, int recording, const Prediction& prediction);

}  // namespace musclesim
