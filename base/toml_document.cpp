#include "toml_document.h"

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {

namespace {

constexpr std::size_t file_limit_bytes = std::size_t{1} << 20;

}  // namespace

toml::table parseToml(const std::string& text, const std::string& file) {
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
