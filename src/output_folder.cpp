#include "output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "musclesim/base/error.h"
#include "musclesim/log/recording.h"

namespace musclesim::command_line {

namespace fs = std::filesystem;

fs::path freshFolder(const std::string& label) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y-%m-%d-%H%M%S", &local);
  const fs::path first = fs::path("log") / "runs" / fmt::format("{}-{}", stamp, label);
  fs::path folder = first;
  for (int i = 2; fs::exists(folder); ++i) folder = fmt::format("{}-{}", first.string(), i);
  return folder;
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(fmt::format("{}: the folder cannot be made: {}", folder.string(), error.message()));
}

fs::path outputFolder(const std::optional<std::string>& given, const std::string& label) {
  const fs::path folder = given ? fs::path(*given) : freshFolder(label);
  makeFolder(folder);
  return folder;
}

void requireWritable(const fs::path& folder) {
  if (access(folder.c_str(), W_OK | X_OK) != 0) throw IoError(fmt::format("{}: the folder is not writable", folder.string()));
}

bool prepareRecording(const fs::path& csv) {
  if (csv.extension() != ".csv") throw BadParameter("recording", csv.string(), "end in .csv");
  if (!csv.has_parent_path() || fs::exists(csv.parent_path())) return false;
  makeFolder(csv.parent_path());
  return true;
}

void requireUnfinished(const fs::path& csv) {
  std::ifstream text(sidecarPath(csv.string()));
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_object() && json.value("complete", nlohmann::json()) == true)
    throw BadParameter(fmt::format("{} holds a finished run: choose another folder, or --overwrite it", csv.parent_path().string()));
}

void requireOther(const fs::path& output, const std::vector<std::string>& inputs) {
  std::error_code ignored;
  for (const std::string& input : inputs)
    if (fs::equivalent(output, input, ignored))
      throw BadParameter(fmt::format("{} is an input and would be overwritten: choose another name or folder for the output", input));
}

}  // namespace musclesim::command_line
