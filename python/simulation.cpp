#include "simulation.h"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "controllers.h"
#include "interruption.h"
#include "musclesim/base/error.h"
#include "musclesim/controller/controller_registry.h"
#include "musclesim/robot/robot_registry.h"
#include "musclesim/simulation/replay.h"

namespace musclesim::python {

/// While one lives, no other call may use the simulation.
class PythonSimulation::Use {
 public:
  explicit Use(PythonSimulation& simulation) : in_use_(simulation.in_use_) {
    if (in_use_.exchange(true)) throw BadParameter("this simulation is at work: one call at a time, and none from its own controller");
  }
  ~Use() { in_use_ = false; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  std::atomic<bool>& in_use_;
};

/// While one lives, the world asks Python whether it should stop.
class PythonSimulation::Heed {
 public:
  explicit Heed(PythonSimulation& simulation) : place_(simulation.interruption_) { place_ = &interruption_; }
  ~Heed() { place_ = nullptr; }
  Heed(const Heed&) = delete;
  Heed& operator=(const Heed&) = delete;
  Interruption& interruption() { return interruption_; }

 private:
  Interruption*& place_;
  Interruption interruption_;
};

PythonSimulation::PythonSimulation(Model model) : model_(std::move(model)) {
  model_.options.interrupted = [this] { return interruption_ && interruption_->isWanted(); };
  build();
  command_.assign(static_cast<std::size_t>(simulation_->robot().actuatorCount()), 0.0);
  const auto count = static_cast<py::ssize_t>(simulation_->robot().signalNames().size());
  readings_ = py::array_t<double>(count);
  reading_ = readings_.mutable_data();
  readings_.attr("setflags")(py::arg("write") = false);
  readAll();
}

PythonSimulation::~PythonSimulation() = default;

void PythonSimulation::build() {
  simulation_.reset();
  auto simulation = std::make_unique<Simulation>(model_.options);
  simulation->build([this](World& world) {
    auto robot = makeRobot(model_.robot, world);
    setForceLaws(*robot, model_.force_law);
    return robot;
  });
  simulation_ = std::move(simulation);
  was_started_ = left_within_step_ = false;
}

Simulation& PythonSimulation::open() {
  if (!simulation_) throw BadParameter("this simulation is closed");
  return *simulation_;
}

void PythonSimulation::close() {
  const Use use(*this);
  simulation_.reset();
}

void PythonSimulation::requireWhole() const {
  if (left_within_step_) throw BadParameter("an exception left this simulation within a step; start() it anew");
}

void PythonSimulation::readAll() {
  const Robot& robot = simulation_->robot();
  const std::vector<double> values = robot.signalValues(robot.getState());
  std::ranges::copy(values, reading_);
}

void PythonSimulation::begin(const std::string& initial_state) {
  simulation_->parameters().requireAllKnown();
  was_started_ = true;
  left_within_step_ = true;  // until the start has succeeded
  simulation_->start(initial_state, command_);
  left_within_step_ = false;
}

py::array PythonSimulation::start(const py::object& command, const std::optional<std::string>& initial_state,
                                  const std::optional<std::uint64_t>& seed) {
  const Use use(*this);
  open();
  Action first(command_.size(), 0.0);
  if (!command.is_none()) readPressures(command, "command", first);
  if (seed) model_.options.seed = *seed;
  if (was_started_ || seed) build();
  command_ = first;
  Heed heed(*this);
  try {
    const py::gil_scoped_release unlocked;
    begin(initial_state.value_or(model_.initial_state.value_or(simulation_->robot().initialState())));
    readAll();
  } catch (const Interrupted&) {
    heed.interruption().rethrow();
    throw;
  }
  return readings_;
}

py::array PythonSimulation::command(const py::object& pressures) {
  const Use use(*this);
  open();
  requireWhole();
  readPressures(pressures, "command", command_);
  const py::gil_scoped_release unlocked;
  simulation_->robot().step(command_);
  readAll();
  return readings_;
}

py::array PythonSimulation::step(const py::object& pressures, long count) {
  const Use use(*this);
  Simulation& simulation = open();
  requireWhole();
  if (count < 1) throw BadParameter("count", fmt::format("{}", count), "be at least 1");
  if (!pressures.is_none()) readPressures(pressures, "command", command_);
  Interruption interruption;
  {
    const py::gil_scoped_release unlocked;
    if (!was_started_) begin(model_.initial_state.value_or(simulation.robot().initialState()));
    if (!pressures.is_none()) simulation.robot().step(command_);
    left_within_step_ = true;
    for (long i = 0; i < count && !interruption.isWanted(); ++i) simulation.step();
    left_within_step_ = false;
    readAll();
  }
  interruption.rethrow();
  return readings_;
}

py::array PythonSimulation::observe() {
  const Use use(*this);
  open();
  readAll();
  return readings_;
}

py::array PythonSimulation::part(const std::string& begin) {
  const std::vector<std::string> names = open().robot().signalNames();
  const auto is_part = [&](const std::string& name) { return name.starts_with(begin); };
  const auto first = std::ranges::find_if(names, is_part);
  return viewOf(reading_ + (first - names.begin()), static_cast<std::size_t>(std::ranges::count_if(names, is_part)), readings_);
}

RecordingInfo PythonSimulation::describe(const std::string& initial_state, const RunArguments& arguments) {
  RecordingInfo info = describeModel(*simulation_, initial_state);
  const bool is_named = py::isinstance<py::str>(arguments.controller);
  const py::object named = is_named                                        ? arguments.controller
                           : py::hasattr(arguments.controller, "__name__") ? arguments.controller.attr("__name__")
                                                                           : py::type::of(arguments.controller).attr("__name__");
  const auto controller = py::str(named).cast<std::string>();
  info.description = fmt::format("{} under {}", info.robot, controller);
  nlohmann::json extra = nlohmann::json::parse(info.extra_json);
  extra["controller"] = controller;
  if (simulation_->controller()->targetMm() && is_named) {
    info.description += fmt::format(", {} task", arguments.task.value_or("height"));
    extra["task"] = arguments.task.value_or("height");
  }
  if (!model_.force_law.is_none()) extra["force_law"] = simulation_->robot().actuators().front()->forceLaw().name();
  info.extra_json = extra.dump();
  return info;
}

void PythonSimulation::runInto(Recording& recording, Recorder* recorder, Controller& controller, const RunLoop& times,
                               const std::string& initial_state) {
  RunLoop loop = times;
  Interruption& interruption = *interruption_;
  loop.goes_on = [&] { return !interruption.isWanted(); };
  loop.row = [&](const State& state, bool is_due) {
    if (!is_due) return;
    const std::vector<double> values = runRow(simulation_->robot(), controller, state);
    if (values.size() != recording.signals.size())
      throw BadParameter("what the controller reports", fmt::format("{} columns with those of the robot", values.size()),
                         fmt::format("be {} at all times, as at the beginning", recording.signals.size()));
    if (recorder) recorder->append(state.time_s, values);
    recording.time_s.push_back(state.time_s);
    for (std::size_t i = 0; i < values.size(); ++i) recording.signals[i].values.push_back(values[i]);
  };
  begin(initial_state);
  left_within_step_ = true;
  runLoop(*simulation_, controller, command_, loop);
  left_within_step_ = false;
}

namespace {

/// What the world has once a run is over. Python's collector does not see what the world holds, so a controller that knows its simulation
/// would keep it for ever.
class NoController final : public Controller {
 public:
  Action output(const State&) override { throw BadParameter("the run of this controller is over"); }
};

struct Release {
  explicit Release(Simulation& of) : simulation(of) {}
  ~Release() { simulation.control(std::make_unique<NoController>()); }
  Release(const Release&) = delete;
  Release& operator=(const Release&) = delete;
  Simulation& simulation;
};

/// What the sidecar says about the end of a run.
void closeWith(const char* status, const std::string& message, Recorder* recorder) {
  if (!recorder) return;
  nlohmann::json verdict = {{"status", status}};
  if (!message.empty()) verdict["message"] = message;
  recorder->note("verdict", verdict.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  recorder->close(std::string(status) == "done");
}

std::unique_ptr<Controller> makeController(const RunArguments& arguments, Simulation& simulation) {
  if (!py::isinstance<py::str>(arguments.controller)) return controllerFrom(arguments.controller);
  ControllerRequest request = controllerRequest(simulation, arguments.task.value_or("height"), arguments.decision_interval_s);
  request.target_mm = arguments.target_mm;
  request.commands_file = arguments.commands;
  request.targets_file = arguments.targets;
  request.channels = arguments.channels;
  request.interpolate = arguments.interpolate;
  return musclesim::makeController(arguments.controller.cast<std::string>(), request);
}

}  // namespace

Recording PythonSimulation::run(RunArguments arguments) {
  const Use use(*this);
  open();
  if (was_started_) build();
  Simulation& simulation = *simulation_;
  if (arguments.controller.is_none())
    arguments.controller =
        py::str(arguments.commands.empty() ? defaultController(simulation.robot(), arguments.task || arguments.target_mm) : "schedule");
  Controller& controller = simulation.control(makeController(arguments, simulation));
  simulation.parameters().requireAllKnown();
  const RunLoop times{arguments.duration_s.value_or(defaultDurationS(controller)), arguments.record_interval_s, nullptr};
  times.requireTimes(simulation.stepS());
  const std::string initial_state = model_.initial_state.value_or(simulation.robot().initialState());
  // As in the program: the first decision is made before the file is opened, because the columns depend on what the controller reports.
  command_ = controller.output(simulation.robot().getState());
  Recording recording;
  recording.info = describe(initial_state, arguments);
  recording.notes = controller.notes();
  for (const std::string& name : runColumns(simulation.robot(), controller)) recording.signals.push_back({name, {}});
  std::unique_ptr<Recorder> recorder;
  if (arguments.record) {
    requireReplaceable(*arguments.record);
    recorder = std::make_unique<Recorder>(*arguments.record, recording.info, runColumns(simulation.robot(), controller));
  }
  Heed heed(*this);
  const Release release(simulation);
  try {
    const py::gil_scoped_release unlocked;
    runInto(recording, recorder.get(), controller, times, initial_state);
    readAll();
  } catch (const Interrupted&) {
    // The interruption knows why.
  } catch (const py::error_already_set& error) {
    const bool is_interrupt = error.matches(PyExc_KeyboardInterrupt);
    closeWith(is_interrupt ? "interrupted" : "failed", is_interrupt ? "" : error.what(), recorder.get());
    throw;
  } catch (const std::exception& error) {
    closeWith(dynamic_cast<const Diverged*>(&error) ? "diverged" : "failed", error.what(), recorder.get());
    throw;
  }
  closeWith(heed.interruption().isWanted() ? "interrupted" : "done", "", recorder.get());
  heed.interruption().rethrow();
  recording.info.complete = true;
  recording.file = arguments.record.value_or("");
  return recording;
}

}  // namespace musclesim::python
