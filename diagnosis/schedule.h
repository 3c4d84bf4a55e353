/// The bank of command schedules of which the next experiment is one.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// A schedule of the bank, made to the measure of some recordings.
struct ScheduleChoice {
  std::string name;
  double amplitude = 1;  ///< 0..1, of the range that each command has in the recordings
  double level = 0;      ///< how far the middle of every command lies above that of its range, in units of that range
};

/// Every schedule at its full amplitude, about the middle of the commands' ranges, and below and above it: antagonists are softer or
/// stiffer there, and what acts on the load turns them farther or less far.
std::vector<ScheduleChoice> scheduleBank();

/// What a schedule is good for, in words.
std::string scheduleWords(const ScheduleChoice& choice);

/// The schedule for the plant of some recordings, as a recording without measurements: 12 s, 100 rows per second, every command within
/// 0..1. Throws BadParameter for an unknown name.
Recording scheduled(const ScheduleChoice& choice, const std::vector<Recording>& recordings);

}  // namespace musclesim
