#include "musclesim/base/text.h"

#include <fmt/format.h>

namespace musclesim {

std::string inQuotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string out = "\"";
  for (const char character : text.substr(0, longest)) {
    const auto code = static_cast<unsigned char>(character);
    if (code >= 0x20 && code < 0x7F)
      out += character;
    else
      out += fmt::format("\\x{:02X}", code);
  }
  return out + (text.size() > longest ? "...\"" : "\"");
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto code = static_cast<unsigned char>(text[i]);
    const bool is_plain_control = code < 0x20 && code != '\n' && code != '\t';
    // U+0080 .. U+009F, control characters as well, are C2 80 .. C2 9F in UTF-8.
    const bool is_upper_control = i + 1 < text.size() && code == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (is_upper_control)
      out += fmt::format("\\x{:02X}", static_cast<unsigned char>(text[++i]));
    else if (is_plain_control || code == 0x7F)
      out += fmt::format("\\x{:02X}", code);
    else
      out += text[i];
  }
  return out;
}

}  // namespace musclesim
