/// What is odd about recordings before anything is diagnosed.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/recording.h"

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

/// Median of the sizes of all numbers; 0 if there are none.
double medianSize(const std::vector<double>& values);

}  // namespace musclesim
