/// Measures how soon controllers bring the hand to the target and how long they keep it there: ASM on the height task, AASM on the reaching
/// task, random pressures on both. The study can be resumed: every run is a line of a CSV file, and runs in the file are not repeated. Runs
/// that diverge are listed; their missing time counts as time away from the target. Usage: height_task_study RUNS.csv [--seeds 1-20]
/// [--duration 300] [--physics original] [--controllers asm,random,aasm]
///                          [--document docs/user/controlling.md --figure docs/figures/controllers.svg] [name=value ...]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include "../../log/svg.h"
#include "musclesim/base/file.h"
#include "musclesim/controller/controller_registry.h"
#include "musclesim/simulation/simulation.h"
#include "study.h"

using namespace musclesim;

namespace {

constexpr double near_mm = 20;

struct Settings {
  std::string runs_file, physics = "original";
  int first_seed = 1, last_seed = 20;
  double duration_s = 300;
  std::vector<std::string> controllers = {"asm", "random", "aasm"}, parameters;
  std::optional<std::string> document, figure;
};

struct Run {
  std::string physics, controller;
  int seed = 0;
  double duration_s = 0, reached_s = -1, held_ratio = 0, near_ratio = 0;  ///< reached_s < 0: never
  double ended_s = 0;                                                     ///< below duration_s if the run diverged
};

/// Counts how long the hand is near a target.
class Near {
 public:
  Near(const Settings& settings, const std::string& name, int seed, const Vector& target)
      : reach_(name == "aasm" || name == "random-reach"), target_(target), run_{settings.physics, name, seed, settings.duration_s} {}

  void look(double time_s, const Vector& hand) {
    const double error_mm = reach_ ? (hand - target_).norm() : std::abs(hand.y() - target_.y());
    const bool is_near = error_mm <= near_mm;
    if (is_near && run_.reached_s < 0) run_.reached_s = time_s;
    if (is_near) near_s_ += time_s - run_.ended_s;
    run_.ended_s = time_s;
  }
  Run result() const {
    Run run = run_;
    run.near_ratio = near_s_ / run.duration_s;
    run.held_ratio = run.reached_s >= 0 ? std::min(1.0, near_s_ / (run.duration_s - run.reached_s)) : 0;
    return run;
  }

 private:
  bool reach_;
  Vector target_;
  Run run_;
  double near_s_ = 0;
};

/// One run of a controller; random pressures are evaluated with the targets of both tasks.
std::vector<Run> simulate(const Settings& settings, const std::string& name, int seed) {
  SimulationOptions options;
  options.physics = physicsFromName(settings.physics);
  options.seed = static_cast<std::uint64_t>(seed);
  for (const auto& assignment : settings.parameters) options.parameters.setFromText(assignment, "study");
  Simulation simulation(std::move(options));
  Robot& robot = simulation.build("arm");
  const double interval_s = settings.physics == "original" ? 6 : 3;
  const auto request = [&](const std::string& task) {
    return ControllerRequest{simulation.parameters(), robot.actuatorCount(), simulation.stepS(), interval_s, simulation.seed(), task, {}};
  };
  ControllerRequest height = request("height"), reach = request("reach");
  std::vector<Near> near;
  if (name != "aasm") near.emplace_back(settings, name, seed, *makeController("asm", height)->targetMm());
  if (name == "random") near.emplace_back(settings, "random-reach", seed, *makeController("aasm", reach)->targetMm());
  if (name == "aasm") near.emplace_back(settings, name, seed, *makeController("aasm", reach)->targetMm());
  Controller& controller = simulation.control(makeController(name, name == "aasm" ? reach : height));
  try {
    while (simulation.time_s() < settings.duration_s - 1e-9) {
      robot.step(controller.output(robot.getState()));
      simulation.step();
      for (Near& one : near) one.look(simulation.time_s(), *robot.getState().hand_mm);
    }
  } catch (const Diverged& divergence) {
    fmt::print(stderr, "{} {}, seed {}: {}\n", settings.physics, name, seed, divergence.what());
  }
  std::vector<Run> runs;
  for (const Near& one : near) runs.push_back(one.result());
  return runs;
}

std::vector<Run> readRuns(const std::string& file) {
  std::vector<Run> runs;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    std::stringstream cells(line);
    std::string c[8];
    for (auto& one : c) std::getline(cells, one, ',');
    if (c[0] == "physics" || c[7].empty()) continue;
    runs.push_back({c[0], c[1], std::stoi(c[2]), std::stod(c[3]), std::stod(c[4]), std::stod(c[5]), std::stod(c[6]), std::stod(c[7])});
  }
  return runs;
}

void appendRun(const std::string& file, const Run& run) {
  const bool fresh = !std::filesystem::exists(file);
  std::ofstream out(file, std::ios::app);
  if (fresh) out << "physics,controller,seed,duration_s,reached_s,held_ratio,near_ratio,ended_s\n";
  out << fmt::format("{},{},{},{:g},{:.2f},{:.4f},{:.4f},{:.2f}\n", run.physics, run.controller, run.seed, run.duration_s, run.reached_s,
                     run.held_ratio, run.near_ratio, run.ended_s);
}

