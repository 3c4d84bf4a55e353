/// Strict reader of JSON that knows the line and column of every member, for messages.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "musclesim/base/text.h"

namespace musclesim {

/// One JSON object from a file. Unlike plain JSON readers it refuses members given twice and nesting deeper than 64.
class JsonDocument {
 public:
  /// `file` is used in messages only. Throws BadFile with line and column if the text is not one JSON object.
  JsonDocument(const std::string& text, std::string file);

  const nlohmann::json& root() const { return root_; }
  /// The member of the outermost object, or null.
  const nlohmann::json* find(const std::string& member) const;
  /// Throws BadFile with the place of a member of the outermost object, or without a place if there is no such member.
  [[noreturn]] void refuse(const std::string& member, const std::string& what) const;

 private:
  nlohmann::json root_;
  std::string file_;
  std::map<std::string, TextPlace> places_;
};

}  // namespace musclesim
