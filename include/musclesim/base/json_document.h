/// JSON from a file, read strictly, with the places of its members for messages.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "musclesim/base/text.h"

namespace musclesim {

/// One JSON object as it stands in a file. Refuses what plain JSON readers let pass: members given twice and nesting deeper than 64.
class JsonDocument {
 public:
  /// `file` is used in messages only. Throws BadFile with line and column if the text is not one JSON object.
  JsonDocument(const std::string& text, std::string file);

  const nlohmann::json& root() const { return root_; }
  /// The member of the outermost object, or null.
  const nlohmann::json* find(const std::string& member) const;
  /// Throws BadFile at a member of the outermost object; at the file as a whole if there is no such member.
  [[noreturn]] void refuse(const std::string& member, const std::string& what) const;

 private:
  nlohmann::json root_;
  std::string file_;
  std::map<std::string, TextPlace> places_;
};

}  // namespace musclesim
