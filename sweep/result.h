/// How a row ended: results/ROW.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace musclesim {

struct RowResult {
  std::string status;  ///< "done", "diverged", "failed" or "crashed"
  int exit_status = 0;
  std::string message;             ///< why, if it is not done
  nlohmann::ordered_json numbers;  ///< an object; null if there are none
  int attempt_count = 1;
  double wall_s = 0;
  std::string worker;
};

/// Puts a result in place; false if the row has one already.
bool writeResult(const std::string& folder, std::size_t row, const RowResult& result);

/// Throws BadFile, IoError.
RowResult readResult(const std::string& folder, std::size_t row);
bool hasResult(const std::string& folder, std::size_t row);

/// The last line of a text that is not empty.
std::string lastLine(const std::string& text);
/// The last line of messages that tells of an error of this program ("musclesim: error: ..."), or else the last one that is not empty.
std::string errorLine(const std::string& messages);

}  // namespace musclesim
