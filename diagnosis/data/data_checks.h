/// Checks of recordings before anything is diagnosed.
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

/// A pause of more than ten usual steps.
struct Dropout {
  std::size_t next_row;  ///< the first one after it
  /// They are others after it than before, and nothing says since when. Of a row without readings, such as the one that a mapping's
  /// before_s puts before the first, the commands are known to last until the next.
  bool changes_commands;
};
std::vector<Dropout> dropoutsOf(const Recording& recording);
/// How long readings depend on commands that are not known: valves, loggers and joints are slower by less.
inline constexpr double forgotten_after_s = 1;

/// Sentences about dropouts: pauses of more than ten usual steps, and rows without a number.
std::vector<std::string> dataNotes(const std::vector<Recording>& recordings);

/// Whether both have the same commands at the same times.
bool sameCommands(const Recording& a, const Recording& b);

/// Whether both have the same commands at the same times, or a sidecar calls one a repeat of the other.
bool isRepeat(const Recording& a, const Recording& b);

/// Throws BadFile if one recording holds the same measurements as another: a copy would hide the noise and reveal the held-out data.
void requireDifferentMeasurements(const std::vector<Recording>& recordings);

/// Median of the sizes of all numbers; 0 if there are none.
double medianSize(const std::vector<double>& values);

}  // namespace musclesim
