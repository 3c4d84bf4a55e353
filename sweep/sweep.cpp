#include "sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/hash.h"
#include "musclesim/log/recording.h"

namespace musclesim {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t input_limit_bytes = std::size_t{512} << 20;
constexpr std::size_t most_arguments = 1000, most_argument_bytes = 4096;

/// The names in braces of one argument, with the text around them.
class Template {
 public:
  Template(const SweepRow& row, std::size_t number, const std::string& out_folder) : row_(row), number_(number), out_(out_folder) {}

  std::string substituted(const std::string& argument) {
    std::string text;
    std::size_t at = 0;
    for (auto open = argument.find('{'); open != std::string::npos; open = argument.find('{', at)) {
      const auto close = argument.find('}', open);
      if (close == std::string::npos) throw BadParameter("command: \"" + argument + "\" has a { without }");
      text += argument.substr(at, open - at) + valueOf(argument.substr(open + 1, close - open - 1));
      at = close + 1;
    }
    return text + argument.substr(at);
  }

  bool used(const std::string& name) const { return used_.contains(name); }

 private:
  std::string valueOf(const std::string& name) {
    if (name == "out") return out_;
    if (name == "row") return rowName(number_);
    const auto found = std::find_if(row_.parameters.begin(), row_.parameters.end(), [&](const auto& p) { return p.first == name; });
    if (found == row_.parameters.end()) refuse(name);
    used_.insert(name);
    return valueText(found->second);
  }

  [[noreturn]] void refuse(const std::string& name) const {
    std::vector<std::string> names = {"out", "row"};
    for (const auto& parameter : row_.parameters) names.push_back(parameter.first);
    throw BadParameter("command: {" + name + "}", name, fmt::format("be one of {}", fmt::join(names, ", ")));
  }

  const SweepRow& row_;
  std::size_t number_;
  std::string out_;
  std::set<std::string> used_;
};

void copyInput(Sweep& sweep, const fs::path& folder, const std::string& from, const std::string& to) {
  const std::string text = readTextFile(from, input_limit_bytes);
  Hash hash;
  hash.add(text);
  sweep.inputs[to] = hash.text();
  fs::create_directories(folder / "inputs");
  replaceFile((folder / to).string(), text);
}

}  // namespace

std::string rowName(std::size_t row) {
  return fmt::format("{:06}", row);
}

std::string valueText(const Parameter::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return std::get<std::string>(value);
}

nlohmann::ordered_json valueJson(const Parameter::Value& value) {
  constexpr double largest_whole = 1e15;
  const auto* number = std::get_if<double>(&value);
  if (!number) return std::get<std::string>(value);
  if (*number == std::round(*number) && std::abs(*number) < largest_whole) return static_cast<std::int64_t>(*number);
  return *number;
}

std::vector<std::string> argumentsOf(const Sweep& sweep, std::size_t number, const std::string& out_folder) {
  const SweepRow& row = sweep.rows.at(number);
  const auto& command = row.command.empty() ? sweep.command : row.command;
  Template substitution(row, number, out_folder);
  std::vector<std::string> arguments;
  for (const std::string& argument : command) arguments.push_back(substitution.substituted(argument));
  for (const auto& [name, value] : row.parameters) {
    if (substitution.used(name)) continue;
    if (name.find('.') == std::string::npos && name != "repeat")
      throw BadParameter(fmt::format("parameter {}: the command does not use it; write {{{}}} where it belongs", name, name));
    if (name.find('.') == std::string::npos) continue;
    arguments.insert(arguments.end(), {"--set", name + "=" + valueText(value)});
  }
  if (arguments.size() > most_arguments)
    throw BadParameter("command", fmt::format("{} arguments", arguments.size()), fmt::format("have at most {}", most_arguments));
  for (const std::string& argument : arguments)
    if (argument.size() > most_argument_bytes || argument.find('\0') != std::string::npos)
      throw BadParameter(fmt::format("command: an argument has {} bytes, or contains a NUL; at most {} bytes are allowed", argument.size(),
                                     most_argument_bytes));
  return arguments;
}

std::string addInput(Sweep& sweep, const std::string& folder, const std::string& file) {
  const fs::path source(file);
  std::size_t number = 0;
  std::string path;
  do path = fmt::format("inputs/{:03}-{}", number++, source.filename().string());
  while (sweep.inputs.contains(path));
  copyInput(sweep, folder, file, path);
  if (source.extension() == ".csv" && fs::exists(sidecarPath(file))) copyInput(sweep, folder, sidecarPath(file), sidecarPath(path));
  return path;
}

}  // namespace musclesim
