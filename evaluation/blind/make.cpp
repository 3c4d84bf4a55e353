#include "make.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "../../base/parallel.h"
#include "cause.h"
#include "chance.h"
#include "excitation.h"
#include "look_alikes.h"
#include "musclesim/base/error.h"
#include "musclesim/base/unique_name.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/replay.h"
#include "musclesim/simulation/simulation.h"
#include "seal.h"
#include "sha256.h"
#include "unsealed.h"

namespace musclesim::blind {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

const std::vector<std::string>& kindNames() {
  static const std::vector<std::string> names = {"single", "double", "open", "null"};
  return names;
}

std::string drawKind(const std::vector<std::string>& allowed, RandomStream& random) {
  if (!allowed.empty()) return oneOf(random, allowed);
  const double place = random.uniform();
  return place < 0.7 ? "single" : place < 0.8 ? "double" : place < 0.9 ? "open" : "null";
}

/// The measured signals: always the angle and, on the rig, the length; a third of the plants lack pressure or force.
std::vector<std::string> drawSignals(const Robot& robot, RandomStream& random) {
  const bool pressure = happens(random, 0.83), force = happens(random, 0.8), length = happens(random, 0.7), hand = happens(random, 0.6);
  std::vector<std::string> signals;
  for (const std::string& name : robot.signalNames()) {
    const bool flat = robot.name() == "elbow" && name == "hand_z_mm";  // never moves
    const bool measured = name.starts_with("pressure_") ? pressure
                          : name.starts_with("force_")  ? force
                          : name.starts_with("length_") ? length || robot.name() == "rig"
                          : name.starts_with("hand_")   ? hand && !flat && robot.name() != "rig"
                                                        : name.starts_with("angle_");
    if (measured) signals.push_back(name);
  }
  return signals;
}

std::map<std::string, double> drawNoise(const std::vector<std::string>& signals, RandomStream& random) {
  const double pressure = rounded(logUniform(random, 0.002, 0.004), 1e5), force = rounded(logUniform(random, 0.5, 1), 1e3),
               length = rounded(logUniform(random, 0.05, 0.1), 1e4), angle = rounded(logUniform(random, 0.05, 0.1), 1e4);
  std::map<std::string, double> noise;
  for (const std::string& name : signals)
    noise[name] = name.starts_with("pressure_") ? pressure
                  : name.starts_with("force_")  ? force
                  : name.starts_with("length_") ? length
                  : name.starts_with("angle_")  ? angle
                                                : 0.3;
  return noise;
}

/// One plant as drawn before its cause.
struct Plan {
  std::string name, robot, kind, size;
  std::vector<Excitation> excitations;
  std::vector<Recording> recordings;
  std::vector<std::string> signals;
  std::map<std::string, double> noise_std;
};

/// Reduces the motion until the elbow stays well within its stops, because an impact is not predictable.
void keepFromStops(Recording& plan) {
  constexpr double farthest_deg = 50, smaller = 0.8;
  if (plan.info.robot != "elbow") return;
  for (;;) {
    const Recording simulated = replayRecording(plan).simulated;
    const Signal* angle = simulated.find("angle_elbow_deg");
    if (std::ranges::all_of(angle->values, [](double q) { return std::abs(q) < farthest_deg; })) return;
    for (Signal& command : plan.signals) {
      const double middle = command.values.front();
      for (double& u : command.values) u = rounded(middle + smaller * (u - middle), 1e4);
    }
  }
}

Plan drawPlan(const std::string& name, const std::string& robot_name, const Robot& robot, const MakeOptions& options,
              RandomStream& random) {
  Plan plan{name, robot_name, drawKind(options.kinds, random), "none", drawExcitations(robot_name, random), {}, drawSignals(robot, random),
            {}};
  if (plan.kind != "null") plan.size = oneOf(random, sizeNames());
  plan.noise_std = drawNoise(plan.signals, random);
  const double load_kg = rounded(random.uniform(1.5, 3), 10);
  for (const Excitation& excitation : plan.excitations) {
    plan.recordings.push_back(planned(robot_name, excitation, robot_name == "arm" ? options.duration_s / 2 : options.duration_s, random));
    if (robot_name == "rig") plan.recordings.back().info.robot_parameters["load_kg"] = load_kg;
    keepFromStops(plan.recordings.back());
  }
  return plan;
}

/// Tries laws until one reaches its size; `redrawn` receives the names of the others. Empty if interrupted.
std::optional<Cause> drawCause(const Plan& plan, const std::vector<OutOfCatalogueLaw>& laws, const std::vector<Cause>& others,
                               const Robot& robot, const Truth& truth, const std::function<bool()>& interrupted, RandomStream& random,
                               json& redrawn) {
  constexpr std::size_t most_draws = 60, draws_in_a_row = 3;
  for (std::size_t draw = 0; draw < most_draws && !laws.empty(); ++draw) {
    const OutOfCatalogueLaw& law = laws[draw / draws_in_a_row % laws.size()];
    if (std::ranges::any_of(others, [&](const Cause& other) { return other.stage == law.info.stage; })) continue;
    const std::string component = oneOf(random, componentsOf(law, robot, plan.signals));
    if (interrupted()) return {};
    if (auto cause = causeOfSize(law, component, plan.size, truth, random)) return cause;
    redrawn.push_back(law.info.id + "@" + component);
  }
  throw BadParameter(plan.name + ": size of the gap", plan.size,
                     fmt::format("be reached by one of {} drawn causes; take another seed, or other --causes", most_draws));
}

json causeJson(const Cause& cause) {
  json parameters = json::object();
  for (const auto& [name, value] : cause.law.parameters) parameters[name] = std::get<double>(value);
  return {{"id", cause.id},      {"component", cause.component}, {"stage", nameOf(cause.stage)}, {"gap_over_noise", cause.gap_over_noise},
          {"law", cause.law.id}, {"law_parameters", parameters}};
}

json excitationsJson(const Plan& plan) {
  json list = json::array();
  for (std::size_t i = 0; i < plan.excitations.size(); ++i) {
    const Excitation& e = plan.excitations[i];
    list.push_back({{"file", fmt::format("r{}.csv", i + 1)},
                    {"excitation", e.kind},
                    {"amplitude", e.amplitude},
                    {"speed", e.speed},
                    {"held_out", i + 1 == plan.excitations.size()}});
  }
  return list;
}

/// The key of a case. Removing the cause entirely leaves the noise, so the oracle's gap reduction is 100 %.
json keyOf(const Plan& plan, const std::vector<Cause>& causes, const Robot& robot, const Truth& truth, const json& redrawn) {
  std::vector<ActiveEffect> laws;
  json effects = json::array(), acceptable = json::array(), stages = json::array();
  for (const Cause& cause : causes) {
    laws.push_back(cause.law);
    effects.push_back(causeJson(cause));
    stages.push_back(nameOf(cause.stage));
    if (plan.kind != "open") acceptable.push_back(acceptableAnswers(cause.id, cause.component, plan.signals, robot));
  }
  const auto rmse = truth.rmse(laws);
  const char* verdict = plan.kind == "null" ? "no_gap" : plan.kind == "open" ? "unexplained" : "effects_found";
  return {{"robot", plan.robot},
          {"kind", plan.kind},
          {"size", plan.size},
          {"verdict", verdict},
          {"effects", effects},
          {"acceptable", acceptable},
          {"stages", stages},
          {"signals", plan.signals},
          {"noise_std", plan.noise_std},
          {"gap_over_noise", truth.gapOverNoise(rmse)},
          {"gap_normalised", truth.normalisedGap(rmse)},
          {"gap_of_step_over_noise", truth.gapOverNoise(truth.rmse({}))},
          {"step_ratio", truth.stepRatio()},
          {"noise_free_rmse", rmse},
          {"oracle_shrink_percent", 100},
          {"recordings", excitationsJson(plan)},
          {"redrawn", redrawn}};
}

/// A plan and the plant that it describes.
struct DrawnPlant {
  Plan plan;
  Truth truth;
};

/// Redraws while a finer time step alone makes more than half the noise: such a plant would have a gap that its cause does not explain.
DrawnPlant drawPlant(const std::string& name, const std::string& robot_name, const Robot& robot, const MakeOptions& options,
                     RandomStream& random) {
  constexpr double most_over_noise = 0.5;
  constexpr int most_draws = 20;
  for (int draw = 0; draw < most_draws; ++draw) {
    Plan plan = drawPlan(name, robot_name, robot, options, random);
    Truth truth(plan.recordings, plan.signals, plan.noise_std, static_cast<std::uint64_t>(random.uniform(0, 9e15)));
    if (truth.gapOverNoise(truth.rmse({})) <= most_over_noise) return {std::move(plan), std::move(truth)};
  }
  throw BadParameter(name + ": excitations", fmt::format("{} draws", most_draws),
                     "include some in which the model agrees with itself at half its step; take another seed");
}

/// Draws, simulates and writes one case. Returns its key; empty if it was interrupted.
std::optional<json> makeCase(const std::string& name, const std::string& robot_name, std::size_t turn, const fs::path& folder,
                             const MakeOptions& options) {
  RandomStream random(options.seed, "blind." + name);
  Simulation probe;
  const Robot& robot = probe.build(robot_name);
  const auto [plan, truth] = drawPlant(name, robot_name, robot, options, random);
  std::vector<Cause> causes;
  json redrawn = json::array();
  const std::size_t cause_count = plan.kind == "null" ? 0 : plan.kind == "double" ? 2 : 1;
  while (causes.size() < cause_count) {
    constexpr std::size_t far_apart = 10;  // laws between the first of two causes and the second
    const auto laws = lawsInTurn(robot, plan.signals, plan.kind == "open", options.causes, options.seed, turn + far_apart * causes.size());
    auto cause = drawCause(plan, laws, causes, robot, truth, options.interrupted, random, redrawn);
    if (!cause) return {};
    causes.push_back(std::move(*cause));
  }
  std::vector<ActiveEffect> laws;
  for (const Cause& cause : causes) laws.push_back(cause.law);
  const std::vector<Recording> recordings = truth.measured(laws);
  fs::create_directories(folder / name);
  for (std::size_t i = 0; i < recordings.size(); ++i)
    writeRecording(recordings[i], (folder / name / fmt::format("r{}.csv", i + 1)).string());
  return keyOf(plan, causes, robot, truth, redrawn);
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
  for (const std::string& kind : options.kinds)
    if (std::ranges::find(kindNames(), kind) == kindNames().end())
      throw BadParameter("--kinds", kind, fmt::format("be one of {}", fmt::join(kindNames(), ", ")));
  for (const std::string& id : options.causes) effectInfo(id);  // throws for an unknown one
  if (options.count < 0 || options.arm_count < 0 || options.count + options.arm_count < 1)
    throw BadParameter("--count", fmt::format("{} + {}", options.count, options.arm_count), "be at least 1 in all");
  if (!(options.duration_s >= 1)) throw BadParameter("--duration-s", fmt::format("{}", options.duration_s), "be at least 1");
}

/// The call and the program.
json callOf(const MakeOptions& options) {
  json call = programMembers(options.commit);
  call["seed"] = options.seed;
  call["count"] = options.count;
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

/// The cases of an earlier call, or new ones. Empty if interrupted.
std::optional<json> keptOrMade(int index, const fs::path& folder, const UnsealedCases& unsealed, const MakeOptions& options) {
  const std::string name = caseName(index);
  if (auto kept = unsealed.keyOf(name)) return kept;
  const std::string robot = index >= options.count ? "arm" : index % 2 == 0 ? "rig" : "elbow";
  fs::remove_all(folder / name);
  const int turn = index >= options.count ? index - options.count : index / 2;
  auto key = makeCase(name, robot, static_cast<std::size_t>(turn), folder, options);
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
  const UnsealedCases unsealed(key_folder, call);
  if (!fs::is_empty(folder) && !unsealed.exist())
    throw BadParameter("folder", folder.string(), "be new or empty, or hold what the same call had made when it was stopped");
  unsealed.begin();
  const int case_count = options.count + options.arm_count;
  std::vector<std::optional<json>> keys(static_cast<std::size_t>(case_count));
  std::mutex one_at_a_time;
  int done = 0;
  parallelFor(case_count, options.job_count, [&](int i) {
    if (options.interrupted()) return;
    keys[static_cast<std::size_t>(i)] = keptOrMade(i, folder, unsealed, options);
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
