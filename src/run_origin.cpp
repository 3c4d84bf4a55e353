#include "run_origin.h"

#include <fmt/format.h>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/hash.h"
#include "musclesim/base/text.h"
#include "musclesim/robot/robot_file.h"
#include "output_folder.h"
#include "program_build.h"

namespace musclesim::command_line {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kept_limit_bytes = std::size_t{512} << 20;  ///< as for tables, the largest inputs

std::string hashOfText(const std::string& text) {
  Hash hash;
  hash.add(text);
  return hash.text();
}

}  // namespace

std::vector<KeptFile> namedFiles(const ModelOptions& model, const RunOptions& options) {
  std::vector<KeptFile> files;
  const auto add = [&](const char* option, const std::string& file) { files.push_back({option, file, "", {}, {}}); };
  if (model.robot && isRobotFile(*model.robot)) add("--robot", *model.robot);
  if (model.config) add("--config", *model.config);
  if (model.effects) add("--effects", *model.effects);
  if (options.commands) add("--commands", *options.commands);
  if (options.targets) add("--targets", *options.targets);
  for (const std::string& plugin : model.plugins) add(plugin_option, plugin);
  return files;
}

namespace {

/// Copies one file; returns the copy's path relative to `base`.
std::string copyOf(const fs::path& file, const std::string& text, const fs::path& base, const fs::path& folder) {
  makeFolder(base / folder);
  const fs::path copy = folder / file.filename();
  replaceFile((base / copy).string(), text);
  return copy.string();
}

void keep(KeptFile& file, const fs::path& base, const fs::path& folder) {
  if (!fs::is_regular_file(file.given)) return;  // a pipe cannot be read again
  const std::string text = readTextFile(file.given, kept_limit_bytes);
  file.hash = hashOfText(text);
  if (file.option == plugin_option) {
    file.given = fs::absolute(file.given).string();
    return;
  }
  const fs::path place = folder / file.option.substr(2);
  file.copy = copyOf(file.given, text, base, place);
  const fs::path sidecar = sidecarPath(file.given);
  if (file.option == "--commands" && fs::is_regular_file(sidecar))
    file.sidecar = copyOf(sidecar, readTextFile(sidecar.string(), kept_limit_bytes), base, place);
}

/// A path in the folder; refuses what leads out of it: the sidecar may come from anywhere.
fs::path inside(const fs::path& folder, const std::string& path, const std::string& sidecar) {
  if (!isWithin(folder.string(), path))
    throw BadFile(sidecar, fmt::format("run: the copy {} must lie within the folder, and be no link that leads elsewhere", inQuotes(path)));
  const fs::path file = folder / fs::path(path).lexically_normal();
  if (!fs::is_regular_file(file))
    throw BadFile(sidecar, fmt::format("run: the copy {} has gone; without it the run cannot be repeated", inQuotes(path)));
  return file;
}

/// Replaces the value of an option, given as "OPTION VALUE" or as "OPTION=VALUE".
void replaceValue(std::vector<std::string>& arguments, const KeptFile& file, const std::string& value) {
  const std::string joined = file.option + "=";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == file.option && i + 1 < arguments.size() && arguments[i + 1] == file.given) arguments[i + 1] = value;
    if (arguments[i] == joined + file.given) arguments[i] = joined + value;
  }
}

}  // namespace

std::string hashOfFile(const fs::path& file) {
  return hashOfText(readTextFile(file.string(), kept_limit_bytes));
}

RunOrigin keepOrigin(const ModelOptions& model, const RunOptions& options, const fs::path& csv) {
  RunOrigin origin{model.arguments, namedFiles(model, options), programBuild()};
  for (KeptFile& file : origin.files) keep(file, csv.parent_path(), csv.stem().string() + "_inputs");
  return origin;
}

json jsonOf(const RunOrigin& origin) {
  json files = json::array();
  for (const KeptFile& file : origin.files) {
    json entry = {{"option", file.option}, {"given", file.given}};
    if (!file.hash.empty()) entry["hash"] = file.hash;
    if (file.copy) entry["copy"] = *file.copy;
    if (file.sidecar) entry["sidecar"] = *file.sidecar;
    files.push_back(entry);
  }
  return {{"arguments", origin.arguments}, {"files", files}, {"build", origin.build}};
}

RunOrigin originFromJson(const json& value, const std::string& sidecar) {
  try {
    RunOrigin origin{value.at("arguments"), {}, value.at("build")};
    for (const json& entry : value.at("files")) {
      KeptFile file{entry.at("option"), entry.at("given"), entry.value("hash", ""), {}, {}};
      if (entry.contains("copy")) file.copy = entry["copy"].get<std::string>();
      if (entry.contains("sidecar")) file.sidecar = entry["sidecar"].get<std::string>();
      origin.files.push_back(file);
    }
    return origin;
  } catch (const json::exception& error) {
    throw BadFile(sidecar, fmt::format("the member \"run\" must be as this program writes it: {}", error.what()));
  }
}

std::vector<std::string> argumentsWithCopies(const RunOrigin& origin, const fs::path& folder, const std::string& sidecar) {
  std::vector<std::string> arguments = origin.arguments;
  for (const KeptFile& file : origin.files) {
    if (file.sidecar) inside(folder, *file.sidecar, sidecar);
    if (file.copy) replaceValue(arguments, file, inside(folder, *file.copy, sidecar).string());
  }
  return arguments;
}

}  // namespace musclesim::command_line
