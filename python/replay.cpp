#include "musclesim/simulation/replay.h"

#include <pybind11/stl.h>

#include <memory>
#include <optional>

#include "conversions.h"
#include "interruption.h"
#include "replay_options.h"

namespace musclesim::python {

ReplayOptions replayOptionsFrom(const py::dict& given) {
  ReplayOptions options;
  const auto takeText = [&](const char* name, std::optional<std::string>& place) {
    if (given.contains(name) && !given[name].is_none()) place = given[name].cast<std::string>();
  };
  takeText("robot", options.robot);
  takeText("initial_state", options.initial_state);
  std::optional<std::string> physics, stepper;
  takeText("physics", physics);
  if (physics) options.physics = physicsFromName(*physics);
  takeText("stepper", stepper);
  if (stepper) options.stepper = stepperFromName(*stepper);
  if (given.contains("step_s") && !given["step_s"].is_none()) options.step_s = given["step_s"].cast<double>();
  if (given.contains("substeps")) options.substeps = given["substeps"].cast<int>();
  if (given.contains("plane")) options.plane = given["plane"].cast<bool>();
  if (given.contains("seed") && !given["seed"].is_none()) options.seed = given["seed"].cast<std::uint64_t>();
  if (given.contains("parameters")) options.parameters = parametersFrom(given["parameters"].cast<py::dict>());
  if (given.contains("effects")) options.effects = effectsFrom(given["effects"]);
  return options;
}

namespace {

py::dict errorsOf(const ReplayResult& result) {
  py::dict errors;
  for (const SignalError& e : result.errors) {
    py::dict entry;
    const auto number = [&](double value) { return e.sample_count > 0 ? py::object(py::float_(value)) : py::none(); };
    entry["rmse"] = number(e.rmse);
    entry["largest"] = number(e.largest);
    entry["samples"] = e.sample_count;
    errors[py::str(e.name)] = entry;
  }
  return errors;
}

ReplayResult replay(Recording recording, const py::dict& model) {
  if (recording.file.empty()) recording.file = "recording in memory";
  ReplayOptions options = replayOptionsFrom(model);
  Interruption interruption;
  options.interrupted = [&] { return interruption.isWanted(); };
  ReplayResult result;
  {
    const py::gil_scoped_release unlocked;
    result = replayRecording(recording, options);
  }
  interruption.rethrow();
  return result;
}

}  // namespace

void bindReplay(py::module_& module) {
  py::class_<ReplayResult>(module, "Replay", "What the model measures under a recording's commands, and how far it is off.")
      .def_property_readonly(
          "simulated", [](const ReplayResult& r) { return r.simulated; }, "A Recording at the recording's times.")
      .def_property_readonly("errors", &errorsOf,
                             "{signal: {rmse, largest, samples}}, simulated minus recorded, in the signal's unit; None without samples.")
      .def_readonly("divergence", &ReplayResult::divergence, "The message if the model diverged, else None.")
      .def_readonly("stepper", &ReplayResult::stepper, "The stepper that was used.")
      .def_readonly("substeps", &ReplayResult::substeps, "Internal steps per control step.")
      .def_property_readonly(
          "worst_gap_mm", [](const ReplayResult& r) { return r.worst_gap.gap_mm; },
          "The largest distance in mm by which a joint came apart.");
  module.def("_replay", &replay, py::arg("recording"), py::arg("model"));
}

}  // namespace musclesim::python
