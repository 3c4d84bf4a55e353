#include "toml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {

namespace {

constexpr std::size_t file_limit_bytes = std::size_t{1} << 20;

/// The offset behind a string that begins with the quote at `at`: a single one, or three for a string of several lines.
std::size_t endOfString(const std::string& text, std::size_t at) {
  const char quote = text[at];
  const std::string long_quotes(3, quote);
  const bool is_long = text.compare(at, 3, long_quotes) == 0;
  const std::string end = is_long ? long_quotes : std::string(1, quote);
  for (std::size_t i = at + end.size(); i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\')
      ++i;
    else if (text.compare(i, end.size(), end) == 0)
      return i + end.size();
    else if (!is_long && text[i] == '\n')
      return i;
  }
  return text.size();
}

/// Refuses keys like a.b.c... with thousands of parts: each part is a table within a table, and toml++ goes through these by recursion, for
/// which the stack has no room. (For brackets it has a limit of its own.)
void refuseDeepKeys(const std::string& text, const std::string& file) {
  constexpr int most_dots = 100;
  int dots = 0, line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      const std::size_t end = endOfString(text, i);
      line += static_cast<int>(
          std::count(text.begin() + static_cast<std::ptrdiff_t>(i), text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      i = end - 1;
      continue;
    }
    if (c == '#') i = std::min(text.find('\n', i), text.size()) - 1;
    const bool is_of_a_key = std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == ' ' || c == '\t' || c == '#';
    if (c == '.' && ++dots > most_dots) throw BadFile(file, line, 0, fmt::format("a key has more than {} parts", most_dots));
    if (c != '.' && !is_of_a_key) dots = 0;
    line += c == '\n';
  }
}

}  // namespace

toml::table parseToml(const std::string& text, const std::string& file) {
  refuseDeepKeys(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const auto place = error.source().begin;
    throw BadFile(file, static_cast<int>(place.line), static_cast<int>(place.column), std::string(error.description()));
  }
}

toml::table readToml(const std::string& file) {
  return parseToml(readTextFile(file, file_limit_bytes), file);
}

}  // namespace musclesim
