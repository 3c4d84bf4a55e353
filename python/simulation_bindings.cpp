#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings.h"
#include "simulation.h"

namespace musclesim::python {

namespace {

py::dict parametersOf(PythonSimulation& self) {
  py::dict parameters;
  for (const Parameter& p : self.open().parameters().declared()) {
    py::dict entry;
    entry["value"] = toPython(p.value);
    entry["default"] = toPython(p.default_value);
    entry["unit"] = p.unit;
    if (p.choices.empty())
      entry["range"] = py::make_tuple(p.minimum, p.maximum);
    else
      entry["choices"] = p.choices;
    entry["description"] = p.description;
    parameters[py::str(p.name)] = entry;
  }
  return parameters;
}

std::unique_ptr<PythonSimulation> make(const std::string& robot, const std::string& physics, double step_s, std::uint64_t seed,
                                       const py::dict& parameters, const py::object& effects, py::object force_law,
                                       std::optional<std::string> initial_state, const std::string& stepper, int substeps, bool plane) {
  Model model{robot, {}, std::move(initial_state), std::move(force_law)};
  model.options.physics = physicsFromName(physics);
  model.options.stepper = stepperFromName(stepper);
  model.options.step_s = step_s;
  model.options.substeps = substeps;
  model.options.plane = plane;
  model.options.seed = seed;
  model.options.parameters = parametersFrom(parameters);
  model.options.effects = effectsFrom(effects);
  return std::make_unique<PythonSimulation>(std::move(model));
}

auto view(const char* begin) {
  return [begin](PythonSimulation& self) { return self.part(begin); };
}

template <class Type>
auto ask(Type (Simulation::*member)() const) {
  return [member](PythonSimulation& self) { return (self.open().*member)(); };
}

constexpr const char* about =
    R"(A robot in a world, moved step by step.

    simulation = Simulation("elbow", parameters={"muscle.model": "line"})
    simulation.start([0.2, 0.2])
    while simulation.time_s < 1:
        readings = simulation.step([0.6, 0.2])

robot: a name (musclesim.robots()) or a robot file NAME.toml.  physics: "si", "original" or "scaled".  step_s: control step in s.
seed: of all random numbers.  parameters: {"name": number or word}, see parameters().  effects: a list of
{"id": ..., "component": ..., "parameters": {...}} or an effects file.  force_law: a ForceLaw for all muscles, or a function
(muscle, minimum_length_mm, maximum_length_mm) that makes one.  initial_state: "built" or "settled" (default: the robot's own).
stepper: "auto", "chain", "ode" or "quick".  substeps: internal steps per control step, 0: as many as the muscles need.

All readings are in one array of shape (len(signals),), which every call of step, command and observe fills anew: copy what you keep.
The arrays pressure, force_N, ... are parts of it. Equal arguments give equal bits, those of the program.)";

void bindSteps(py::class_<PythonSimulation>& simulation) {
  simulation
      .def("start", &PythonSimulation::start, py::arg("command") = py::none(), py::arg("initial_state") = py::none(),
           py::arg("seed") = py::none(),
           "Begins anew at time 0 in the initial state for the first command, shape (muscles,), 0..1 (default: no pressure). Returns the\n"
           "readings, shape (signals,).")
      .def("step", &PythonSimulation::step, py::arg("command") = py::none(), py::arg("count") = 1,
           "Commands pressures, shape (muscles,), fraction of full scale 0..1 (None: they stay), and moves the world by `count` control\n"
           "steps of step_s, without Python's lock. The first call starts. Returns the readings, shape (signals,). Raises Diverged.")
      .def("command", &PythonSimulation::command, py::arg("pressures"),
           "Sets the pressures that hold from now on, shape (muscles,), fraction of full scale 0..1. Returns the readings just after they\n"
           "began to act, as a recording has them.")
      .def("observe", &PythonSimulation::observe, "The readings now, shape (signals,): mm, deg, N, fractions, in the order of `signals`.")
      .def("close", &PythonSimulation::close, "Frees the world. The arrays stay; every other call then raises BadParameter.")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](PythonSimulation& self, const py::args&) { self.close(); });
}

