#include "follow_up.h"

#include <algorithm>
#include <mutex>

#include "../next_experiment.h"
#include "../parallel.h"
#include "judge.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/effects_file.h"
#include "musclesim/error.h"
#include "musclesim/simulation/replay.h"
#include "run.h"
#include "score.h"
#include "seal.h"
#include "sha256.h"
#include "truth.h"

namespace musclesim::blind {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// One answered case and its key.
struct Answered {
  std::string name;
  json key, answer;
  std::vector<Recording> recordings;
};

std::vector<ActiveEffect> lawsOf(const json& key) {
  std::vector<ActiveEffect> laws;
  for (const json& effect : key.at("effects")) {
    ActiveEffect law{effect.at("law"), effect.at("component"), {}};
    for (const auto& [name, value] : effect.at("law_parameters").items()) law.parameters[name] = value.get<double>();
    laws.push_back(std::move(law));
  }
  return laws;
}

/// What the plant measures under other commands.
Recording measuredUnder(Recording schedule, const Answered& one, const std::string& file, std::uint64_t seed) {
  schedule.info.noise_std.clear();
  const Truth truth({schedule}, one.key.at("signals").get<std::vector<std::string>>(),
                    one.key.at("noise_std").get<std::map<std::string, double>>(), seed);
  Recording measured = truth.measured(lawsOf(one.key)).front();
  measured.file = one.name + "/" + file;
  return measured;
}

json diagnosed(std::vector<Recording> recordings, const DiagnosisOptions& options) {
  try {
    const Diagnosis diagnosis = diagnose(std::move(recordings), options);
    return diagnosis.partial ? json() : json::parse(diagnosisJson(diagnosis));
  } catch (const Error& error) {
    return {{"verdict", "failed"}, {"message", error.what()}};
  }
}

DiagnosisOptions oneThread(const FollowUpOptions& options) {
  DiagnosisOptions how;
  how.job_count = 1;
  how.candidates = options.candidates;
  how.interrupted = options.interrupted;
  return how;
}

/// A confident wrong cause is an effect with more than 0.9 that is not in the ambiguity class of the truth.
json leftOut(const Answered& one, const FollowUpOptions& options) {
  constexpr double confident = 0.9;
  DiagnosisOptions how = oneThread(options);
  for (const json& effect : one.key.at("effects")) how.exclude.push_back(effect.at("id"));
  const json answer = diagnosed(one.recordings, how);
  if (answer.is_null()) return answer;
  const Judgement j = judge(one.name, one.key, answer);
  const bool wrong = j.verdict == "effects_found" && j.top_probability > confident && !j.acceptable.value_or(false);
  return {{"verdict", j.verdict},
          {"top", j.top},
          {"top_probability", j.top_probability},
          {"none_of_these", j.none_of_these},
          {"look_alike", j.acceptable.value_or(false)},
          {"confidently_wrong", wrong}};
}

/// The proposed schedule is recorded and comes first; what was held out stays so.
json experimented(const Answered& one, const FollowUpOptions& options) {
  const json& proposed = one.answer.at("next_experiment");
  const Recording schedule =
      experimentSchedule(proposed.at("name").get<std::string>(), proposed.at("amplitude").get<double>(), one.recordings);
  std::vector<Recording> recordings = one.recordings;
  recordings.insert(recordings.begin(), measuredUnder(schedule, one, "next.csv", 1));
  const json answer = diagnosed(std::move(recordings), oneThread(options));
  if (answer.is_null()) return answer;
  const Judgement j = judge(one.name, one.key, answer);
  return {{"schedule", proposed.at("name")},
          {"before", one.answer.at("ambiguity_set")},
          {"after", answer.value("ambiguity_set", json::array())},
          {"verdict", j.verdict},
          {"top", j.top},
          {"top_probability", j.top_probability},
          {"truth_first", j.top1.value_or(false) && j.component.value_or(false)},
          {"alone", j.set_size.value_or(0) <= 1}};
}

double meanSquareOverFloor(const Recording& measured, const Recording& simulated, const json& floors) {
  double sum = 0;
  for (const SignalError& error : compareSignals(measured, simulated)) {
    const double floor = floors.value(error.name, 0.0);
    if (floor > 0) sum += std::max(0.0, error.rmse * error.rmse / (floor * floor) - 1);
  }
  return sum;
}

/// The commands of a recording from the last to the first.
Recording backwards(const Recording& recording) {
  Recording schedule = recording;
  std::erase_if(schedule.signals, [](const Signal& signal) { return !signal.name.starts_with("command_"); });
  for (Signal& command : schedule.signals) std::ranges::reverse(command.values);
  return schedule;
}

/// On a motion that the diagnosis has not seen, of the same kind as what was held out.
json freshShrink(const Answered& one, const fs::path& effects_file) {
  const Recording measured = measuredUnder(backwards(one.recordings.back()), one, "fresh.csv", 2);
  ReplayOptions with;
  with.effects = readEffects(effects_file.string());
  const double before = meanSquareOverFloor(measured, replayRecording(measured).simulated, one.key.at("noise_std")),
               after = meanSquareOverFloor(measured, replayRecording(measured, with).simulated, one.key.at("noise_std"));
  if (before <= 0) return nullptr;
  const double shrink = 100 * (1 - after / before);
  const json &gap = one.answer.at("gap"), &interval = gap.at("shrink_ci95_percent");
  return {{"shrink_percent", shrink},
          {"reported_percent", gap.at("shrink_percent")},
          {"interval_percent", interval},
          {"within", shrink >= interval[0].get<double>() && shrink <= interval[1].get<double>()}};
}

bool isAmbiguous(const Answered& one) {
  const Judgement j = judge(one.name, one.key, one.answer);
  return j.kind == "single" && j.covered.value_or(false) && one.answer.value("ambiguity_set", json::array()).size() > 1 &&
         one.answer.contains("next_experiment");
}

/// Nothing if it was interrupted.
std::optional<json> followed(const Answered& one, const fs::path& folder, const FollowUpOptions& options) {
  json result = json::object();
  if (one.answer.value("verdict", "") == "failed") return result;
  const std::string kind = one.key.at("kind");
  if (kind == "single" || kind == "double") result["left_out"] = leftOut(one, options);
  if (isAmbiguous(one)) result["experiment"] = experimented(one, options);
  if (one.answer.value("verdict", "") == "effects_found") result["fresh"] = freshShrink(one, effectsOf(folder, one.name));
  if (options.interrupted()) return std::nullopt;
  return result;
}

fs::path resultOf(const fs::path& folder, const std::string& name) {
  return folder / "follow_up" / (name + ".json");
}

/// SHA-256 of what is followed up on.
std::string fingerprintOf(const fs::path& folder, const std::string& name) {
  return sha256OfFiles(folder, {"answers/" + name + ".json"});
}

/// It was made from the present answer.
bool isFollowed(const fs::path& folder, const std::string& name) {
  return fs::exists(resultOf(folder, name)) && readObject(resultOf(folder, name)).value("answer_sha256", "") == fingerprintOf(folder, name);
}

json rateOf(const std::vector<json>& entries, const std::string& member) {
  Rate rate;
  for (const json& entry : entries) rate.add(entry.at(member).get<bool>());
  return rateJson(rate);
}

}  // namespace

