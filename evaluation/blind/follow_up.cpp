#include "follow_up.h"

#include <algorithm>
#include <mutex>

#include "../../base/parallel.h"
#include "../../diagnosis/planning/schedule.h"
#include "follow_up_files.h"
#include "judge.h"
#include "kind.h"
#include "musclesim/base/error.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/effects_file.h"
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

std::vector<ActiveEffect> lawsIn(const json& key) {
  std::vector<ActiveEffect> laws;
  for (const json& effect : key.at("effects")) {
    ActiveEffect law{effect.at("law"), effect.at("component"), {}};
    for (const auto& [name, value] : effect.at("law_parameters").items()) law.parameters[name] = value.get<double>();
    laws.push_back(std::move(law));
  }
  return laws;
}

/// Measurements of the plant under other commands.
Recording measuredUnder(Recording schedule, const Answered& one, const std::string& file, std::uint64_t seed) {
  schedule.info.noise_std.clear();
  const Truth truth({schedule}, one.key.at("signals").get<std::vector<std::string>>(),
                    one.key.at("noise_std").get<std::map<std::string, double>>(), seed,
                    one.key.value("numbers_true", std::map<std::string, double>()));
  Recording measured = truth.measured(lawsIn(one.key)).front();
  measured.file = one.name + "/" + file;
  return measured;
}

json diagnosed(std::vector<Recording> recordings, const DiagnosisOptions& options) {
  try {
    const Diagnosis diagnosis = diagnose(std::move(recordings), options);
    if (diagnosis.partial) return nullptr;
    json answer = json::parse(diagnosisJson(diagnosis));
    for (const char* part : {"cost", "fitted"}) answer.erase(part);
    return answer;
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

json leftOut(const Answered& one, const FollowUpOptions& options) {
  DiagnosisOptions how = oneThread(options);
  for (const json& effect : one.key.at("effects")) how.exclude.push_back(effect.at("id"));
  return diagnosed(one.recordings, how);
}

/// The answer after recording the proposed schedule, which comes first so that the held-out recording stays the last.
json experimented(const Answered& one, const FollowUpOptions& options) {
  if (!one.answer.contains("next_experiment")) return {{"verdict", "failed"}, {"message", "no schedule was proposed"}};
  const json& proposed = one.answer["next_experiment"];
  const ScheduleChoice choice{proposed.at("name").get<std::string>(), proposed.at("amplitude").get<double>(), proposed.value("level", 0.0)};
  const Recording schedule = scheduled(choice, one.recordings);
  std::vector<Recording> recordings = one.recordings;
  recordings.insert(recordings.begin(), measuredUnder(schedule, one, "next.csv", 1));
  return diagnosed(std::move(recordings), oneThread(options));
}

double meanSquareOverNoise(const Recording& measured, const Recording& simulated, const json& sigmas) {
  double sum = 0;
  for (const SignalError& error : compareSignals(measured, simulated)) {
    const double sigma = sigmas.value(error.name, 0.0);
    if (sigma > 0) sum += std::max(0.0, error.rmse * error.rmse / (sigma * sigma) - 1);
  }
  return sum;
}

/// The commands of a recording in reverse order.
Recording backwards(const Recording& recording) {
  Recording schedule = recording;
  std::erase_if(schedule.signals, [](const Signal& signal) { return !signal.name.starts_with("command_"); });
  for (Signal& command : schedule.signals) std::ranges::reverse(command.values);
  return schedule;
}

/// The numbers of the model that the answer fits together with its effects.
Parameters fittedNumbers(const json& answer) {
  Parameters numbers;
  for (const json& number : answer.value("numbers", json::array()))
    numbers.set(number.at("name").get<std::string>(), number.at("value").get<double>(), "answer");
  return numbers;
}

/// Gap reduction by the answer's effects and numbers on a motion that the diagnosis has not seen, of the same kind as the held-out one.
json freshReduction(const Answered& one, const fs::path& effects_file) {
  const Recording measured = measuredUnder(backwards(one.recordings.back()), one, "fresh.csv", 2);
  ReplayOptions with;
  with.effects = readEffects(effects_file.string());
  with.parameters = fittedNumbers(one.answer);
  const ReplayResult without = replayRecording(measured), added = replayRecording(measured, with);
  const double before = meanSquareOverNoise(measured, without.simulated, one.key.at("noise_std")),
               after = meanSquareOverNoise(measured, added.simulated, one.key.at("noise_std"));
  if (before <= 0) return nullptr;
  const json& gap = one.answer.at("gap");
  json result = {{"shrink_percent", 100 * (1 - after / before)},
                 {"reported_percent", gap.at("shrink_percent")},
                 {"diverged", added.divergence.has_value()}};
  if (gap.contains("shrink_ci95_percent")) result["interval_percent"] = gap["shrink_ci95_percent"];
  return result;
}

/// Empty if it was interrupted.
std::optional<json> followed(const Answered& one, const fs::path& folder, const FollowUpOptions& options) {
  json result = json::object();
  if (one.answer.value("verdict", "") == "failed") return result;
  const Kind& kind = kindOf(one.key.at("kind"));
  auto put = [&](const char* part, const json& found) {
    if (!found.is_null()) result[part] = found;
  };
  if (kind.most_known > 0 && !kind.unknown) put("left_out", leftOut(one, options));
  if (isAmbiguous(judge(one.name, one.key, one.answer))) put("experiment", experimented(one, options));
  if (one.answer.value("verdict", "") == "effects_found") put("fresh", freshReduction(one, effectsOf(folder, one.name)));
  if (options.interrupted()) return std::nullopt;
  return result;
}

/// The members that say how a file was made.
json origin(const FollowUpOptions& options) {
  json members = programMembers("");
  members["candidates"] = options.candidates;
  return members;
}

}  // namespace

void followUp(const fs::path& folder, const fs::path& key_file, const FollowUpOptions& options) {
  score(folder, key_file);  // checks all fingerprints
  const json key = readObject(key_file), members = origin(options);
  fs::create_directories(folder / "follow_up");
  std::vector<std::string> open;
  for (const std::string& name : caseNames(folder))
    if (isFollowed(folder, name))
      requireSameProgram(followUpFile(folder, name), members);
    else
      open.push_back(name);
  std::mutex one_at_a_time;
  int done = 0;
  parallelFor(static_cast<int>(open.size()), options.job_count, [&](int i) {
    const std::string& name = open[static_cast<std::size_t>(i)];
    if (options.interrupted()) return;
    const Answered one{name, key.at("cases").at(name), readObject(folder / "answers" / (name + ".json")), recordingsOf(folder, name)};
    auto result = followed(one, folder, options);
    if (!result) return;
    result->update(members);
    (*result)["answer_sha256"] = answerFingerprint(folder, name);
    writeObject(*result, followUpFile(folder, name));
    const std::lock_guard lock(one_at_a_time);
    options.progress(++done, static_cast<int>(open.size()));
  });
}

}  // namespace musclesim::blind
