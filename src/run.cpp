/// `musclesim run`: the paper's program. A robot, a controller, a log and a figure; a window, pictures, or neither.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "commands.h"
#include "interrupt.h"
#include "musclesim/base/color.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/controller/controller_registry.h"
#include "musclesim/log/figure.h"
#include "musclesim/log/recorder.h"
#include "output_folder.h"
#include "progress.h"
#include "run_output.h"
#include "window.h"

namespace musclesim::program {

namespace {

namespace fs = std::filesystem;

/// Default decision interval: the paper's 6 s in original physics; in true seconds the time that the arm takes to settle
/// (docs/reference/parameters.md).
double defaultDecisionIntervalS(const PhysicsSettings& physics) {
  constexpr double original_s = 6.0, si_s = 3.0;
  if (physics.kind == PhysicsKind::si) return si_s;
  return physics.kind == PhysicsKind::original ? original_s : original_s / std::sqrt(original_force_deficit_ratio);
}

ControllerRequest controllerRequest(Simulation& simulation, const RunOptions& options) {
  const double interval_s = options.decision_interval_s.value_or(defaultDecisionIntervalS(simulation.physics()));
  if (!(interval_s > 0 && std::isfinite(interval_s)))
    throw BadParameter("decision-interval", fmt::format("{} s", interval_s), "be positive and finite");
  ControllerRequest request{
      simulation.parameters(), simulation.robot().actuatorCount(), simulation.stepS(), interval_s, simulation.seed(), options.task, {}};
  if (!options.target_mm.empty()) request.target_mm = Vector(options.target_mm[0], options.target_mm[1], options.target_mm[2]);
  return request;
}

constexpr double longest_s = 1e7;

bool hasWindow(const RunOptions& options) {
  return !options.simple && !options.pictures.wanted();
}

/// Refuses options that would have no effect in this run.
void requireUsedOptions(const RunOptions& options) {
  if (hasWindow(options)) return;
  const char* without_window = options.simple ? "--simple opens no window" : "--screenshot and --video open no window";
  if (options.window_log) throw BadParameter(fmt::format("--window-log logs the user's actions in a window, but {}", without_window));
  options.pictures.requireUsed(without_window);
}

/// The duration without --duration: 300 s as published; shorter for a picture or video; with a window until it is closed.
double defaultDurationS(const RunOptions& options) {
  constexpr double batch_s = 300, pictures_s = 20;
  return options.simple ? batch_s : hasWindow(options) ? longest_s : pictures_s;
}

/// How a run ended.
struct Ending {
  std::string status;  ///< status in the verdict
  std::string error;   ///< empty: none
  int exit_status;
};

/// One run from the first command to the last row.
class Run {
 public:
  Run(const ModelOptions& model, const RunOptions& options) : model_(model), options_(options), simulation_(simulationOptions(model)) {
    simulation_.build(model.robot.value_or("arm"));
    addController();
    simulation_.parameters().requireAllKnown();
    duration_s_ = options.duration_s.value_or(defaultDurationS(options));
    requireDuration();
  }

  Simulation& simulation() { return simulation_; }

  int execute() {
    const std::string initial_state = model_.initial_state.value_or(simulation_.robot().initialState());
    // The first decision comes before the files are opened, because the columns depend on what the controller reports.
    const State first_state = robot().getState();
    const musclesim::Action first_action = controller_->output(first_state);
    const fs::path csv = recordingPath(options_, simulation_.seed());
    requireReplaceable(csv);
    prepareRecording(csv);
    addSpectator(first_state, csv);
    Recorder recorder(csv.string(), describe(simulation_, options_, initial_state), columns());
    say(model_, fmt::format("{} physics, stepper {}, {} internal steps of {:.4g} s per step of {:g} s, seed {}",
                            nameOf(simulation_.physics().kind), simulation_.stepper().name(), simulation_.substeps(),
                            simulation_.internalStepS(), simulation_.stepS(), simulation_.seed()));
    if (!simulation_.stepper().message().empty()) say(model_, simulation_.stepper().message());
    if (!options_.target_mm.empty() && !controller_->targetMm())
      say(model_, fmt::format("warning: controller {} has no target; --target changes nothing", options_.controller));
    std::optional<Diverged> divergence;
    Progress progress(duration_s_, model_.quiet || hands_);
    try {
      simulation_.start(initial_state, first_action);
      loop(recorder, progress, first_action);
    } catch (const Diverged& error) {
      divergence = error;
    } catch (const Interrupted&) {
      // endingOf() reports the signal.
    }
    const Ending ending = endingOf(divergence);
    const nlohmann::json verdict = conclude(ending, progress.wallS());
    recorder.note("verdict", verdict.dump());
    if (hands_) noteHands(recorder);
    recorder.close(ending.exit_status == done);
    dismissSpectator(divergence);
    report(verdict, csv, drawFigure(csv, recorder.rowCount()), ending);
    return ending.exit_status;
  }

