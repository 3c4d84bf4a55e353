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

}  // namespace musclesim
