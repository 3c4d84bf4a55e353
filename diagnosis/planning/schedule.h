/// The bank of command schedules from which the next experiment is chosen.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// A schedule of the bank, scaled to the command ranges of some recordings.
struct ScheduleChoice {
  std::string name;
  double amplitude = 1;  ///< 0..1, share of the range that each command has in the recordings
  double level = 0;      ///< offset of the middle of every command from the middle of its range, in units of that range
};

/// Every schedule at full amplitude, about the middle of the command ranges and below and above it: at other levels antagonists are softer
/// or stiffer, and effects on the load turn them by other amounts.
std::vector<ScheduleChoice> scheduleBank();

/// A schedule in words.
std::string scheduleWords(const ScheduleChoice& choice);

/// The schedule as a recording without measurements, scaled to the ranges of some recordings: 12 s, 100 rows per second, every command
/// within 0..1. Throws BadParameter for an unknown name.
Recording scheduled(const ScheduleChoice& choice, const std::vector<Recording>& recordings);

}  // namespace musclesim