 private:
  /// With a window, the user can take over from the controller.
  void addController() {
    auto controller = makeController(options_.controller, controllerRequest(simulation_, options_));
    if (hasWindow(options_)) {
      auto hands = std::make_unique<ManualController>(std::move(controller), robot().actuatorCount());
      hands_ = hands.get();
      controller = std::move(hands);
    }
    controller_ = &simulation_.control(std::move(controller));
  }

  void addSpectator(const State& first_state, const fs::path& csv) {
    if (options_.pictures.wanted()) spectator_ = makePictures(options_.pictures, simulation_);
    if (!hands_) return;
    const fs::path folder = csv.has_parent_path() ? csv.parent_path() : ".";
    spectator_ = openWindow(options_.pictures, simulation_, *hands_, first_state, folder.string(), options_.window_log.value_or(""));
  }

  void dismissSpectator(const std::optional<Diverged>& divergence) {
    if (!spectator_) return;
    if (divergence) spectator_->diverge(divergence->what());
    spectator_->finish();
    spectator_.reset();
  }

  void noteHands(Recorder& recorder) const {
    nlohmann::json intervals = nlohmann::json::array();
    for (const auto& interval : hands_->manualIntervals()) intervals.push_back({interval.from_s, interval.to_s});
    recorder.note("by_hand_s", intervals.dump());
  }

  static SimulationOptions simulationOptions(const ModelOptions& model) {
    SimulationOptions options;
    options.physics = physicsFromName(model.physics.value_or("si"));
    options.stepper = stepperFromName(model.stepper);
    options.step_s = model.step_s.value_or(options.step_s);
    options.substeps = substepsFrom(model);
    options.plane = model.plane;
    options.seed = model.seed.value_or(1);
    options.interrupted = [] { return interruptSignal() != 0; };
    options.parameters = parametersFrom(model);
    options.effects = effectsFrom(model);
    return options;
  }

  /// Writes the figure beside the recording. Returns an empty path if the run ended before its first row.
  fs::path drawFigure(const fs::path& csv, long row_count) const {
    if (row_count == 0) return {};
    fs::path svg = fs::path(csv).replace_extension(".svg");
    if (options_.record && options_.out) {
      makeFolder(*options_.out);
      svg = fs::path(*options_.out) / svg.filename();
    }
    const Recording recording = readRecording(csv.string());
    writeRunFigure(recording, robot().namedMuscleColors(), recording.info.description, svg.string());
    return svg;
  }

  void requireDuration() const {
    if (!(duration_s_ >= simulation_.stepS() && duration_s_ <= longest_s))
      throw BadParameter("duration", fmt::format("{} s", duration_s_),
                         fmt::format("lie between one step, {} s, and 1e7 s", simulation_.stepS()));
    if (options_.record_interval_s && !(*options_.record_interval_s > 0 && std::isfinite(*options_.record_interval_s)))
      throw BadParameter("record-interval", fmt::format("{} s", *options_.record_interval_s), "be positive and finite");
  }

  std::vector<std::string> columns() const {
    std::vector<std::string> names = robot().signalNames();
    if (controller_->targetMm())
      for (const char* axis : {"x", "y", "z"})
        if (!controller_->targetIsHeight() || *axis == 'y') names.push_back(fmt::format("target_{}_mm", axis));
    if (controller_->activity()) names.push_back("activity");
    return names;
  }

  std::vector<double> row(const State& state) const {
    std::vector<double> values = robot().signalValues(state);
    if (const auto target = controller_->targetMm()) {
      if (controller_->targetIsHeight())
        values.push_back(target->y());
      else
        values.insert(values.end(), target->data(), target->data() + 3);
    }
    if (const auto activity = controller_->activity()) values.push_back(*activity);
    return values;
  }