void bindRun(py::class_<PythonSimulation>& simulation) {
  simulation.def(
      "_run",
      [](PythonSimulation& self, py::object controller, std::optional<double> duration_s, std::optional<std::string> record,
         std::optional<double> record_interval_s, std::optional<std::string> task, std::optional<Vector> target_mm,
         std::optional<double> decision_interval_s, std::string commands, std::string targets, std::string channels, bool interpolate) {
        return self.run({std::move(controller), duration_s, std::move(record), record_interval_s, std::move(task), std::move(target_mm),
                         decision_interval_s, std::move(commands), std::move(targets), std::move(channels), interpolate});
      },
      py::arg("controller"), py::arg("duration_s"), py::arg("record"), py::arg("record_interval_s"), py::arg("task"), py::arg("target_mm"),
      py::arg("decision_interval_s"), py::arg("commands"), py::arg("targets"), py::arg("channels"), py::arg("interpolate"));
}

void bindViews(py::class_<PythonSimulation>& simulation) {
  simulation
      .def_property_readonly("pressure", view("pressure_"), "Part of the readings: pressures, shape (muscles,), fraction of full scale.")
      .def_property_readonly("force_N", view("force_"), "Part of the readings: tensions in N, shape (muscles,).")
      .def_property_readonly("length_mm", view("length_"), "Part of the readings: lengths in mm, shape (muscles,).")
      .def_property_readonly("angle_deg", view("angle_"), "Part of the readings: joint angles in degrees, shape (joints,).")
      .def_property_readonly("hand_mm", view("hand_"), "Part of the readings: the hand in mm, shape (3,), or (0,) without a hand.");
}

void bindProperties(py::class_<PythonSimulation>& simulation) {
  simulation
      .def_property_readonly(
          "signals", [](PythonSimulation& self) { return py::tuple(py::cast(self.open().robot().signalNames())); },
          "Names of the readings, as the columns of a recording.")
      .def_property_readonly(
          "muscle_count", [](PythonSimulation& self) { return self.open().robot().actuatorCount(); }, "Number of muscles.")
      .def_property_readonly("time_s", ask(&Simulation::time_s), "Time in s since the start.")
      .def_property_readonly("step_s", ask(&Simulation::stepS), "Control step in s.")
      .def_property_readonly("substeps", ask(&Simulation::substeps), "Internal steps per control step.")
      .def_property_readonly("seed", ask(&Simulation::seed), "Seed of all random numbers.")
      .def_property_readonly(
          "robot", [](const PythonSimulation& self) { return self.model().robot; }, "The robot, as it was asked for.")
      .def_property_readonly("closed", &PythonSimulation::isClosed, "Whether it was closed.")
      .def_property_readonly(
          "worst_gap_mm", [](PythonSimulation& self) { return self.open().worstGap().gap_mm; },
          "The largest distance in mm by which a joint has come apart so far.")
      .def("parameters", &parametersOf, "All named parameters of the model: {name: {value, default, unit, range or choices, description}}.")
      .def("__repr__", [](PythonSimulation& self) {
        return self.isClosed() ? fmt::format("<musclesim.Simulation of {}, closed>", self.model().robot)
                               : fmt::format("<musclesim.Simulation of {} at {:g} s>", self.model().robot, self.open().time_s());
      });
}

}  // namespace

void bindSimulation(py::module_& module) {
  py::class_<PythonSimulation> simulation(module, "_Simulation", about);
  simulation.def(py::init(&make), py::arg("robot") = "arm", py::kw_only(), py::arg("physics") = "si", py::arg("step_s") = 0.01,
                 py::arg("seed") = 1, py::arg("parameters") = py::dict(), py::arg("effects") = py::none(),
                 py::arg("force_law") = py::none(), py::arg("initial_state") = py::none(), py::arg("stepper") = "auto",
                 py::arg("substeps") = 0, py::arg("plane") = false);
  bindSteps(simulation);
  bindRun(simulation);
  bindViews(simulation);
  bindProperties(simulation);
}

}  // namespace musclesim::python
