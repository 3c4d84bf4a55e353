#include "run_signals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "musclesim/base/error.h"
#include "musclesim/simulation/run_loop.h"

namespace musclesim::command_line {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The angle for which this column is the target; empty for other columns.
std::string angleOfTarget(const std::string& name) {
  const std::string prefix = "target_", suffix = "_deg";
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return "";
  return "angle_" + name.substr(prefix.size());
}

[[noreturn]] void refuse(const char* option, const std::string& name, const std::vector<std::string>& known) {
  const std::string nearest = nearestName(name, known);
  throw BadParameter(option, name, "be a signal of this run" + (nearest.empty() ? std::string() : "; did you mean \"" + nearest + "\"?"));
}

/// The name of the signal of which this is a derivative; the name itself for none.
std::string integralOf(const std::string& name, int& derivative) {
  derivative = name.ends_with("_per_s") ? 1 : name.ends_with("_per_s2") ? 2 : 0;
  return derivative == 0 ? name : name.substr(0, name.rfind("_per_s"));
}

bool isMotion(const std::string& name) {
  return name.starts_with("length_") || name.starts_with("angle_") || name.starts_with("hand_");
}

nlohmann::json finiteOrNull(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

}  // namespace

RunSignals::RunSignals(const Robot& robot, const Controller& controller, const std::vector<std::string>& chosen,
                       const std::vector<std::string>& summarised, double step_s)
    : robot_(robot), controller_(controller), step_s_(step_s) {
  const std::vector<std::string> all = runColumns(robot, controller);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_chosen = chosen.empty() || all[i].starts_with("command_") || std::ranges::find(chosen, all[i]) != chosen.end();
    if (!is_chosen) continue;
    names_.push_back(all[i]);
    sources_.push_back({i, 0});
  }
  for (const std::string& name : chosen) add(name, all, "record-signals");
  const std::size_t chosen_count = names_.size();
  for (const std::string& name : summarised) add(name, all, "summarise");
  for (const std::string& name : all) {
    const std::string angle = angleOfTarget(name);
    if (std::ranges::find(all, angle) == all.end()) continue;
    add(name, all, "record-signals");
    add(angle, all, "record-signals");
  }
  added_.assign(names_.begin() + static_cast<std::ptrdiff_t>(chosen_count), names_.end());
}

void RunSignals::add(const std::string& name, const std::vector<std::string>& all, const char* option) {
  if (std::ranges::find(names_, name) != names_.end()) return;
  int derivative = 0;
  const std::string source = integralOf(name, derivative);
  const auto found = std::ranges::find(all, source);
  if (found == all.end() || (derivative > 0 && !isMotion(name))) refuse(option, name, all);
  names_.push_back(name);
  sources_.push_back({static_cast<std::size_t>(found - all.begin()), derivative});
}

double RunSignals::value(const Source& source) const {
  const auto y = [&](std::size_t steps_ago) { return past_[steps_ago][source.signal]; };
  if (past_.size() < (source.derivative == 0 ? 1u : static_cast<std::size_t>(source.derivative) + 2)) return nan;
  switch (source.derivative) {
    case 0:
      return y(0);
    case 1:
      return (3 * y(0) - 4 * y(1) + y(2)) / (2 * step_s_);
    default:
      return (2 * y(0) - 5 * y(1) + 4 * y(2) - y(3)) / (step_s_ * step_s_);
  }
}

std::vector<double> RunSignals::row(const State& state) {
  constexpr std::size_t most = 4;
  past_.push_front(runRow(robot_, controller_, state));
  if (past_.size() > most) past_.pop_back();
  std::vector<double> row;
  for (const Source& source : sources_) row.push_back(value(source));
  return row;
}

SignalSummary::SignalSummary(const std::vector<std::string>& chosen, const std::vector<std::string>& columns) : names_(chosen) {
  for (const std::string& name : chosen) {
    const auto found = std::ranges::find(columns, name);
    if (found == columns.end()) refuse("summarise", name, columns);
    places_.push_back(static_cast<std::size_t>(found - columns.begin()));
  }
  values_.resize(names_.size());
}

void SignalSummary::add(double time_s, const std::vector<double>& row) {
  if (names_.empty()) return;
  time_s_.push_back(time_s);
  for (std::size_t i = 0; i < places_.size(); ++i) values_[i].push_back(row[places_[i]]);
}

nlohmann::json SignalSummary::summaryOf(const std::vector<double>& values) const {
  constexpr double band_share = 0.02;  ///< of the whole change: the usual band of a settling time
  double sum = 0, peak = nan, trough = nan, first = nan, last = nan;
  long count = 0;
  for (const double y : values) {
    if (!std::isfinite(y)) continue;
    if (count++ == 0) first = peak = trough = y;
    sum += y, last = y;
    peak = std::max(peak, y), trough = std::min(trough, y);
  }
  nlohmann::json json = {{"last", finiteOrNull(last)}, {"mean", finiteOrNull(count > 0 ? sum / static_cast<double>(count) : nan)},
                         {"peak", finiteOrNull(peak)}, {"trough", finiteOrNull(trough)},
                         {"settling_time_s", nullptr}, {"overshoot", nullptr}};
  const double change = last - first;
  if (!(std::abs(change) > smallestChange(values))) return json;
  std::size_t settled = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::abs(values[i] - last) > band_share * std::abs(change)) settled = i + 1;
  if (settled + 1 >= values.size()) return json;  // it still moves at the end
  json["settling_time_s"] = time_s_[settled];
  json["overshoot"] = (change > 0 ? peak - last : last - trough) / std::abs(change);
  return json;
}

