/// The signals of a run: which are recorded, their velocities, and what they come to at the end.
#pragma once

#include <deque>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim::command_line {

/// The columns of a run's recording: the robot's signals, then those of its controller.
///
/// Velocities and accelerations are made from the readings of the last control steps, by one-sided differences of second order:
///     v_k = (3 y_k - 4 y_(k-1) + y_(k-2)) / (2 h),    a_k = (2 y_k - 5 y_(k-1) + 4 y_(k-2) - y_(k-3)) / h^2
/// y reading, h control step in s. They see what a controller on the machine could see, noise included; the first rows have none.
class RunSignals {
 public:
  /// `chosen`: names of signals, with _per_s or _per_s2 for velocities and accelerations of lengths, angles and the hand; empty: all
  /// signals, without velocities. Commands are always recorded, since no recording can do without them. So is what the verdict needs: the
  /// `summarised` signals, and targets of joints with the joints' angles.
  /// Throws BadParameter for a name that the run does not have; the message gives the nearest.
  RunSignals(const Robot& robot, const Controller& controller, const std::vector<std::string>& chosen,
             const std::vector<std::string>& summarised, double step_s);

  const std::vector<std::string>& names() const { return names_; }
  /// Signals that were not chosen and are recorded for the verdict.
  const std::vector<std::string>& added() const { return added_; }
  /// The row of a state; to be called once per control step.
  std::vector<double> row(const State& state);

 private:
  struct Source {
    std::size_t signal;
    int derivative;
  };
  void add(const std::string& name, const std::vector<std::string>& all, const char* option);
  double value(const Source& source) const;

  const Robot& robot_;
  const Controller& controller_;
  double step_s_;
  std::vector<std::string> names_, added_;
  std::vector<Source> sources_;
  std::deque<std::vector<double>> past_;  ///< all signals, the newest first, at most four
};

/// What chosen signals come to over a run: per signal an object with
///     last, mean, peak (largest), trough (smallest),
///     settling_time_s  time of the last reading that is farther from `last` than 2 % of the whole change, last - first
///     overshoot        how far the signal goes beyond `last`, in the direction of the change and as a share of it
///     rmse             against a recording, over the times of its readings within the run; straight lines between the run's readings
/// Settling time and overshoot are null if the change does not stand out from the signal's noise (smallestChange), and if the signal still
/// leaves the band with the last reading but one.
class SignalSummary {
 public:
  /// `columns`: the names of a run's columns. Throws BadParameter for a chosen name that is not among them.
  SignalSummary(const std::vector<std::string>& chosen, const std::vector<std::string>& columns);
  void add(double time_s, const std::vector<double>& row);
  /// `against` may be null.
  nlohmann::json json(const Recording* against) const;

 private:
  nlohmann::json summaryOf(const std::vector<double>& values) const;
  nlohmann::json rmse(const std::vector<double>& values, const Recording& against, const Signal* measured) const;

  std::vector<std::string> names_;
  std::vector<std::size_t> places_;  ///< in a row
  std::vector<double> time_s_;
  std::vector<std::vector<double>> values_;  ///< per chosen signal
};

/// The same as a table for people.
std::string summaryText(const nlohmann::json& signals);

/// A change below this is noise or rounding: the largest of
///     4 s,  s = median |y_k - 2 y_(k-1) + y_(k-2)| / (0.6745 sqrt(6))   deviation of white noise on a smooth signal
///     1e-9 max |y|                                                      rounding
/// in the unit of the readings y; readings that are not finite are left out.
double smallestChange(const std::vector<double>& values);

/// How far the joints of a run were from their targets (columns angle_<joint>_deg and target_<joint>_deg), in the second half of the run,
/// when the beginning is over: per joint an object with rmse_deg, largest_deg and from_s.
class Tracking {
 public:
  explicit Tracking(const std::vector<std::string>& columns);
  void add(double time_s, const std::vector<double>& row);
  /// Empty without targets.
  nlohmann::json json() const;

 private:
  struct Joint {
    std::string name;
    std::size_t angle, target;  ///< places in a row
    std::vector<double> error_deg;
  };
  std::vector<double> time_s_;
  std::vector<Joint> joints_;
};

}  // namespace musclesim::command_line
