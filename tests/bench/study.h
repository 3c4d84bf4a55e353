/// Helpers of the longer measurements: commands, CPU time, and writing sections of documents.
#pragma once

#include <ctime>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "musclesim/base/random.h"
#include "musclesim/log/recording.h"
#include "musclesim/robot/state.h"

namespace musclesim {

inline double cpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Commands over time, each held until the next.
struct Schedule {
  std::vector<double> time_s;
  std::vector<Action> command;

  /// The command at a time, for the given number of muscles; additional muscles repeat the commands, starting with the first.
  Action at(double time_s_now, int muscle_count) const {
    std::size_t row = 0;
    while (row + 1 < time_s.size() && time_s[row + 1] <= time_s_now + 1e-9) ++row;
    Action result;
    for (int i = 0; i < muscle_count; ++i) result.push_back(command[row][static_cast<std::size_t>(i) % command[row].size()]);
    return result;
  }
};

/// The commands of a recording with its times divided by `speed_up`.
inline Schedule scheduleOf(const std::string& recording_file, double speed_up) {
  const Recording recording = readRecording(recording_file);
  Schedule schedule;
  for (std::size_t row = 0; row < recording.time_s.size(); ++row) {
    schedule.time_s.push_back(recording.time_s[row] / speed_up);
    schedule.command.emplace_back();
    for (int i = 0; const Signal* signal = recording.find("command_" + std::to_string(i)); ++i)
      schedule.command.back().push_back(signal->values[row]);
  }
  return schedule;
}

/// Uniformly random pressures, new ones every `hold_s`.
inline Schedule randomSchedule(double hold_s, double duration_s, std::uint64_t seed, int muscle_count = 30) {
  RandomStream random(seed, "study.pressures");
  Schedule schedule;
  for (int i = 0; i * hold_s < duration_s; ++i) {
    schedule.time_s.push_back(i * hold_s);
    schedule.command.emplace_back();
    for (int muscle = 0; muscle < muscle_count; ++muscle) schedule.command.back().push_back(random.uniform());
  }
  return schedule;
}

/// Replaces the text between the lines "<!-- NAME: written by ... -->" and "<!-- end of NAME -->" of a document.
inline void writeSection(const std::string& document, const std::string& name, const std::string& program, const std::string& text) {
  std::ifstream in(document);
  std::stringstream whole;
  whole << in.rdbuf();
  std::string content = whole.str();
  const std::string first = "<!-- " + name + ": written by " + program + " -->", last = "<!-- end of " + name + " -->";
  const auto begin = content.find(first), end = content.find(last);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw std::runtime_error(document + " has no section \"" + first + "\" .. \"" + last + "\"");
  content.replace(begin + first.size(), end - begin - first.size(), "\n\n" + text + "\n");
  in.close();
  std::ofstream(document) << content;
}

}  // namespace musclesim
