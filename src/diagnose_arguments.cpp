#include "diagnose_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "json_differences.h"
#include "musclesim/base/error.h"
#include "musclesim/base/hash.h"
#include "musclesim/base/text.h"
#include "musclesim/version.h"
#include "program_build.h"
#include "run_origin.h"

namespace musclesim::command_line {

namespace {

constexpr const char* hash_mark = "hash ";  ///< before values that a user cannot read

std::string markedHash(const Hash& hash) {
  return hash_mark + hash.text();
}

std::string hashOf(const Recording& recording) {
  Hash hash;
  hash.add(sidecarText(recording.info));
  for (const double time : recording.time_s) hash.add(time);
  for (const Signal& signal : recording.signals) {
    hash.add(signal.name);
    for (const double value : signal.values) hash.add(value);
  }
  return markedHash(hash);
}

std::string hashOf(const std::optional<std::string>& file) {
  return file ? hash_mark + hashOfFile(*file) : "none";
}

nlohmann::json optionsOf(const ModelOptions& model, const DiagnoseArguments& arguments) {
  nlohmann::json options = {{"--smallest-gap-percent", arguments.smallest_gap_percent},
                            {"--max-effects", arguments.max_effects},
                            {"--candidates", fmt::format("{}", fmt::join(arguments.candidates, ","))},
                            {"--exclude", fmt::format("{}", fmt::join(arguments.exclude, ","))},
                            {"--tune", fmt::format("{}", fmt::join(arguments.tune, ","))},
                            {"--skip-start", arguments.skip_start_s ? fmt::format("{:g}", *arguments.skip_start_s) : "by recording"},
                            {"--effects", hashOf(model.effects)},
                            {"--fixed-effects", hashOf(arguments.fixed_effects)},
                            {"--stepper", model.stepper},
                            {"--substeps", model.substeps.value_or(0)},
                            {"--seed", model.seed.value_or(1)}};
  for (const std::string& plugin : model.plugins) options[std::string(plugin_option) + " " + plugin] = hashOf(plugin);
  return options;
}

std::string wordsOf(const JsonDifference& difference) {
  const std::string mark = std::string("\"") + hash_mark;
  if (difference.before.starts_with(mark) && difference.now.starts_with(mark)) return difference.name + " is another";
  return fmt::format("{} was {}, is {}", difference.name, difference.before, difference.now);
}

}  // namespace

std::string diagnosisOrigin(const std::vector<Recording>& recordings, const RecordingInfo& plant, const ModelOptions& model,
                            const DiagnoseArguments& arguments) {
  nlohmann::json origin = {{"model", nlohmann::json::parse(sidecarText(plant))}, {"options", optionsOf(model, arguments)}};
  nlohmann::json& given = origin["recordings"] = {{"number", recordings.size()}};
  for (std::size_t i = 0; i < recordings.size(); ++i) given[std::to_string(i + 1)] = hashOf(recordings[i]);
  nlohmann::json& program = origin["program"] = {{"version", MUSCLESIM_VERSION}};
  for (const auto& [name, id] : programBuild()) program[name == "program" ? "build" : name] = hash_mark + id;
  return origin.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void requireSameOrigin(const std::string& kept, const std::string& now, const std::string& folder) {
  std::vector<std::string> words;
  for (const JsonDifference& difference : differencesOf(nlohmann::json::parse(kept, nullptr, false), nlohmann::json::parse(now)))
    words.push_back(wordsOf(difference));
  if (words.empty()) return;
  throw BadParameter(fmt::format("--resume: the unfinished diagnosis in {} is another: {}. Without --resume it is begun anew", folder,
                                 fmt::join(words, "; ")));
}

}  // namespace musclesim::command_line
