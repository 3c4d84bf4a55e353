/// Rows of a recording as text: what writeRecording and Recorder put into a CSV file, and nothing that readRecording would refuse.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// Commands may leave 0..1 by this much (rounding in the program that gives them) and are clamped.
inline constexpr double command_slack_ratio = 1e-9;

/// Appends the fewest digits that read back to the same double; nothing for NaN.
void appendNumber(std::string& text, double value);

class RowText {
 public:
  /// `columns` are canonical signal names without time_s. Throws BadParameter for unknown names, names given twice and missing commands.
  explicit RowText(std::vector<std::string> columns);

  std::string header() const;
  /// Appends one line. Throws BadParameter, with `text` unchanged, if the time is not later than the row before, the number of values is
  /// wrong, a value is infinite (NaN: not measured), or a command is not in 0..1.
  void append(std::string& text, double time_s, const std::vector<double>& values);

 private:
  void require(double time_s, const std::vector<double>& values) const;

  std::vector<std::string> columns_;
  std::vector<bool> is_command_;
  bool has_row_ = false;
  double last_time_s_ = 0;
};

}  // namespace musclesim