  /// The paper's run loop: state, output, step. A row is logged before the world moves.
  void loop(Recorder& recorder, Progress& progress, musclesim::Action action) {
    const long step_count = std::lround(duration_s_ / simulation_.stepS());
    const long record_every = std::max(1L, std::lround(options_.record_interval_s.value_or(simulation_.stepS()) / simulation_.stepS()));
    for (long i = 0; i < step_count && goes_on_ && interruptSignal() == 0; ++i) {
      const bool due = i % record_every == 0;
      if (i > 0) {
        const musclesim::Action before = std::exchange(action, controller_->output(robot().getState()));
        if (!due && action != before) warnOfLateCommands(static_cast<double>(record_every) * simulation_.stepS());
      }
      robot().step(action);
      record(recorder, progress, due);
      simulation_.step();
      warnOfGap();
    }
    robot().step(action);  // so that the last row, too, has the forces at its own time
    record(recorder, progress, true);
  }

  void record(Recorder& recorder, Progress& progress, bool due) {
    const State state = robot().getState();
    score_.add(state.time_s, state, *controller_);
    if (due) recorder.append(state.time_s, row(state));
    progress.show(state.time_s, state.hand_mm ? fmt::format("height {:.0f} mm", state.hand_mm->y()) : "");
    if (spectator_) goes_on_ = spectator_->see(state);
  }

  void warnOfLateCommands(double interval_s) {
    if (std::exchange(late_commands_warned_, true)) return;
    say(model_,
        fmt::format("warning: the rows are recorded {:g} s apart and commands change between them: a replay of this recording would change "
                    "them late, at the next row; a shorter --record-interval avoids this",
                    interval_s));
  }

  void warnOfGap() {
    constexpr double warning_mm = 1.0;
    const JointGap& gap = simulation_.worstGap();
    if (gap_warned_ || gap.gap_mm <= warning_mm) return;
    gap_warned_ = true;
    say(model_,
        fmt::format("warning: {} has come apart by {:.2g} mm at {:.4g} s; a smaller --step or more --substeps would be more accurate",
                    gap.joint, gap.gap_mm, simulation_.time_s()));
  }

  bool hasEndedEarly() const { return simulation_.time_s() < duration_s_ - simulation_.stepS(); }

  Ending endingOf(const std::optional<Diverged>& divergence) const {
    if (divergence) return {"diverged", divergence->what(), ExitStatus::diverged};
    if (const int signal = interruptSignal()) return {"interrupted", "", interrupted_base + signal};
    const auto failure = spectator_ && hasEndedEarly() ? spectator_->failure() : std::nullopt;
    if (failure)
      return {"window_lost", fmt::format("the window ended on its own at {:.4g} s: {}", simulation_.time_s(), *failure), io_error};
    return {"done", "", done};
  }

  nlohmann::json conclude(const Ending& ending, double wall_s) const {
    nlohmann::json verdict = score_.verdict();
    verdict["status"] = ending.status;
    if (!ending.error.empty()) verdict["message"] = ending.error;
    verdict["simulated_s"] = std::max(0.0, simulation_.time_s());
    verdict["worst_joint_gap_mm"] = simulation_.worstGap().gap_mm;
    verdict["worst_joint"] = simulation_.worstGap().joint;
    verdict["unsolved_steps"] = simulation_.stepper().unsolvedSteps();
    verdict["solver_messages"] = simulation_.solverMessageCount();
    verdict["wall_s"] = wall_s;
    verdict["wall_per_simulated_s"] = simulation_.time_s() > 0 ? wall_s / simulation_.time_s() : 0.0;
    return verdict;
  }

  void sayEnding(const Ending& ending) const {
    if (!ending.error.empty()) std::fprintf(stderr, "musclesim: error: %s\n", ending.error.c_str());
    if (ending.exit_status > interrupted_base) say(model_, "interrupted; the files hold everything up to then");
    if (ending.exit_status == done && options_.duration_s && hasEndedEarly())
      say(model_, fmt::format("the window was closed: {:.4g} s of {:g} s are recorded", simulation_.time_s(), duration_s_));
  }

