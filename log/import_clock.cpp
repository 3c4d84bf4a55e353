#include "import_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ctime>
#include <limits>

#include "musclesim/base/error.h"
#include "musclesim/base/text.h"

namespace musclesim {

namespace {

/// A format of strptime in two parts: up to the seconds, which may have decimals, and what follows them.
class DateFormat {
 public:
  explicit DateFormat(std::string format) {
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"%T", "%H:%M:%S"}, {".%f", ""}, {",%f", ""}})
      if (const auto place = format.find(from); place != std::string::npos) format.replace(place, from.size(), to);
    const auto seconds = format.find("%S");
    const std::size_t end = seconds == std::string::npos ? format.size() : seconds + 2;
    head_ = format.substr(0, end);
    tail_ = format.substr(end);
  }

  /// Seconds since 1970, or nothing if the text has another format.
  std::optional<double> seconds(const std::string& text) const {
    std::tm time{};
    time.tm_mday = 1;
    time.tm_year = 70;
    const char* rest = strptime(text.c_str(), head_.c_str(), &time);
    if (!rest) return std::nullopt;
    const double fraction = decimals(rest);
    rest = strptime(rest, tail_.c_str(), &time);
    if (!rest || *rest != '\0') return std::nullopt;
    const long zone_s = time.tm_gmtoff;
    return static_cast<double>(timegm(&time) - zone_s) + fraction;
  }

 private:
  /// Reads ".814" or ",814" and moves `rest` behind it.
  static double decimals(const char*& rest) {
    if ((*rest != '.' && *rest != ',') || !std::isdigit(static_cast<unsigned char>(rest[1]))) return 0;
    std::string digits = "0.";
    for (++rest; std::isdigit(static_cast<unsigned char>(*rest)); ++rest) digits += *rest;
    double value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
  }

  std::string head_, tail_;
};

/// The clock's readings before factor and offset.
std::vector<double> readings(const DataTable& table, const TableClock& clock) {
  std::vector<double> values(table.rowCount());
  if (clock.from.empty()) {
    for (std::size_t row = 0; row < values.size(); ++row) values[row] = static_cast<double>(row);
    return values;
  }
  const std::size_t column = table.indexOf(clock.from);
  if (clock.format.empty()) {
    if (table.rowCount() > 0 && table.text(0, column).find(':') != std::string_view::npos)
      table.refuse(0, column,
                   fmt::format("{} is no number; for a date and time the clock needs a format, as {{ from = \"...\", format = \"%Y-%m-%d "
                               "%H:%M:%S\" }}",
                               inQuotes(table.text(0, column))));
    return table.numbers(column);
  }
  const DateFormat format(clock.format);
  for (std::size_t row = 0; row < values.size(); ++row) {
    std::string text(table.text(row, column));
    if (!clock.date.empty() && !text.empty()) text = std::string(table.text(row, table.indexOf(clock.date))) + " " + text;
    const auto seconds = format.seconds(text);
    if (!seconds && !table.isMissing(row, column))
      table.refuse(row, column, fmt::format("{} is no date and time of the format {}", inQuotes(text), inQuotes(clock.format)));
    values[row] = seconds.value_or(std::nan(""));
  }
  return values;
}

}  // namespace

std::optional<double> secondsSince1970(const std::string& text, const std::string& format) {
  return DateFormat(format).seconds(text);
}

std::vector<double> rowTimes(const DataTable& table, const TableClock& clock, std::vector<std::string>& notes) {
  std::vector<double> times_s = readings(table, clock);
  double last_s = -std::numeric_limits<double>::infinity(), turns_s = 0;
  int turn_count = 0;
  for (std::size_t row = 0; row < times_s.size(); ++row) {
    double time_s = clock.factor * times_s[row] + clock.offset + turns_s;
    if (std::isnan(time_s)) continue;
    if (clock.wraps_at_s > 0 && time_s < last_s - clock.wraps_at_s / 2) {
      turns_s += clock.wraps_at_s;
      time_s += clock.wraps_at_s;
      ++turn_count;
    }
    if (time_s < last_s)
      table.refuse(row, table.indexOf(clock.from),
                   fmt::format("time runs backwards in data row {} (line {}): {} after {}{}", row + 1, table.line(row), time_s, last_s,
                               clock.wraps_at_s > 0 ? "" : "; a counter that begins again needs wraps_at_s"));
    times_s[row] = last_s = time_s;
  }
  if (turn_count > 0)
    notes.push_back(fmt::format("{}: the clock begins again at {:.12g} s, {} times", table.file(), clock.wraps_at_s, turn_count));
  return times_s;
}

double usualStep(const std::vector<double>& times_s) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < times_s.size(); ++i)
    if (times_s[i] > times_s[i - 1]) steps_s.push_back(times_s[i] - times_s[i - 1]);
  if (steps_s.empty()) return 0;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  return *middle;
}

}  // namespace musclesim
