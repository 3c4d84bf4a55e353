/// `musclesim blind make`, `run`, `score`, `follow` and `calibrate`: the check of the diagnosis on withheld causes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "evaluation/blind/benchmark.h"
#include "evaluation/blind/calibrate.h"
#include "evaluation/blind/follow_up.h"
#include "evaluation/blind/make.h"
#include "evaluation/blind/page.h"
#include "evaluation/blind/run.h"
#include "evaluation/blind/score.h"
#include "evaluation/blind/seal.h"
#include "interrupt.h"
#include "progress.h"

namespace musclesim::command_line {

namespace {

struct MakeArguments {
  std::string folder, keys;
  blind::MakeOptions make;
  bool quiet = false;
};

int makeCases(MakeArguments& arguments) {
  CaseProgress progress(arguments.quiet);
  arguments.make.interrupted = [] { return interruptSignal() != 0; };
  arguments.make.progress = [&](int done, int count) { progress.show(done, count); };
  const auto key = blind::make(arguments.folder, arguments.keys, arguments.make);
  if (key.empty()) {
    fmt::print(stderr, "musclesim: interrupted; the key is not written yet; repeat the same command to make the missing cases\n");
    return interrupted_base + interruptSignal();
  }
  fmt::print("cases   {}\nkey     {}\nseal    {}/seal.json\n", arguments.make.count + arguments.make.arm_count, key.string(),
             arguments.folder);
  return done;
}

Action addMake(CLI::App& command) {
  auto arguments = std::make_shared<MakeArguments>();
  command.add_option("folder", arguments->folder, "New folder for the cases and the seal")->required();
  command.add_option("--keys", arguments->keys, "Folder for the key; `blind run` must not be able to read it")->required();
  command.add_option("--count", arguments->make.count, "Number of cases on the robots in turn (default 120)");
  addList(command, "--robot", arguments->make.robots, "Robots that take turns: names or files NAME.toml (default: rig,elbow,wrist)");
  command.add_option("--arm-count", arguments->make.arm_count, "Number of further cases on the arm (default 12)");
  command.add_option("--seed", arguments->make.seed, "Seed of all random choices (default 1)");
  command.add_option("--duration-s", arguments->make.duration_s,
                     "Length of each recording in s (default 6); recordings of the arm have half of it");
  addList(command, "--kinds", arguments->make.kinds,
          "Only these kinds, equally often: null, single, double, triple, quadruple (4 or 5 causes), mixed (known beside unknown), open "
          "(unknown)");
  addList(command, "--causes", arguments->make.causes, "Draw causes from these effects of the catalogue only (default: all, in turn)");
  command.add_flag("--exact-numbers", arguments->make.exact_numbers,
                   "The plants have just the model's masses, inertias, friction and constants");
  command.add_option("--jobs", arguments->make.job_count, "Threads (default: one per core); the cases do not depend on it")
      ->check(CLI::Range(1, 1024));
  command.add_option("--commit", arguments->make.commit, "Version of the sources, to be noted in the seal");
  command.add_flag("--quiet", arguments->quiet, "No progress line");
  return [arguments] { return makeCases(*arguments); };
}

struct RunArguments {
  std::string folder;
  blind::RunOptions run;
  bool quiet = false;
};

int runCases(RunArguments& arguments) {
  CaseProgress progress(arguments.quiet);
  arguments.run.interrupted = [] { return interruptSignal() != 0; };
  arguments.run.progress = [&](int done, int count) { progress.show(done, count); };
  const blind::RunSummary summary = blind::run(arguments.folder, arguments.run);
  fmt::print("answers  {} of {}\n", summary.answered, summary.count);
  if (summary.failed > 0) fmt::print("failed   {}: these cases cannot be diagnosed; their answers say why\n", summary.failed);
  return interruptSignal() != 0 ? interrupted_base + interruptSignal() : done;
}

Action addRunCases(CLI::App& command) {
  auto arguments = std::make_shared<RunArguments>();
  command.add_option("folder", arguments->folder, "Folder that `blind make` wrote")->required();
  command.add_option("--jobs", arguments->run.job_count, "Cases at once (default: one per core); the answers do not depend on it")
      ->check(CLI::Range(1, 1024));
  addList(command, "--candidates", arguments->run.candidates, "Only these effects, by id, separated by commas");
  addList(command, "--leave-out", arguments->run.leave_out,
          "What the method does without, to measure what it is worth: nuisances (tolerances of the model's numbers), stand_ins, tempering");
  command.add_option("--commit", arguments->run.commit, "Version of the sources, to be noted with the answers");
  command.add_flag("--quiet", arguments->quiet, "No progress line");
  return [arguments] { return runCases(*arguments); };
}

struct FollowArguments {
  std::string folder, key;
  blind::FollowUpOptions follow;
  bool quiet = false;
};

int followCases(FollowArguments& arguments) {
  CaseProgress progress(arguments.quiet);
  arguments.follow.interrupted = [] { return interruptSignal() != 0; };
  arguments.follow.progress = [&](int done, int count) { progress.show(done, count); };
  blind::followUp(arguments.folder, arguments.key, arguments.follow);
  const blind::Score score = blind::score(arguments.folder, arguments.key);
  fmt::print("{}\n", score.totals.at("follow_up").dump(1));
  return interruptSignal() != 0 ? interrupted_base + interruptSignal() : done;
}

Action addFollow(CLI::App& command) {
  auto arguments = std::make_shared<FollowArguments>();
  command.add_option("folder", arguments->folder, "Folder with cases and answers")->required();
  command.add_option("--keys", arguments->key, "File of the key")->required();
  command.add_option("--jobs", arguments->follow.job_count, "Cases at once (default: one per core); the results do not depend on it")
      ->check(CLI::Range(1, 1024));
  addList(command, "--candidates", arguments->follow.candidates, "Only these effects, by id, separated by commas");
  command.add_flag("--quiet", arguments->quiet, "No progress line");
  return [arguments] { return followCases(*arguments); };
}

struct ScoreArguments {
  std::string folder, key;
  std::optional<std::string> docs;
  bool json = false;
};

void printRate(const nlohmann::json& totals, const char* words, const char* name) {
  if (!totals.contains(name)) return;
  const nlohmann::json& rate = totals[name];
  fmt::print("{:<28} {:>4} of {:<4} {:.2f} .. {:.2f}\n", words, rate["hits"].get<int>(), rate["count"].get<int>(),
             rate["low"].get<double>(), rate["high"].get<double>());
}

int scoreCases(const ScoreArguments& arguments) {
  const blind::Score score = blind::score(arguments.folder, arguments.key);
  const nlohmann::json object = blind::scoreJson(score);
  blind::writeObject(object, std::filesystem::path(arguments.folder) / "score.json");
  if (arguments.docs) blind::writePage(score, *arguments.docs);
  const nlohmann::json& all = object["all"];
  if (arguments.json) {
    fmt::print("{}\n", all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return done;
  }
  for (const auto& [words, name] : {std::pair("verdict right", "verdict"), std::pair("acceptable first", "acceptable"),
                                    std::pair("acceptable in first three", "acceptable3"), std::pair("first stage right", "stage"),
                                    std::pair("truth in the ambiguity set", "covered"), std::pair("open causes detected", "open_detected"),
                                    std::pair("false alarms", "false_alarm")})
    printRate(all, words, name);
  fmt::print("\n{}", blind::benchmarkTable(object));
  return done;
}

Action addScore(CLI::App& command) {
  auto arguments = std::make_shared<ScoreArguments>();
  command.add_option("folder", arguments->folder, "Folder with cases and answers")->required();
  command.add_option("--keys", arguments->key, "File of the key")->required();
  command.add_option("--docs", arguments->docs, "Also write FOLDER/blind.md and its figures");
  command.add_flag("--json", arguments->json, "Print the totals as one JSON object");
  return [arguments] { return scoreCases(*arguments); };
}

struct CalibrateArguments {
  std::vector<std::string> keys_and_answers;
};

int calibrateWeights(const CalibrateArguments& arguments) {
  if (arguments.keys_and_answers.size() % 2 != 0)
    throw BadParameter("calibrate", "an odd number of places", "name pairs: KEYS.json ANSWERS");
  std::vector<blind::TriedCase> cases;
  for (std::size_t i = 0; i < arguments.keys_and_answers.size(); i += 2)
    std::ranges::move(blind::triedCases(arguments.keys_and_answers[i], arguments.keys_and_answers[i + 1]), std::back_inserter(cases));
  const blind::Calibration result = blind::calibrate(cases);
  fmt::print("{:<22} {:>8} {:>8}\n", "weight (nats)", "in force", "fitted");
  const std::vector<std::string> names = blind::weightNames();
  for (std::size_t i = 0; i < names.size(); ++i)
    fmt::print("{:<22} {:>8.3f} {:>8.3f}\n", names[i], result.before[static_cast<Eigen::Index>(i)],
               result.after[static_cast<Eigen::Index>(i)]);
  fmt::print("mean ln(probability of the truth): {:.3f}; fitted to four fifths and asked of the fifth: {:.3f}\n", result.mean_ln_before,
             result.mean_ln_after);
  fmt::print("truth first: {} and {} of {}\nused: {}\nnot used (the truth was not tried, or is unknown): {}\n", result.first_before,
             result.first_after, result.used.size(), fmt::join(result.used, ", "), fmt::join(result.unused, ", "));
  return done;
}

Action addCalibrate(CLI::App& command) {
  auto arguments = std::make_shared<CalibrateArguments>();
  command
      .add_option("cases", arguments->keys_and_answers,
                  "Pairs of a file of open keys and the folder of the answers (NAME.json): KEYS.json ANSWERS [KEYS.json ANSWERS ...]")
      ->required();
  return [arguments] { return calibrateWeights(*arguments); };
}

}  // namespace

Action addBlind(CLI::App& command) {
  command.require_subcommand(1);
  CLI::App* make = command.add_subcommand("make", "Draws plants with withheld causes, records them and seals the key");
  const Action make_action = addMake(*make);
  CLI::App* run = command.add_subcommand("run", "Diagnoses every case that has no answer yet, without the key");
  const Action run_action = addRunCases(*run);
  CLI::App* score = command.add_subcommand("score", "Checks the fingerprints, opens the key and scores the answers");
  const Action score_action = addScore(*score);
  CLI::App* follow = command.add_subcommand(
      "follow", "Follows up the answers: diagnoses without the true effect, makes the proposed experiment, predicts a fresh recording");
  const Action follow_action = addFollow(*follow);
  CLI::App* calibrate =
      command.add_subcommand("calibrate", "Fits the weights of the evidence to answers whose keys are open, and says which cases it used");
  const Action calibrate_action = addCalibrate(*calibrate);
  return [=] {
    return calibrate->parsed() ? calibrate_action()
           : make->parsed()    ? make_action()
           : run->parsed()     ? run_action()
           : score->parsed()   ? score_action()
                               : follow_action();
  };
}

}  // namespace musclesim::command_line
