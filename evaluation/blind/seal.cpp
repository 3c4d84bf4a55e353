#include "seal.h"

#include <algorithm>
#include <fstream>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/json_document.h"
#include "musclesim/version.h"
#include "sha256.h"

namespace musclesim::blind {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t limit_bytes = std::size_t{64} << 20;
constexpr auto skipping = fs::directory_options::skip_permission_denied;

bool isReadable(const fs::path& file) {
  return std::ifstream(file).good();
}

fs::path plain(const fs::path& path) {
  return fs::weakly_canonical(fs::absolute(path));
}

/// DIR's parent and the working folder.
std::vector<fs::path> surroundings(const fs::path& folder) {
  return {plain(folder).parent_path(), plain(fs::current_path())};
}

bool isInside(const fs::path& inner, const fs::path& outer) {
  const auto difference = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  return difference.first == outer.end();
}

}  // namespace

nlohmann::json readObject(const fs::path& file) {
  return JsonDocument(readTextFile(file.string(), limit_bytes), file.string()).root();
}

void writeObject(const nlohmann::json& object, const fs::path& file) {
  replaceFile(file.string(), object.dump(2) + "\n");
}

nlohmann::json readSeal(const fs::path& folder) {
  const fs::path file = folder / "seal.json";
  const nlohmann::json seal = readObject(file);
  if (seal.value("format", "") != "musclesim-blind-1") throw BadFile(file.string(), "\"format\" must be \"musclesim-blind-1\"");
  for (const char* member : {"key_file", "key_sha256", "recordings_sha256"})
    if (!seal.contains(member) || !seal[member].is_string())
      throw BadFile(file.string(), std::string("there is no text \"") + member + "\"");
  return seal;
}

std::vector<std::string> caseNames(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_directory() && entry.path().filename().string().starts_with("case")) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

std::vector<std::string> recordingFiles(const fs::path& folder) {
  std::vector<std::string> files;
  for (const std::string& name : caseNames(folder))
    for (const auto& entry : fs::directory_iterator(folder / name)) files.push_back(name + "/" + entry.path().filename().string());
  std::ranges::sort(files);
  return files;
}

std::optional<fs::path> keyInReach(const std::string& key_name, const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder, skipping))
    if (entry.path().filename() == key_name && isReadable(entry.path())) return entry.path();
  for (const fs::path& near : surroundings(folder)) {
    if (isReadable(near / key_name)) return near / key_name;
    for (const auto& entry : fs::directory_iterator(near, skipping))
      if (entry.is_directory() && isReadable(entry.path() / key_name)) return entry.path() / key_name;
  }
  return std::nullopt;
}

bool isInReach(const fs::path& key_folder, const fs::path& folder) {
  const fs::path key = plain(key_folder / "x").parent_path(), cases = plain(folder / "x").parent_path();
  if (isInside(key, cases)) return true;
  return std::ranges::any_of(surroundings(cases), [&](const fs::path& near) { return key == near || key.parent_path() == near; });
}

nlohmann::json programMembers(const std::string& commit) {
  nlohmann::json members = {{"program", "musclesim " MUSCLESIM_VERSION}, {"program_sha256", sha256OfProgram()}};
  if (!commit.empty()) members["commit"] = commit;
  return members;
}

}  // namespace musclesim::blind