double smallestChange(const std::vector<double>& values) {
  constexpr double deviations = 4, rounding_share = 1e-9;
  constexpr double median_per_deviation = 0.6745;  ///< of |x|, x normally distributed
  std::vector<double> finite, bends;
  double largest = 0;
  for (const double y : values) {
    if (!std::isfinite(y)) continue;
    finite.push_back(y);
    largest = std::max(largest, std::abs(y));
  }
  for (std::size_t k = 2; k < finite.size(); ++k) bends.push_back(std::abs(finite[k] - 2 * finite[k - 1] + finite[k - 2]));
  double deviation = 0;
  if (!bends.empty()) {
    const auto middle = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2);
    std::nth_element(bends.begin(), middle, bends.end());
    deviation = *middle / (median_per_deviation * std::sqrt(6.0));
  }
  return std::max(deviations * deviation, rounding_share * largest);
}

std::string summaryText(const nlohmann::json& signals) {
  std::size_t width = std::string("signal").size();
  bool has_rmse = false;
  for (const auto& [name, figures] : signals.items()) {
    width = std::max(width, name.size());
    has_rmse = has_rmse || figures.contains("rmse");
  }
  std::vector<std::string> members = {"last", "mean", "peak", "trough", "settling_time_s", "overshoot"};
  if (has_rmse) members.emplace_back("rmse");
  std::string text = fmt::format("{:<{}}", "signal", width);
  for (const std::string& member : members) text += fmt::format("  {:>{}}", member, std::max<std::size_t>(member.size(), 10));
  for (const auto& [name, figures] : signals.items()) {
    text += fmt::format("\n{:<{}}", name, width);
    for (const std::string& member : members) {
      const auto& value = figures[member];
      text += fmt::format("  {:>{}}", value.is_null() ? "-" : fmt::format("{:.5g}", value.get<double>()),
                          std::max<std::size_t>(member.size(), 10));
    }
  }
  return text + "\n";
}

nlohmann::json SignalSummary::rmse(const std::vector<double>& values, const Recording& against, const Signal* measured) const {
  constexpr double tolerance_s = 1e-9;
  double squares = 0;
  long count = 0;
  for (std::size_t row = 0; measured && row < against.time_s.size(); ++row) {
    const double t = against.time_s[row];
    if (!std::isfinite(measured->values[row]) || t < time_s_.front() - tolerance_s || t > time_s_.back() + tolerance_s) continue;
    const auto later = std::upper_bound(time_s_.begin(), time_s_.end(), t);
    const auto b =
        static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(later - time_s_.begin(), 1, static_cast<std::ptrdiff_t>(time_s_.size()) - 1));
    const double share = (t - time_s_[b - 1]) / (time_s_[b] - time_s_[b - 1]);
    const double error = values[b - 1] + share * (values[b] - values[b - 1]) - measured->values[row];
    if (!std::isfinite(error)) continue;
    squares += error * error;
    ++count;
  }
  return count > 0 ? nlohmann::json(std::sqrt(squares / static_cast<double>(count))) : nlohmann::json(nullptr);
}

nlohmann::json SignalSummary::json(const Recording* against) const {
  nlohmann::json json = nlohmann::json::object();
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (time_s_.empty()) continue;
    json[names_[i]] = summaryOf(values_[i]);
    if (against) json[names_[i]]["rmse"] = time_s_.size() < 2 ? nullptr : rmse(values_[i], *against, against->find(names_[i]));
  }
  return json;
}

Tracking::Tracking(const std::vector<std::string>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto angle = std::ranges::find(columns, angleOfTarget(columns[i]));
    if (angle == columns.end()) continue;
    const std::string joint = angle->substr(std::string("angle_").size());
    joints_.push_back(
        {joint.substr(0, joint.size() - std::string("_deg").size()), static_cast<std::size_t>(angle - columns.begin()), i, {}});
  }
}

void Tracking::add(double time_s, const std::vector<double>& row) {
  if (joints_.empty()) return;
  time_s_.push_back(time_s);
  for (Joint& joint : joints_) joint.error_deg.push_back(row[joint.angle] - row[joint.target]);
}

nlohmann::json Tracking::json() const {
  nlohmann::json json = nlohmann::json::object();
  if (time_s_.empty()) return json;
  const auto first = static_cast<std::size_t>(std::ranges::lower_bound(time_s_, time_s_.back() / 2) - time_s_.begin());
  for (const Joint& joint : joints_) {
    double squares = 0, largest = 0;
    for (std::size_t i = first; i < joint.error_deg.size(); ++i) {
      squares += joint.error_deg[i] * joint.error_deg[i];
      largest = std::max(largest, std::abs(joint.error_deg[i]));
    }
    json[joint.name] = {{"rmse_deg", std::sqrt(squares / static_cast<double>(joint.error_deg.size() - first))},
                        {"largest_deg", largest},
                        {"from_s", time_s_[first]}};
  }
  return json;
}

}  // namespace musclesim::command_line
