/// Writes rows of a recording as CSV text, for writeRecording and Recorder. It refuses everything that readRecording would refuse.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// Commands may lie outside 0..1 by this much, because of rounding in their source; they are clamped.
inline constexpr double command_slack_ratio = 1e-9;

/// Appends a number with the fewest digits that read back to the same double; appends nothing for NaN.
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
