/// Text of files in messages: where it stands, and how it is quoted.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace musclesim {

/// A place in a text. Lines and columns (in bytes) count from 1.
struct TextPlace {
  int line = 1, column = 1;
};

/// The place of the byte at `offset`; of the text's end if the offset lies behind it.
inline TextPlace placeInText(std::string_view text, std::size_t offset) {
  const auto before = text.substr(0, std::min(offset, text.size()));
  const auto line_break = before.rfind('\n');
  const std::size_t line_begin = line_break == std::string_view::npos ? 0 : line_break + 1;
  return {static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1, static_cast<int>(before.size() - line_begin) + 1};
}

/// Text from a file as it may stand in a message: shortened, and bytes that are not printable ASCII written as \xNN.
std::string inQuotes(std::string_view text);

}  // namespace musclesim
