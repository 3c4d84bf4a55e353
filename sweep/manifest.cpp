/// Reads and writes manifest.json.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/json_document.h"
#include "musclesim/log/csv.h"
#include "musclesim/version.h"
#include "robots_hash.h"
#include "sweep.h"

namespace musclesim {

namespace fs = std::filesystem;

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* sweep_format = "musclesim-sweep-1";
constexpr std::size_t manifest_limit_bytes = std::size_t{512} << 20;

ordered_json jsonOf(const SweepRow& row) {
  ordered_json object = {{"parameters", ordered_json::object()}};
  for (const auto& [name, value] : row.parameters) object["parameters"][name] = valueJson(value);
  if (!row.command.empty()) object["command"] = row.command;
  return object;
}

std::string manifestText(const Sweep& sweep) {
  const ordered_json head = {{"format", sweep_format},
                             {"program", sweep.program},
                             {"robots_hash", sweep.robots_hash},
                             {"command", sweep.command},
                             {"result_file", sweep.result_file},
                             {"columns", sweep.columns},
                             {"row_time_limit_s", sweep.row_time_limit_s},
                             {"seed", sweep.seed},
                             {"inputs", sweep.inputs}};
  // One row per line, so that people and diff can read it.
  std::string text = head.dump(2);
  text.erase(text.rfind('\n'));
  text += ",\n  \"rows\": [";
  for (std::size_t i = 0; i < sweep.rows.size(); ++i) text += (i ? ",\n    " : "\n    ") + jsonOf(sweep.rows[i]).dump();
  return text + "\n  ]\n}\n";
}

/// Reads the members; an error names the wrong member.
class ManifestReader {
 public:
  ManifestReader(const std::string& text, const std::string& file) : document_(text, file) {}

  Sweep sweep() {
    for (const auto& [member, value] : document_.root().items())
      if (!isKnown(member)) document_.refuse(member, "member " + inQuotes(member) + " is not known in a manifest");
    if (text("format") != sweep_format) document_.refuse("format", fmt::format("format: must be \"{}\"", sweep_format));
    Sweep sweep;
    sweep.program = text("program");
    sweep.robots_hash = text("robots_hash");
    sweep.command = strings("command", member("command"));
    sweep.result_file = text("result_file");
    sweep.columns = strings("columns", member("columns"));
    if (!member("row_time_limit_s").is_number() || !(member("row_time_limit_s").get<double>() >= 0))
      document_.refuse("row_time_limit_s", "row_time_limit_s: must be a number, 0 or larger");
    sweep.row_time_limit_s = member("row_time_limit_s").get<double>();
    if (!member("seed").is_number_unsigned()) document_.refuse("seed", "seed: must be a whole number, 0 or larger");
    sweep.seed = member("seed").get<std::uint64_t>();
    readInputs(sweep);
    readRows(sweep);
    return sweep;
  }

 private:
  static bool isKnown(const std::string& member) {
    for (const char* known :
         {"format", "program", "robots_hash", "command", "result_file", "columns", "row_time_limit_s", "seed", "inputs", "rows"})
      if (member == known) return true;
    return false;
  }

  const json& member(const std::string& name) const {
    const json* found = document_.find(name);
    if (!found) document_.refuse(name, "member \"" + name + "\" is missing");
    return *found;
  }

  std::string text(const std::string& name) const {
    if (!member(name).is_string()) document_.refuse(name, name + ": must be a string");
    return member(name).get<std::string>();
  }

  std::vector<std::string> strings(const std::string& name, const json& list) const {
    std::vector<std::string> result;
    if (!list.is_array()) document_.refuse(name, name + ": must be a list of strings");
    for (const json& entry : list) {
      if (!entry.is_string()) document_.refuse(name, name + ": must be a list of strings");
      result.push_back(entry.get<std::string>());
    }
    return result;
  }

  void readInputs(Sweep& sweep) const {
    if (!member("inputs").is_object()) document_.refuse("inputs", "inputs: must be an object");
    for (const auto& [path, hash] : member("inputs").items()) {
      if (!hash.is_string() || !path.starts_with("inputs/") || path.find("..") != std::string::npos)
        document_.refuse("inputs", "inputs: must hold paths below inputs/ and their hashes");
      sweep.inputs[path] = hash.get<std::string>();
    }
  }

  void readRows(Sweep& sweep) const {
    const json& rows = member("rows");
    if (!rows.is_array() || rows.empty() || rows.size() > most_sweep_rows)
      document_.refuse("rows", fmt::format("rows: must be a list of 1 .. {} rows", most_sweep_rows));
    for (const json& row : rows) sweep.rows.push_back(readRow(row, fmt::format("rows[{}]", sweep.rows.size())));
  }

  SweepRow readRow(const json& row, const std::string& where) const {
    if (!row.is_object() || !row.contains("parameters") || !row["parameters"].is_object())
      document_.refuse("rows", where + ": must be an object with \"parameters\", an object");
    SweepRow result;
    for (const auto& [member, value] : row.items()) {
      if (member == "command")
        result.command = strings("rows", value);
      else if (member != "parameters")
        document_.refuse("rows", fmt::format("{}: member {} is not known", where, inQuotes(member)));
    }
    for (const auto& [name, value] : row["parameters"].items()) {
      if (value.is_number())
        result.parameters.emplace_back(name, value.get<double>());
      else if (value.is_string())
        result.parameters.emplace_back(name, value.get<std::string>());
      else
        document_.refuse("rows", fmt::format("{}: {}: must be a number or a string", where, inQuotes(name)));
    }
    return result;
  }

  JsonDocument document_;
};

void checkRows(const Sweep& sweep) {
  if (sweep.rows.empty() || sweep.rows.size() > most_sweep_rows)
    throw BadParameter("rows", fmt::format("{}", sweep.rows.size()), fmt::format("number 1 .. {}", most_sweep_rows));
  for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
    for (const auto& [name, value] : sweep.rows[i].parameters)
      if (const auto* number = std::get_if<double>(&value); number && !std::isfinite(*number))
        throw BadParameter(fmt::format("row {}: {}", i, name), fmt::format("{}", *number), "be finite");
    if (argumentsOf(sweep, i, "out").empty()) throw BadParameter("command: must name at least a sub-command");
  }
}

}  // namespace

Sweep parseSweep(const std::string& text, const std::string& file) {
  Sweep sweep = ManifestReader(text, file).sweep();
  try {
    checkRows(sweep);
  } catch (const BadParameter& error) {
    throw BadFile(file, error.what());
  }
  return sweep;
}

Sweep readSweep(const std::string& folder) {
  const std::string file = (fs::path(folder) / "manifest.json").string();
  return parseSweep(readTextFile(file, manifest_limit_bytes), file);
}

void writeSweep(Sweep sweep, const std::string& folder) {
  if (sweep.program.empty()) sweep.program = "musclesim " MUSCLESIM_VERSION;
  if (sweep.robots_hash.empty()) sweep.robots_hash = robotsHash();
  checkRows(sweep);
  for (const char* name : {"claims", "workers", "outputs", "results"}) fs::create_directories(fs::path(folder) / name);
  const std::string file = (fs::path(folder) / "manifest.json").string();
  if (!FileReplacement(file, manifestText(sweep)).commitIfAbsent())
    throw BadParameter(folder + ": holds a sweep already; plan into another folder");
}

}  // namespace musclesim
