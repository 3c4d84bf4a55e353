/// `musclesim run`: the paper's program. A robot, a controller, a log and a figure; a window, pictures, or neither.
#include "run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "commands.h"
#include "interrupt.h"
#include "log/figure_panels.h"
#include "musclesim/base/color.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "musclesim/controller/controller_registry.h"
#include "musclesim/controller/manual.h"
#include "musclesim/controller/test_signal.h"
#include "musclesim/log/figure.h"
#include "musclesim/log/recorder.h"
#include "musclesim/simulation/run_loop.h"
#include "output_folder.h"
#include "progress.h"
#include "run_origin.h"
#include "run_output.h"
#include "run_signals.h"
#include "simulation/recorded_pulls.h"
#include "window.h"

namespace musclesim::command_line {

namespace {

namespace fs = std::filesystem;

ControllerRequest requestFor(Simulation& simulation, const RunOptions& options) {
  ControllerRequest request = controllerRequest(simulation, options.task.value_or("height"), options.decision_interval_s);
  if (!options.target_mm.empty()) request.target_mm = Vector(options.target_mm[0], options.target_mm[1], options.target_mm[2]);
  request.commands_file = options.commands.value_or("");
  request.targets_file = options.targets.value_or("");
  request.channels = options.channels.value_or("");
  request.interpolate = options.interpolate == "linear";
  return request;
}

constexpr double until_closed_s = 1e7;

}  // namespace

bool hasWindow(const RunOptions& options) {
  return !options.simple && !options.pictures.wanted();
}

namespace {

/// Refuses options that would have no effect in this run.
void requireUsedOptions(const RunOptions& options) {
  if (hasWindow(options)) return;
  const char* without_window = options.simple ? "--simple opens no window" : "--screenshot and --video open no window";
  if (options.window_log) throw BadParameter(fmt::format("--window-log logs the user's actions in a window, but {}", without_window));
  options.pictures.requireUsed(without_window);
}

/// The duration without --duration: to the end of the controller's commands, if they have one; else 300 s as published; shorter for a
/// picture or video; with a window until it is closed.
double defaultDurationS(const RunOptions& options, const Controller& controller) {
  constexpr double pictures_s = 20;
  if (hasWindow(options)) return until_closed_s;
  return options.simple || controller.endS() ? musclesim::defaultDurationS(controller) : pictures_s;
}

/// Refuses options of one kind of controller where another would not heed them.
void requireHeeded(const RunOptions& options) {
  const std::string& controller = *options.controller;
  const bool is_signal = std::ranges::any_of(testSignals(), [&](const auto& signal) { return signal.name == controller; });
  const auto require = [&](const char* option, bool given, bool heeded, const char* who) {
    if (given && !heeded) throw BadParameter(fmt::format("{} is for {}; controller {} does not heed it", option, who, controller));
  };
  require("--commands", options.commands.has_value(), controller == "schedule", "--controller schedule");
  require("--interpolate", options.interpolate.has_value(), controller == "schedule", "--controller schedule");
  require("--targets", options.targets.has_value(), controller == "position", "--controller position");
  require("--channels", options.channels.has_value(), controller == "position" || is_signal, "test signals and --controller position");
}

/// How a run ended.
struct Ending {
  std::string status;  ///< status in the verdict
  std::string error;   ///< empty: none
  int exit_status;
};

/// The next free name of a recording: run.csv, run-2.csv, run-3.csv ...
fs::path freeName(const fs::path& first) {
  fs::path csv = first;
  for (int number = 2; fs::exists(csv); ++number) csv.replace_filename(fmt::format("{}-{}.csv", first.stem().string(), number));
  return csv;
}

/// What the runs of one window share.
struct Session {
  std::unique_ptr<RunWindow> window;
  std::optional<RunRequest> asked = {};  ///< the present run, if it is not the first
  fs::path first_csv = {};               ///< the first run's recording; empty: there is none yet