  void report(nlohmann::json verdict, const fs::path& csv, const fs::path& svg, const Ending& ending) const {
    sayEnding(ending);
    const double ratio = verdict["wall_per_simulated_s"];
    say(model_,
        fmt::format("{:g} s simulated in {:.3g} s of wall time: r = {:.3g}", simulation_.time_s(), verdict["wall_s"].get<double>(), ratio));
    if (verdict.contains("reached_at_s") && !verdict["reached_at_s"].is_null())
      say(model_, fmt::format("target reached (within {:g} mm) at {:.2f} s, held for {:.0f} % of the time since",
                              verdict["reached_within_mm"].get<double>(), verdict["reached_at_s"].get<double>(),
                              100 * verdict["held_share"].get<double>()));
    fmt::print("log     {}\n", csv.string());
    if (!svg.empty()) fmt::print("figure  {}\n", svg.string());
    if (model_.json) {
      verdict["command"] = "run";
      verdict["log"] = csv.string();
      verdict["figure"] = svg.string();
      fmt::print("{}\n", verdict.dump());
    }
  }

  Robot& robot() { return simulation_.robot(); }
  const Robot& robot() const { return const_cast<Simulation&>(simulation_).robot(); }

  const ModelOptions& model_;
  const RunOptions& options_;
  Simulation simulation_;
  Controller* controller_ = nullptr;
  double duration_s_;
  ManualController* hands_ = nullptr;     ///< null without a window
  std::unique_ptr<Spectator> spectator_;  ///< may be null
  Score score_;
  bool gap_warned_ = false, late_commands_warned_ = false, goes_on_ = true;
};

int run(const ModelOptions& model, const RunOptions& options) {
  requireUsedOptions(options);
  Run run(model, options);
  if (options.verbose) list(run.simulation());
  if (options.print_config) {
    fmt::print("{}", run.simulation().parameters().toToml());
    return done;
  }
  if (hasWindow(options)) requireWindow();
  return run.execute();
}

void addOptions(CLI::App& command, RunOptions& options) {
  const std::string group = "Run";
  command.add_flag("--simple", options.simple, "Batch run without window or interaction (default: a window opens)")->group(group);
  command.add_flag("--verbose", options.verbose, "List all primitives and actuators on standard output")->group(group);
  command.add_option("--controller", options.controller, "Controller: " + fmt::format("{}", fmt::join(registeredControllers(), ", ")))
      ->group(group)
      ->capture_default_str();
  command.add_option("--task", options.task, "height: bring the hand to a height; reach: bring it to a point")
      ->group(group)
      ->capture_default_str();
  command.add_option("--target", options.target_mm, "X,Y,Z of the target in mm (for the height task only Y counts)")
      ->group(group)
      ->delimiter(',')
      ->expected(3);
  command
      .add_option("--decision-interval", options.decision_interval_s,
                  "Time between decisions in s (default: 6 in original physics, 3 in si)")
      ->group(group);
  command
      .add_option("--duration", options.duration_s,
                  "Simulated time in s (default: until the window is closed; 300 with --simple; 20 with --screenshot or --video)")
      ->group(group);
  command.add_option("--record", options.record, "Recording to write, FILE.csv (default: run.csv in the run's folder)")->group(group);
  command
      .add_option("--record-interval", options.record_interval_s,
                  "Time between recorded rows in s, rounded to whole steps (default: every step)")
      ->group(group);
  command.add_option("--out", options.out, "Folder of the run (default: log/runs/<date-time>-<task>-<seed>)")->group(group);
  command.add_flag("--print-config", options.print_config, "Print all parameters as TOML and exit")->group(group);
  command
      .add_option("--window-log", options.window_log,
                  "Log the user's actions in the window to FILE: one line of JSON per key or click, with the state after it")
      ->group("Pictures");
  addPictureOptions(command, options.pictures, "Pictures");
}

}  // namespace

Action addRun(CLI::App& app, ModelOptions& model) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* named = app.add_subcommand("run", "Runs a robot under a controller and writes a log and a figure (the default)");
  for (CLI::App* command : {&app, named}) {
    addOptions(*command, *options);
    addModelOptions(*command, model);
  }
  return [&model, options] { return run(model, *options); };
}

}  // namespace musclesim::program
