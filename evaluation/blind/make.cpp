#include "make.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "../../base/parallel.h"
#include "key.h"
#include "musclesim/base/error.h"
#include "musclesim/base/unique_name.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/robot/robot_file.h"
#include "musclesim/simulation/simulation.h"
#include "plant.h"
#include "seal.h"
#include "sha256.h"
#include "unsealed.h"

namespace musclesim::blind {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// Draws, simulates and writes one case. Returns its key; empty if it was interrupted.
std::optional<json> makeCase(const PlantRequest& request, const fs::path& folder) {
  const auto plant = drawPlant(request);
  if (!plant) return {};
  const std::vector<Recording> recordings = plant->truth.measured(lawsOf(plant->causes));
  fs::create_directories(folder / request.name);
  for (std::size_t i = 0; i < recordings.size(); ++i)
    writeRecording(recordings[i], (folder / request.name / fmt::format("r{}.csv", i + 1)).string());
  Simulation probe;
  return keyOf(*plant, probe.build(request.robot));
}

std::string caseName(int index) {
  return fmt::format("case{:03}", index + 1);
}

/// A random name that does not depend on the seed, so that knowing the seed does not reveal it.
std::string randomKeyName() {
  return uniqueName() + ".json";
}

void requireApart(const fs::path& folder, const fs::path& key_folder, const MakeOptions& options) {
  if (isInReach(key_folder, folder))
    throw BadParameter("--keys", key_folder.string(),
                       "lie where `blind run` does not look: not inside " + folder.string() +
                           ", and not in its parent or the working folder or a folder directly in them");
  for (const std::string& kind : options.kinds) kindOf(kind);   // throws for an unknown one
  for (const std::string& id : options.causes) effectInfo(id);  // the same
  if (options.robots.empty() && options.count > 0) throw BadParameter("--robot", "", "name at least one robot");
  for (const std::string& robot : options.robots) Simulation().build(robot);  // the same
  if (options.count < 0 || options.arm_count < 0 || options.count + options.arm_count < 1)
    throw BadParameter("--count", fmt::format("{} + {}", options.count, options.arm_count), "be at least 1 in all");
  if (!(options.duration_s >= 1)) throw BadParameter("--duration-s", fmt::format("{}", options.duration_s), "be at least 1");
}

/// The call and the program.
json callOf(const MakeOptions& options) {
  json call = programMembers(options.commit);
  call["seed"] = options.seed;
  call["count"] = options.count;
  call["robots"] = options.robots;
  call["arm_count"] = options.arm_count;
  call["duration_s"] = options.duration_s;
  return call;
}

json sealOf(const std::string& key_name, const std::string& key_text, const fs::path& folder, const MakeOptions& options) {
  json seal = callOf(options);
  seal["format"] = "musclesim-blind-1";
  seal["key_file"] = key_name;
  seal["key_sha256"] = sha256(key_text);
  seal["recordings_sha256"] = sha256OfFiles(folder, recordingFiles(folder));
  return seal;
}

/// Robots as the cases name them: by name, or by a copy of their file in the cases' folder, so that this can be moved.
std::vector<std::string> keptRobots(const fs::path& folder, const std::vector<std::string>& robots) {
  std::vector<std::string> result;
  for (const std::string& robot : robots) {
    if (!isRobotFile(robot)) {
      result.push_back(robot);
      continue;
    }
    const fs::path copy = fs::absolute(folder / "robots" / fs::path(robot).filename()).lexically_normal();
    if (std::ranges::find(result, copy.string()) != result.end())
      throw BadParameter("--robot", robot, "have another name than the other files");
    fs::create_directories(copy.parent_path());
    fs::copy_file(robot, copy, fs::copy_options::overwrite_existing);
    result.push_back(copy.string());
  }
  return result;
}

/// The cases of an earlier call, or new ones. Empty if interrupted.
std::optional<json> keptOrMade(int index, const fs::path& folder, const std::vector<std::string>& robots, const UnsealedCases& unsealed,
                               const MakeOptions& options) {
  const std::string name = caseName(index);
  if (auto kept = unsealed.keyOf(name)) return kept;
  fs::remove_all(folder / name);
  const auto robotAt = [&](int i) { return i < options.count ? robots[static_cast<std::size_t>(i) % robots.size()] : std::string("arm"); };
  PlantRequest request{name,         robotAt(index),     0, options.kinds, options.causes, options.exact_numbers, options.duration_s,
                       options.seed, options.interrupted};
  for (int i = 0; i < index; ++i) request.turn += robotAt(i) == robotAt(index) ? 1 : 0;
  auto key = makeCase(request, folder);
  if (key) unsealed.keep(name, *key);
  return key;
}

}  // namespace

fs::path make(const fs::path& folder, const fs::path& key_folder, const MakeOptions& options) {
  requireApart(folder, key_folder, options);
  fs::create_directories(folder);
  fs::create_directories(key_folder);
  json call = callOf(options);
  call["folder"] = fs::weakly_canonical(folder).string();
  call["kinds"] = options.kinds;
  call["causes"] = options.causes;
  call["exact_numbers"] = options.exact_numbers;
  const UnsealedCases unsealed(key_folder, call);
  if (!fs::is_empty(folder) && !unsealed.exist())
    throw BadParameter("folder", folder.string(), "be new or empty, or hold what the same call had made when it was stopped");
  unsealed.begin();
  const std::vector<std::string> robots = keptRobots(folder, options.robots);
  const int case_count = options.count + options.arm_count;
  std::vector<std::optional<json>> keys(static_cast<std::size_t>(case_count));
  std::mutex one_at_a_time;
  int done = 0;
  parallelFor(case_count, options.job_count, [&](int i) {
    if (options.interrupted()) return;
    keys[static_cast<std::size_t>(i)] = keptOrMade(i, folder, robots, unsealed, options);
    const std::lock_guard lock(one_at_a_time);
    options.progress(++done, case_count);
  });
  if (std::ranges::any_of(keys, [](const auto& key) { return !key; })) return {};
  json key = {{"format", "musclesim-blind-key-1"}, {"seed", options.seed}, {"cases", json::object()}};
  for (int i = 0; i < case_count; ++i) key["cases"][caseName(i)] = *keys[static_cast<std::size_t>(i)];
  const fs::path file = key_folder / randomKeyName();
  writeObject(key, file);
  writeObject(sealOf(file.filename().string(), key.dump(2) + "\n", folder, options), folder / "seal.json");
  unsealed.remove();
  return file;
}

}  // namespace musclesim::blind
