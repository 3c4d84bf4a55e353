#include "musclesim/base/error.h"

#include <fmt/format.h>

namespace musclesim {

namespace {

std::string placeInFile(const std::string& file, int line, int column) {
  if (line == 0) return file;
  if (column == 0) return fmt::format("{}:{}", file, line);
  return fmt::format("{}:{}:{}", file, line, column);
}

/// A file may hold words and lists of any length; a message is for reading.
std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 2000;
  return text.size() > longest ? text.substr(0, longest) + " ..." : text;
}

}  // namespace

BadFile::BadFile(const std::string& file, int line, int column, const std::string& what)
    : Error(placeInFile(file, line, column) + ": " + shortened(what)), file_(file), line_(line), column_(column) {}

Diverged::Diverged(double time_s, const std::string& where, const std::string& what)
    : Error(fmt::format("the simulation diverged at {:.6g} s: {}: {}", time_s, where, what)), time_s_(time_s), where_(where) {}

}  // namespace musclesim