void followUp(const fs::path& folder, const fs::path& key_file, const FollowUpOptions& options) {
  score(folder, key_file);  // checks all fingerprints
  const json key = readObject(key_file);
  fs::create_directories(folder / "follow_up");
  std::vector<std::string> open;
  for (const std::string& name : caseNames(folder))
    if (!isFollowed(folder, name)) open.push_back(name);
  std::mutex one_at_a_time;
  int done = 0;
  parallelFor(static_cast<int>(open.size()), options.job_count, [&](int i) {
    const std::string& name = open[static_cast<std::size_t>(i)];
    if (options.interrupted()) return;
    const Answered one{name, key.at("cases").at(name), readObject(folder / "answers" / (name + ".json")), recordingsOf(folder, name)};
    auto result = followed(one, folder, options);
    if (!result) return;
    (*result)["answer_sha256"] = fingerprintOf(folder, name);
    writeObject(*result, resultOf(folder, name));
    const std::lock_guard lock(one_at_a_time);
    options.progress(++done, static_cast<int>(open.size()));
  });
}

json followUpTotals(const fs::path& folder) {
  std::map<std::string, std::vector<json>> entries;
  int followed_count = 0;
  for (const std::string& name : caseNames(folder)) {
    if (!isFollowed(folder, name)) continue;
    ++followed_count;
    const json result = readObject(resultOf(folder, name));
    for (const auto& [part, entry] : result.items())
      if (entry.is_object()) entries[part].push_back(entry);
  }
  if (followed_count == 0) return json::object();
  json totals = {{"followed_count", followed_count}};
  for (const auto& [part, member] :
       {std::pair("left_out", "confidently_wrong"), std::pair("left_out", "look_alike"), std::pair("experiment", "truth_first"),
        std::pair("experiment", "alone"), std::pair("fresh", "within")})
    if (!entries[part].empty()) totals[std::string(part) + "_" + member] = rateOf(entries[part], member);
  std::vector<double> difference;
  for (const json& entry : entries["fresh"])
    difference.push_back(std::abs(entry.at("shrink_percent").get<double>() - entry.at("reported_percent").get<double>()));
  if (const auto median = medianOf(difference)) totals["fresh_median_difference_points"] = *median;
  int unexplained = 0;
  for (const json& entry : entries["left_out"]) unexplained += entry.at("verdict") == "unexplained";
  if (!entries["left_out"].empty()) totals["left_out_unexplained"] = rateJson({unexplained, static_cast<int>(entries["left_out"].size())});
  return totals;
}

}  // namespace musclesim::blind