  InputHistory repeated() const { return asked ? asked->repeated : InputHistory{}; }
};

/// One run from the first command to the last row.
class Run {
 public:
  /// `session`: null without a window.
  Run(const ModelOptions& model, const RunOptions& options, Session* session = nullptr)
      : model_(model), options_(options), simulation_(simulationOptions(model)), session_(session) {
    simulation_.build(model.robot.value_or("arm"));
    if (!options_.controller) options_.controller = options.commands ? "schedule" : defaultController(robot(), options);
    requireHeeded(options_);
    addController();
    noteUnused();
    simulation_.parameters().requireAllKnown();
    duration_s_ = options.duration_s.value_or(defaultDurationS(options_, *controller_));
    RunLoop{duration_s_, options.record_interval_s, nullptr}.requireTimes(simulation_.stepS());
    if (options.against) against_ = readRecording(*options.against);
  }

  Simulation& simulation() { return simulation_; }

  /// The same run again, up to its end.
  RunRequest again() const { return {robotName(), *options_.controller, hands_->hands()->history(), csv_.filename().string()}; }

  int execute() {
    const std::string initial_state = model_.initial_state.value_or(simulation_.robot().initialState());
    // The first decision comes before the files are opened, because the columns depend on what the controller reports.
    const State first_state = robot().getState();
    const musclesim::Action first_action = controller_->output(first_state);
    csv_ = chooseRecording();
    signals_.emplace(robot(), *controller_, options_.record_signals, options_.summarise, simulation_.stepS());
    summary_.emplace(options_.summarise, signals_->names());
    tracking_.emplace(signals_->names());
    requireFigureSignals();
    if (prepareRecording(csv_) && options_.record) say(model_, fmt::format("made the folder {}", csv_.parent_path().string()));
    addSpectator(first_state);
    // A run that the user of a window has asked for is not the one of the command line, so `rerun` cannot repeat it.
    const bool is_of_command_line = !options_.only_record && !(session_ && session_->asked);
    const nlohmann::json origin = is_of_command_line ? jsonOf(keepOrigin(model_, options_, csv_)) : nlohmann::json();
    Recorder recorder(csv_.string(), describe(simulation_, options_, initial_state, origin), signals_->names());
    say(model_, fmt::format("{} physics, stepper {}, {} internal steps of {:.4g} s per step of {:g} s, seed {}",
                            nameOf(simulation_.physics().kind), simulation_.stepper().name(), simulation_.substeps(),
                            simulation_.internalStepS(), simulation_.stepS(), simulation_.seed()));
    if (!simulation_.stepper().message().empty()) say(model_, simulation_.stepper().message());
    if (!options_.target_mm.empty() && !controller_->targetMm())
      say(model_, fmt::format("warning: controller {} has no target; --target changes nothing", *options_.controller));
    if (!options_.record_signals.empty() && !signals_->added().empty())
      say(model_, fmt::format("also recorded, because the verdict needs them: {}", fmt::join(signals_->added(), ", ")));
    for (const std::string& note : controller_->notes()) say(model_, fmt::format("controller {}: {}", *options_.controller, note));
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
    if (!options_.only_record) report(verdict, drawFigure(recorder.rowCount()), ending);
    return ending.exit_status;
  }

 private:
  std::string robotName() const { return model_.robot.value_or("arm"); }

  /// Later runs of a window write beside the first one.
  fs::path chooseRecording() {
    if (session_ && !session_->first_csv.empty()) return freeName(session_->first_csv);
    const fs::path csv = recordingPath(options_, simulation_);
    requireReplaceable(csv.string());
    if (options_.out && !options_.overwrite) requireUnfinished(csv);
    if (options_.against) requireOther(csv, {*options_.against});
    if (options_.commands) requireOther(csv, {*options_.commands});
    if (session_) session_->first_csv = csv;
    return csv;
  }

  /// With a window, the user can take over from the controller.
  void addController() {
    auto controller = makeController(*options_.controller, requestFor(simulation_, options_));
    if (session_) {
      auto hands = std::make_unique<ManualController>(std::move(controller), robot().actuatorCount(), session_->repeated());
      hands_ = hands.get();
      controller = std::move(hands);
    }
    controller_ = &simulation_.control(std::move(controller));
  }

  /// A configuration may hold parameters of other controllers and tasks, as --print-config lists them for these.
  void noteUnused() {
    std::vector<std::string> groups = registeredControllers();
    for (const char* task : {"height_task", "reach_task"}) groups.push_back(task);
    const auto unused = simulation_.parameters().dropUnknownOfFiles(groups);
    if (!unused.empty())
      say(model_, fmt::format("controller {} has no use for {} of the configuration", *options_.controller, fmt::join(unused, ", ")));
  }