double medianOf(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

const std::map<std::string, std::string> titles = {{"asm", "ASM, height"},
                                                   {"random", "random pressures, height"},
                                                   {"aasm", "AASM, reaching"},
                                                   {"random-reach", "random pressures, reaching"}};

using Groups = std::map<std::pair<std::string, std::string>, std::vector<Run>>;

std::string tableOf(const Groups& groups) {
  std::string table =
      "| physics | controller, task | runs x s | reached | time to reach s: median | worst | share of time held afterwards: median | mean "
      "| share of all time near: mean | diverged |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [key, runs] : groups) {
    std::vector<double> reached, held;
    double held_sum = 0, near_sum = 0;
    int diverged = 0;
    for (const Run& run : runs) {
      if (run.reached_s >= 0) reached.push_back(run.reached_s);
      held.push_back(run.held_ratio);
      held_sum += run.held_ratio, near_sum += run.near_ratio;
      diverged += run.ended_s < run.duration_s - 0.1;
    }
    const auto count = static_cast<double>(runs.size());
    table += fmt::format("| `{}` | {} | {} x {:g} | {} | {:.1f} | {:.1f} | {:.0f} % | {:.0f} % | {:.0f} % | {} |\n", key.first,
                         titles.at(key.second), runs.size(), runs.front().duration_s, reached.size(), medianOf(reached),
                         reached.empty() ? std::nan("") : *std::max_element(reached.begin(), reached.end()), 100 * medianOf(held),
                         100 * held_sum / count, 100 * near_sum / count, diverged);
  }
  return table;
}

/// One row per group; every run is a vertical stroke at the share of time for which it held the target.
std::string figureOf(const Groups& groups) {
  const double left = 290, width = 540, row_height = 44;
  Svg svg(left + width + 40, 70 + row_height * static_cast<double>(groups.size()), "Share of time within 20 mm after reaching the target");
  double y = 30;
  const auto x_of = [&](double ratio) { return left + width * ratio; };
  const double bottom = y + row_height * static_cast<double>(groups.size());
  for (int percent = 0; percent <= 100; percent += 20) {
    const double x = x_of(percent / 100.0);
    svg.line({x, y - 6}, {x, bottom}, "#e4e4e4", 1);
    svg.text({x, bottom + 16}, fmt::format("{} %", percent), {.anchor = SvgAnchor::middle});
  }
  svg.text({left + width / 2, bottom + 34}, "share of time within 20 mm of the target after first reaching it; thick: median",
           {.anchor = SvgAnchor::middle});
  for (const auto& [key, runs] : groups) {
    const double middle = y + row_height / 2;
    svg.text({left - 12, middle + 4}, fmt::format("{}, {} ({} runs)", titles.at(key.second), key.first, runs.size()),
             {.size = 11, .anchor = SvgAnchor::end});
    std::vector<double> held;
    for (const Run& run : runs) {
      held.push_back(run.held_ratio);
      svg.line({x_of(run.held_ratio), middle - 12}, {x_of(run.held_ratio), middle + 12}, "#2060b0", 1.5);
    }
    svg.line({x_of(medianOf(held)), middle - 16}, {x_of(medianOf(held)), middle + 16}, "#c03020", 4);
    y += row_height;
  }
  return svg.document();
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] { return std::string(i + 1 < argc ? argv[++i] : ""); };
    if (word == "--seeds") {
      const std::string range = value();
      settings.first_seed = std::stoi(range);
      settings.last_seed = std::stoi(range.substr(range.find('-') + 1));
    } else if (word == "--duration")
      settings.duration_s = std::stod(value());
    else if (word == "--physics")
      settings.physics = value();
    else if (word == "--document")
      settings.document = value();
    else if (word == "--figure")
      settings.figure = value();
    else if (word == "--controllers") {
      settings.controllers.clear();
      std::stringstream list(value());
      for (std::string one; std::getline(list, one, ',');)
        if (!one.empty()) settings.controllers.push_back(one);
    } else if (word.find('=') != std::string::npos)
      settings.parameters.push_back(word);
    else
      settings.runs_file = word;
  }
  return settings;
}

}  // namespace

int main(int argc, char** argv) {
  const Settings settings = parse(argc, argv);
  if (settings.runs_file.empty() || settings.runs_file.starts_with('-')) {
    fmt::print(stderr,
               "usage: height_task_study RUNS.csv [--seeds 1-20] [--duration 300] [--physics original] [--controllers asm,random,aasm] "
               "[--document PAGE.md] [--figure FIGURE.svg] [name=value ...]\n");
    return 2;
  }
  std::vector<Run> runs = readRuns(settings.runs_file);
  for (int seed = settings.first_seed; seed <= settings.last_seed; ++seed)
    for (const std::string& controller : settings.controllers) {
      const bool known = std::any_of(runs.begin(), runs.end(), [&](const Run& run) {
        return run.physics == settings.physics && run.controller == controller && run.seed == seed && run.duration_s == settings.duration_s;
      });
      if (known) continue;
      for (const Run& run : simulate(settings, controller, seed)) {
        runs.push_back(run);
        appendRun(settings.runs_file, run);
      }
    }
  Groups groups;
  for (const Run& run : runs) groups[{run.physics, run.controller}].push_back(run);
  const std::string table = tableOf(groups);
  fmt::print("{}", table);
  if (settings.document) writeSection(*settings.document, "controllers", "height_task_study", table);
  if (settings.figure) replaceFile(*settings.figure, figureOf(groups));
}
