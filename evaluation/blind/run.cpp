#include "run.h"

#include <fmt/format.h>

#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

#include "../../base/parallel.h"
#include "musclesim/base/error.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/effect/effects_file.h"
#include "musclesim/log/recording.h"
#include "seal.h"
#include "sha256.h"

namespace musclesim::blind {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

fs::path answerOf(const fs::path& folder, const std::string& name) {
  return folder / "answers" / (name + ".json");
}

fs::path costOf(const fs::path& folder, const std::string& name) {
  return folder / "answers" / (name + ".cost.json");
}

}  // namespace

fs::path effectsOf(const fs::path& folder, const std::string& name) {
  return folder / "answers" / (name + ".effects.json");
}

std::vector<Recording> recordingsOf(const fs::path& folder, const std::string& name) {
  std::vector<Recording> recordings;
  for (const std::string& file : recordingFiles(folder)) {
    if (!file.starts_with(name + "/") || !file.ends_with(".csv")) continue;
    recordings.push_back(readRecording((folder / file).string()));
    recordings.back().file = file;
  }
  return recordings;
}

namespace {

/// The answer; empty if it was interrupted.
std::optional<json> answered(const fs::path& folder, const std::string& name, const RunOptions& options) {
  DiagnosisOptions how;
  how.candidates = options.candidates;
  for (const std::string& part : options.leave_out) how.left_out.insert(methodPartNamed(part));
  how.job_count = 1;
  how.interrupted = options.interrupted;
  try {
    const Diagnosis diagnosis = diagnose(recordingsOf(folder, name), how);
    if (diagnosis.partial) return std::nullopt;
    writeEffects(diagnosis.chosen_effects, effectsOf(folder, name).string());
    json answer = json::parse(diagnosisJson(diagnosis));
    answer["cost"].erase("wall_s");  // differs between runs
    return answer;
  } catch (const BadParameter& error) {
    return json{{"verdict", "failed"}, {"message", error.what()}};
  } catch (const BadFile& error) {
    return json{{"verdict", "failed"}, {"message", error.what()}};
  } catch (const Diverged& error) {
    return json{{"verdict", "failed"}, {"message", error.what()}};
  }
}

json costMembers(const RunOptions& options) {
  json members = programMembers(options.commit);
  members["candidates"] = options.candidates;
  members["left_out"] = options.leave_out;
  return members;
}

bool isAnswered(const fs::path& folder, const std::string& name) {
  return fs::exists(answerOf(folder, name)) && fs::exists(costOf(folder, name));
}

/// Returns whether there is an answer now.
bool answer(const fs::path& folder, const std::string& name, const RunOptions& options, json members) {
  if (isAnswered(folder, name)) return true;
  if (options.interrupted()) return false;
  const auto start = std::chrono::steady_clock::now();
  const auto found = answered(folder, name, options);
  if (!found) return false;
  members["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  writeObject(*found, answerOf(folder, name));
  writeObject(members, costOf(folder, name));
  return true;
}

/// The commits noted when the answers were made.
std::string commitsOf(const fs::path& folder, const std::vector<std::string>& names) {
  std::set<std::string> commits;
  for (const std::string& name : names) commits.insert(readObject(costOf(folder, name)).value("commit", ""));
  commits.erase("");
  return fmt::format("{}", fmt::join(commits, ", "));
}

void writeSummary(const fs::path& folder, const std::vector<std::string>& names, json members) {
  members["format"] = "musclesim-blind-answers-1";
  members["answers_sha256"] = sha256OfFiles(folder, answerFiles(folder));
  if (const std::string commits = commitsOf(folder, names); !commits.empty()) members["commit"] = commits;
  for (const std::string& name : names) members["seconds"][name] = readObject(costOf(folder, name)).at("seconds");
  writeObject(members, folder / "answers.json");
}

}  // namespace

std::vector<std::string> answerFiles(const fs::path& folder) {
  std::vector<std::string> files;
  for (const std::string& name : caseNames(folder)) {
    files.push_back("answers/" + name + ".json");
    if (fs::exists(effectsOf(folder, name))) files.push_back("answers/" + name + ".effects.json");
  }
  return files;
}

void requireSameProgram(const fs::path& file, const json& members) {
  const json made = readObject(file);
  for (const char* member : {"program_sha256", "candidates", "left_out"})
    if (members.contains(member) && made.value(member, json()) != members.at(member))
      throw BadParameter(
          fmt::format("{}: was made with another {}; remove {} to begin again", file.string(), member, file.parent_path().string()));
}

RunSummary run(const fs::path& folder, const RunOptions& options) {
  for (const std::string& id : options.candidates) effectInfo(id);  // throws for an unknown one
  for (const std::string& part : options.leave_out) methodPartNamed(part);
  const json seal = readSeal(folder);
  const std::string key_file = seal["key_file"];
  if (const auto key = keyInReach(key_file, folder))
    throw BadParameter(fmt::format("{}: the key can be read; move it away before the cases are diagnosed", key->string()));
  const std::vector<std::string> names = caseNames(folder);
  const json members = costMembers(options);
  fs::create_directories(folder / "answers");
  RunSummary summary{0, static_cast<int>(names.size())};
  std::vector<std::string> open;
  for (const std::string& name : names) {
    if (isAnswered(folder, name)) {
      requireSameProgram(costOf(folder, name), members);
      ++summary.answered;
    } else {
      open.push_back(name);
    }
  }
  std::mutex one_at_a_time;
  int done_now = 0;
  parallelFor(static_cast<int>(open.size()), options.job_count, [&](int i) {
    if (!answer(folder, open[static_cast<std::size_t>(i)], options, members)) return;
    const std::lock_guard lock(one_at_a_time);
    ++summary.answered;
    options.progress(++done_now, static_cast<int>(open.size()));
  });
  for (const std::string& name : names)
    if (isAnswered(folder, name) && readObject(answerOf(folder, name)).value("verdict", "") == "failed") ++summary.failed;
  // Existing seals are kept; only new answers make a new one.
  if (summary.complete() && (done_now > 0 || !fs::exists(folder / "answers.json"))) writeSummary(folder, names, members);
  return summary;
}

}  // namespace musclesim::blind
