#include "musclesim/base/json_document.h"

#include <fmt/format.h>

#include <set>
#include <sstream>
#include <vector>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

using nlohmann::json;

constexpr int deepest_nesting = 64;

/// The offset of the opening quote of the string whose closing quote is the last byte before `end`.
std::size_t stringBegin(std::string_view text, std::size_t end) {
  const auto isEscaped = [&](std::size_t offset) {
    std::size_t backslash_count = 0;
    while (backslash_count < offset && text[offset - backslash_count - 1] == '\\') ++backslash_count;
    return backslash_count % 2 == 1;
  };
  std::size_t begin = end < 2 ? 0 : end - 2;
  while (begin > 0 && (text[begin] != '"' || isEscaped(begin))) --begin;
  return begin;
}

/// The library's message without its own prefix and place.
std::string reasonOf(const json::exception& error) {
  const std::string_view message = error.what();
  for (const std::string_view prefix : {": syntax error ", "] "}) {
    const auto found = message.find(prefix);
    if (found != std::string_view::npos) return std::string(message.substr(found + (prefix == "] " ? 2 : 9)));
  }
  return std::string(message);
}

}  // namespace

JsonDocument::JsonDocument(const std::string& text, std::string file) : file_(std::move(file)) {
  std::istringstream stream(text);
  const auto consumed = [&] {
    return static_cast<std::size_t>(std::max<std::streamoff>(0, stream.rdbuf()->pubseekoff(0, std::ios::cur, std::ios::in)));
  };
  const auto refuseAt = [&](std::size_t offset, const std::string& what) {
    const auto found = placeInText(text, offset);
    throw BadFile(file_, found.line, found.column, what);
  };
  std::vector<std::set<std::string>> members_by_depth(deepest_nesting + 2);
  // Members come in order, so that each place is counted from the one before: from the beginning it would take quadratic time.
  std::size_t counted = 0;
  TextPlace place;
  const auto placeOfMember = [&](std::size_t offset) {
    const TextPlace step = placeInText(std::string_view(text).substr(counted), offset - counted);
    place = {place.line + step.line - 1, step.line == 1 ? place.column + step.column - 1 : step.column};
    counted = offset;
    return place;
  };
  const auto observe = [&](int depth, json::parse_event_t event, const json& parsed) {
    if (depth > deepest_nesting) refuseAt(consumed(), fmt::format("nested deeper than the {} levels that are allowed", deepest_nesting));
    if (event == json::parse_event_t::object_start) members_by_depth[static_cast<std::size_t>(depth) + 1].clear();
    if (event != json::parse_event_t::key) return true;
    const auto member = parsed.get<std::string>();
    const std::size_t offset = stringBegin(text, consumed());
    if (!members_by_depth[static_cast<std::size_t>(depth)].insert(member).second)
      refuseAt(offset, fmt::format("member {} is given twice", inQuotes(member)));
    if (depth == 1) places_[member] = placeOfMember(offset);
    return true;
  };
  try {
    root_ = json::parse(stream, observe);
  } catch (const json::parse_error& error) {
    refuseAt(error.byte == 0 ? 0 : error.byte - 1, "is not valid JSON: " + reasonOf(error));
  } catch (const json::exception& error) {
    refuseAt(consumed(), "is not valid JSON: " + reasonOf(error));
  }
  if (!root_.is_object()) refuseAt(0, "must hold one JSON object: {\"member\": value, ...}");
}

const json* JsonDocument::find(const std::string& member) const {
  const auto found = root_.find(member);
  return found == root_.end() ? nullptr : &*found;
}

void JsonDocument::refuse(const std::string& member, const std::string& what) const {
  const auto found = places_.find(member);
  const TextPlace place = found == places_.end() ? TextPlace{0, 0} : found->second;
  throw BadFile(file_, place.line, place.column, what);
}

}  // namespace musclesim
