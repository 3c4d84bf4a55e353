#include "encoding.h"

#include <fmt/format.h>
#include <iconv.h>

#include <array>
#include <cerrno>
#include <memory>

#include "musclesim/base/error.h"
#include "musclesim/base/text.h"

namespace musclesim {

namespace {

using Converter = std::unique_ptr<void, int (*)(iconv_t)>;

/// An open converter, or none if one of the encodings is unknown.
Converter openConverter(const std::string& from) {
  const iconv_t converter = iconv_open("UTF-8", from.c_str());
  return {converter == reinterpret_cast<iconv_t>(-1) ? nullptr : converter, iconv_close};
}

/// Appends the converted text. Returns the offset of the first byte that is wrong, or npos.
std::size_t convert(iconv_t converter, std::string& text, std::string& result) {
  std::array<char, std::size_t{1} << 16> buffer;
  char* in = text.data();
  std::size_t in_left = text.size();
  while (in_left > 0) {
    char* out = buffer.data();
    std::size_t out_left = buffer.size();
    const bool failed = iconv(converter, &in, &in_left, &out, &out_left) == static_cast<std::size_t>(-1);
    result.append(buffer.data(), buffer.size() - out_left);
    if (failed && errno != E2BIG) return text.size() - in_left;
  }
  return std::string::npos;
}

bool hasUtf16Mark(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

}  // namespace

bool isUtf8(std::string_view text) {
  std::string copy(text), result;
  return convert(openConverter("UTF-8").get(), copy, result) == std::string::npos;
}

std::string toUtf8(std::string text, const std::string& encoding, const std::string& file) {
  if (encoding.empty() && !hasUtf16Mark(text)) return text;
  const std::string from = encoding.empty() ? "UTF-16" : encoding;
  const Converter converter = openConverter(from);
  if (!converter) throw BadFile(file, fmt::format("the encoding {} is unknown; iconv -l lists those that are known", inQuotes(from)));
  std::string result;
  result.reserve(text.size());
  const std::size_t wrong = convert(converter.get(), text, result);
  if (wrong == std::string::npos) return result;
  const TextPlace place = placeInText(text, wrong);
  throw BadFile(
      file, place.line, place.column,
      fmt::format("the byte \\x{:02X} does not exist in the encoding {}", static_cast<unsigned char>(text[wrong]), inQuotes(from)));
}

}  // namespace musclesim
