/// The result of a row: results/ROW.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace musclesim {

struct RowResult {
  std::string status;  ///< "done", "diverged", "failed" or "crashed"
  int exit_status = 0;
  std::string message;             ///< reason, if the status is not "done"
  nlohmann::ordered_json numbers;  ///< an object; null if there are none
  int attempt_count = 1;
  double wall_s = 0;
  std::string worker;
};

/// Writes a result; returns false if the row has one already.
bool writeResult(const std::string& folder, std::size_t row, const RowResult& result);

/// Throws BadFile, IoError.
RowResult readResult(const std::string& folder, std::size_t row);
bool hasResult(const std::string& folder, std::size_t row);

/// The last non-empty line of a text.
std::string lastLine(const std::string& text);
/// The last error line of this program ("musclesim: error: ...") in its messages, or else their last non-empty line.
std::string errorLine(const std::string& messages);

}  // namespace musclesim
