#include "stop_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../data/data_checks.h"
#include "musclesim/robot/joint.h"

namespace musclesim {

namespace {

constexpr double near_stop_deg = 1;       ///< closer than this is at the stop: error of zeros, and how far a joint is pressed into it
constexpr double least_kept_share = 0.5;  ///< of all rows

/// The contacts of one recording.
struct StopContacts {
  std::string joint;
  double stop_deg = 0, first_s = 0;
  std::vector<bool> is_after;  ///< per row: at a stop, or less than forgotten_after_s after that
  auto count() const { return std::ranges::count(is_after, true); }
};

StopContacts contactsOf(const Recording& recording, const Robot& robot) {
  StopContacts contacts{{}, 0, 0, std::vector<bool>(recording.time_s.size(), false)};
  for (const Robot::Angle& angle : robot.angles()) {
    const Signal* measured = recording.find("angle_" + angle.name + "_deg");
    if (!measured) continue;
    const auto [low_deg, high_deg] = angle.joint->stopsDeg(angle.axis);
    for (const double stop_deg : {low_deg, high_deg}) {
      double last_s = -std::numeric_limits<double>::infinity();
      for (std::size_t row = 0; row < recording.time_s.size(); ++row) {
        const double value_deg = row < measured->values.size() ? measured->values[row] : std::numeric_limits<double>::quiet_NaN();
        if (std::abs(value_deg - stop_deg) < near_stop_deg) {
          if (contacts.joint.empty() || recording.time_s[row] < contacts.first_s) {
            contacts.joint = angle.name;
            contacts.stop_deg = stop_deg;
            contacts.first_s = recording.time_s[row];
          }
          last_s = recording.time_s[row];
        }
        if (recording.time_s[row] <= last_s + forgotten_after_s) contacts.is_after[row] = true;
      }
    }
  }
  return contacts;
}

bool isBeyondStops(const Recording& recording, const Robot& robot) {
  return std::ranges::any_of(robot.angles(), [&](const Robot::Angle& angle) {
    const Signal* measured = recording.find("angle_" + angle.name + "_deg");
    const auto [low_deg, high_deg] = angle.joint->stopsDeg(angle.axis);
    return measured && std::ranges::any_of(measured->values, [&, low = low_deg, high = high_deg](double value_deg) {
             return value_deg < low - near_stop_deg || value_deg > high + near_stop_deg;
           });
  });
}

}  // namespace

std::vector<std::string> dropAfterStops(std::vector<Recording>& recordings, const Robot& robot) {
  if (std::ranges::any_of(recordings, [&](const Recording& recording) { return isBeyondStops(recording, robot); })) return {};
  std::vector<StopContacts> all;
  std::size_t row_count = 0;
  std::ptrdiff_t after_count = 0;
  for (const Recording& recording : recordings) {
    all.push_back(contactsOf(recording, robot));
    row_count += recording.time_s.size();
    after_count += all.back().count();
  }
  const bool is_left_out = static_cast<double>(after_count) <= (1 - least_kept_share) * static_cast<double>(row_count);
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (all[i].joint.empty()) continue;
    notes.push_back(fmt::format("{}: {} is at its stop of {:g} deg, first at {:.2f} s; {}", recordings[i].file, all[i].joint,
                                all[i].stop_deg, all[i].first_s,
                                is_left_out ? fmt::format("from each contact to {:g} s after it, readings of motion and force are left out "
                                                          "({} of {} rows), because small errors of the model grow large there",
                                                          forgotten_after_s, all[i].count(), recordings[i].time_s.size())
                                            : "so much of the recordings is at stops that nothing is left out; small errors of the model "
                                              "grow large there, so record motions between the stops to be sure of the causes"));
    if (!is_left_out) continue;
    for (Signal& signal : recordings[i].signals) {
      if (signal.name.starts_with("command_") || signal.name.starts_with("pressure_")) continue;
      for (std::size_t row = 0; row < signal.values.size(); ++row)
        if (all[i].is_after[row]) signal.values[row] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return notes;
}

}  // namespace musclesim
