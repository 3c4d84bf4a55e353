#include "row_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "columns.h"
#include "musclesim/base/error.h"

namespace musclesim {

void appendNumber(std::string& text, double value) {
  if (std::isnan(value)) return;
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

RowText::RowText(std::vector<std::string> columns) : columns_(std::move(columns)) {
  std::vector<Column> parsed;
  for (const auto& name : columns_) {
    const auto known = std::find_if(parsed.begin(), parsed.end(), [&](const Column& column) { return column.name == name; });
    if (known != parsed.end() || name == "time_s") throw BadParameter(fmt::format("column {} is given twice", name));
    parsed.push_back(parseCanonicalName(name));
    is_command_.push_back(parsed.back().quantity == "command");
  }
  requireCommands(parsed);
}

std::string RowText::header() const {
  std::string text = "time_s";
  for (const auto& name : columns_) text += "," + name;
  return text + "\n";
}

void RowText::require(double time_s, const std::vector<double>& values) const {
  if (!std::isfinite(time_s) || (has_row_ && !(time_s > last_time_s_)))
    throw BadParameter("time_s", fmt::format("{} s", time_s),
                       has_row_ ? fmt::format("be later than the row before ({} s)", last_time_s_) : "be finite");
  if (values.size() != columns_.size())
    throw BadParameter("row", fmt::format("{} values", values.size()), fmt::format("have {}, one for each column", columns_.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto at_time = [&] { return fmt::format("{} at {} s", columns_[i], time_s); };
    if (is_command_[i] && !(values[i] >= -command_slack_ratio && values[i] <= 1 + command_slack_ratio))
      throw BadParameter(at_time(), fmt::format("{}", values[i]), "lie in 0 .. 1");
    if (std::isinf(values[i])) throw BadParameter(at_time(), fmt::format("{}", values[i]), "be finite, or NaN where nothing was measured");
  }
}

void RowText::append(std::string& text, double time_s, const std::vector<double>& values) {
  require(time_s, values);
  has_row_ = true;
  last_time_s_ = time_s;
  appendNumber(text, time_s);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool must_clamp = is_command_[i] && (values[i] < 0 || values[i] > 1);
    text += ',';
    appendNumber(text, must_clamp ? std::clamp(values[i], 0.0, 1.0) : values[i]);
  }
  text += '\n';
}

}  // namespace musclesim