  void addSpectator(const State& first_state) {
    if (options_.pictures.wanted()) pictures_ = makePictures(options_.pictures, simulation_);
    spectator_ = pictures_.get();
    if (!session_) return;
    const std::string folder = csv_.has_parent_path() ? csv_.parent_path().string() : ".";
    session_->window->begin({hands_->hands(), robotName(), *options_.controller, csv_.filename().string()}, simulation_, first_state,
                            folder);
    spectator_ = session_->window.get();
  }

  void dismissSpectator(const std::optional<Diverged>& divergence) {
    if (!spectator_) return;
    if (divergence) spectator_->diverge(divergence->what());
    spectator_->finish();
  }

  /// What the user did, and of which recording this one repeats the beginning.
  void noteHands(Recorder& recorder) const {
    nlohmann::json intervals = nlohmann::json::array();
    for (const auto& interval : hands_->manualIntervals()) intervals.push_back({interval.from_s, interval.to_s});
    recorder.note("by_hand_s", intervals.dump());
    const auto pulls = pullsOf(hands_->hands()->history(), simulation_.stepS());
    if (!pulls.empty()) recorder.note("pulls", toJson(pulls));
    if (session_->repeated().step_count == 0) return;
    recorder.note("repeats",
                  nlohmann::json{{"recording", session_->asked->recording}, {"until_s", session_->asked->repeated.time_s}}.dump());
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

  /// Before the run, not after it.
  void requireFigureSignals() const {
    Recording columns;
    for (const std::string& name : signals_->names()) columns.signals.push_back({name, {}});
    signalsNamed(columns, options_.figure_signals);
  }

  /// Writes the figure beside the recording. Returns an empty path if the run ended before its first row.
  fs::path drawFigure(long row_count) const {
    if (row_count == 0) return {};
    fs::path svg = fs::path(csv_).replace_extension(".svg");
    if (options_.record && options_.out) {
      makeFolder(*options_.out);
      svg = fs::path(*options_.out) / svg.filename();
    }
    const Recording recording = readRecording(csv_.string());
    if (options_.figure_signals.empty())
      writeRunFigure(recording, robot().namedMuscleColors(), recording.info.description, svg.string());
    else
      replaceFile(svg.string(),
                  signalsFigureSvg(recording, options_.figure_signals, robot().namedMuscleColors(), recording.info.description));
    return svg;
  }

  void loop(Recorder& recorder, Progress& progress, const musclesim::Action& first_action) {
    RunLoop loop{duration_s_, options_.record_interval_s,
                 [&](const State& state, bool is_due) { record(recorder, progress, state, is_due); }};
    loop.goes_on = [this] { return goes_on_ && interruptSignal() == 0; };
    loop.after_step = [this] { warnOfGap(); };
    loop.command_is_late = [this](double interval_s) { warnOfLateCommands(interval_s); };
    runLoop(simulation_, *controller_, first_action, loop);
  }

  void record(Recorder& recorder, Progress& progress, const State& state, bool is_due) {
    if (hands_) simulation_.pull(hands_->input().pull);
    score_.add(state.time_s, state, *controller_);
    const std::vector<double> row = signals_->row(state);
    summary_->add(state.time_s, row);
    tracking_->add(state.time_s, row);
    if (is_due) recorder.append(state.time_s, row);
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
    verdict["real_time_factor"] = std::max(0.0, simulation_.time_s()) / wall_s;
    if (const auto tracking = tracking_->json(); !tracking.empty()) verdict["tracking"] = tracking;
    if (const auto signals = summary_->json(against_ ? &*against_ : nullptr); !signals.empty()) verdict["signals"] = signals;
    return verdict;
  }

  void sayEnding(const Ending& ending) const {
    if (!ending.error.empty()) tell("error: " + ending.error);
    if (ending.exit_status > interrupted_base) say(model_, "interrupted; the files hold everything up to then");
    const bool goes_on = session_ && session_->window->isAsked();
    if (ending.exit_status == done && options_.duration_s && hasEndedEarly() && !goes_on)
      say(model_, fmt::format("the window was closed: {:.4g} s of {:g} s are recorded", simulation_.time_s(), duration_s_));
  }

  void report(nlohmann::json verdict, const fs::path& svg, const Ending& ending) const {
    sayEnding(ending);
    say(model_, fmt::format("{:g} s simulated in {:.3g} s of wall time: {:.3g} x real time", simulation_.time_s(),
                            verdict["wall_s"].get<double>(), verdict["real_time_factor"].get<double>()));
    if (verdict.contains("tracking"))
      for (const auto& [joint, error] : verdict["tracking"].items())
        say(model_, fmt::format("{} is off its target by at most {:.3g} degrees from {:g} s on, RMS {:.3g} degrees", joint,
                                error["largest_deg"].get<double>(), error["from_s"].get<double>(), error["rmse_deg"].get<double>()));
    if (verdict.contains("reached_at_s") && !verdict["reached_at_s"].is_null())
      say(model_, fmt::format("target reached (within {:g} mm) at {:.2f} s, held for {:.0f} % of the time since",
                              verdict["reached_within_mm"].get<double>(), verdict["reached_at_s"].get<double>(),
                              100 * verdict["held_share"].get<double>()));
    if (verdict.contains("signals")) fmt::print("{}", summaryText(verdict["signals"]));
    fmt::print("log     {}\n", printable(csv_.string()));
    if (!svg.empty()) fmt::print("figure  {}\n", printable(svg.string()));
    if (model_.json) {
      verdict["command"] = "run";
      verdict["log"] = csv_.string();
      verdict["figure"] = svg.string();
      fmt::print("{}\n", verdict.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    }
  }

  Robot& robot() { return simulation_.robot(); }
  const Robot& robot() const { return const_cast<Simulation&>(simulation_).robot(); }

  const ModelOptions& model_;
  RunOptions options_;
  Simulation simulation_;
  Controller* controller_ = nullptr;
  double duration_s_;
  Session* session_;                     ///< null without a window
  ManualController* hands_ = nullptr;    ///< null without a window
  fs::path csv_;                         ///< the recording
  std::unique_ptr<Spectator> pictures_;  ///< may be null
  Spectator* spectator_ = nullptr;       ///< may be null
  std::optional<RunSignals> signals_;
  std::optional<SignalSummary> summary_;
  std::optional<Tracking> tracking_;
  std::optional<Recording> against_;
  Score score_;
  bool gap_warned_ = false, late_commands_warned_ = false, goes_on_ = true;
};

/// Runs one after the other in one window, until the user closes it. A run that cannot be made is explained in the window, and the one
/// before goes on. The exit status is the first that is not `done`.
int runInWindow(const ModelOptions& model, const RunOptions& options) {
  Session session{makeRunWindow(options.pictures, options.window_log.value_or(""))};
  std::optional<RunRequest> before;
  int status = done;
  do {
    ModelOptions its_model = model;
    RunOptions its_options = options;
    if (session.asked) {
      its_model.robot = session.asked->robot;
      its_options.controller.reset();
      if (!session.asked->controller.empty()) its_options.controller = session.asked->controller;
    }
    try {
      Run run(its_model, its_options, &session);
      if (options.verbose && !session.asked) list(run.simulation());
      const int ended = run.execute();
      if (status == done) status = ended;
      before = run.again();
      session.asked = session.window->takeRequest();
    } catch (const Error& error) {
      if (!before || dynamic_cast<const IoError*>(&error)) throw;
      session.window->say(error.what());
      session.asked = std::exchange(before, std::nullopt);
    }
  } while (session.asked && interruptSignal() == 0);
  return status;
}

}  // namespace

int run(const ModelOptions& model, const RunOptions& options) {
  requireUsedOptions(options);
  if (hasWindow(options) && !options.print_config) return runInWindow(model, options);
  Run run(model, options);
  if (options.verbose) list(run.simulation());
  if (options.print_config) {
    fmt::print("{}", run.simulation().parameters().toToml());
    return done;
  }
  return run.execute();
}

Action addRun(CLI::App& app, ModelOptions& model) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* named = app.add_subcommand("run", "Runs a robot under a controller and writes a log and a figure (the default)");
  for (CLI::App* command : {&app, named}) {
    addRunOptions(*command, *options);
    addModelOptions(*command, model);
  }
  return [&model, options] { return run(model, *options); };
}

}  // namespace musclesim::command_line
