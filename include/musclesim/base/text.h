/// Places in a text, and quoting of text in messages.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace musclesim {

/// A place in a text. Lines and columns (in bytes) count from 1.
struct TextPlace {
  int line = 1, column = 1;
};

/// The place of the byte at `offset`, or of the end of the text if the offset lies behind it.
inline TextPlace placeInText(std::string_view text, std::size_t offset) {
  const auto before = text.substr(0, std::min(offset, text.size()));
  const auto line_break = before.rfind('\n');
  const std::size_t line_begin = line_break == std::string_view::npos ? 0 : line_break + 1;
  return {static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1, static_cast<int>(before.size() - line_begin) + 1};
}

/// Quotes text from a file for a message: shortens it and writes bytes that are not printable ASCII as \xNN.
std::string inQuotes(std::string_view text);

/// A text for a terminal: control characters other than line ends and tabs, which could change its colours, its title or what stands
/// above, become \xNN.
std::string printable(std::string_view text);

}  // namespace musclesim
