#include "result.h"

#include <unistd.h>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/json_document.h"
#include "sweep.h"

namespace musclesim {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t result_limit_bytes = std::size_t{64} << 20;

std::string pathOf(const std::string& folder, std::size_t row) {
  return folder + "/results/" + rowName(row) + ".json";
}

}  // namespace

bool writeResult(const std::string& folder, std::size_t row, const RowResult& result) {
  const ordered_json json = {{"row", row},
                             {"status", result.status},
                             {"exit_status", result.exit_status},
                             {"message", result.message},
                             {"attempts", result.attempt_count},
                             {"worker", result.worker},
                             {"wall_s", result.wall_s},
                             {"result", result.numbers}};
  const std::string text = json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  const bool first = FileReplacement(pathOf(folder, row), text).commitIfAbsent();
  if (first) syncFolder(folder + "/results");
  return first;
}

RowResult readResult(const std::string& folder, std::size_t row) {
  const std::string file = pathOf(folder, row);
  const std::string text = readTextFile(file, result_limit_bytes);
  const JsonDocument checked(text, file);
  const auto json = ordered_json::parse(text);
  try {
    return {json.at("status"),   json.at("exit_status"), json.at("message"), json.at("result"),
            json.at("attempts"), json.at("wall_s"),      json.at("worker")};
  } catch (const nlohmann::json::exception& error) {
    throw BadFile(file, std::string("is not a row's result: ") + error.what());
  }
}

bool hasResult(const std::string& folder, std::size_t row) {
  return access(pathOf(folder, row).c_str(), F_OK) == 0;
}

std::string lastLine(const std::string& text) {
  const auto end = text.find_last_not_of(" \r\n");
  if (end == std::string::npos) return {};
  const auto begin = text.rfind('\n', end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

std::string errorLine(const std::string& messages) {
  const auto begin = messages.rfind("musclesim: error:");
  if (begin == std::string::npos || (begin > 0 && messages[begin - 1] != '\n')) return lastLine(messages);
  return messages.substr(begin, messages.find_first_of("\r\n", begin) - begin);
}

}  // namespace musclesim
