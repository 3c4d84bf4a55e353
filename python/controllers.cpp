#include "controllers.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <utility>

#include "conversions.h"
#include "musclesim/base/error.h"

namespace musclesim::python {

namespace {

/// What a subclass in Python overrides. The caller need not have Python's lock.
class ControllerOfPython : public Controller {
 public:
  Action output(const State& state) override {
    const py::gil_scoped_acquire lock;
    const py::function override = py::get_override(static_cast<const Controller*>(this), "output");
    if (!override) throw BadParameter("a subclass of Controller must define output(state)");
    return pressuresOf(override, state);
  }
  std::optional<double> activity() const override {
    const py::gil_scoped_acquire lock;
    const py::function override = py::get_override(static_cast<const Controller*>(this), "activity");
    const py::object activity = override ? override() : py::none();
    if (activity.is_none()) return std::nullopt;
    try {
      return activity.cast<double>();
    } catch (const py::cast_error&) {
      throw BadParameter("activity", py::repr(activity).cast<std::string>(), "be a number or None");
    }
  }
  std::optional<Vector> targetMm() const override {
    const py::gil_scoped_acquire lock;
    const py::function override = py::get_override(static_cast<const Controller*>(this), "target_mm");
    const py::object target = override ? override() : py::none();
    if (target.is_none()) return std::nullopt;
    const Numbers numbers = numbersFrom(target, "target_mm");
    if (numbers.size() != 3) throw BadParameter("target_mm", fmt::format("{} numbers", numbers.size()), "have 3: x, y, z in mm");
    return Vector(numbers.at(0), numbers.at(1), numbers.at(2));
  }
  /// A dict of numbers by name.
  std::vector<std::pair<std::string, double>> signals() const override {
    const py::gil_scoped_acquire lock;
    const py::function override = py::get_override(static_cast<const Controller*>(this), "signals");
    if (!override) return {};
    const py::object signals = override();
    if (!py::isinstance<py::dict>(signals))
      throw BadParameter("signals", py::repr(signals).cast<std::string>(), "be a dict of numbers by column");
    std::vector<std::pair<std::string, double>> values;
    for (const auto& [name, value] : signals.cast<py::dict>()) try {
        values.emplace_back(py::str(name).cast<std::string>(), value.cast<double>());
      } catch (const py::cast_error&) {
        throw BadParameter("signals", py::repr(signals).cast<std::string>(), "be a dict of numbers by column");
      }
    requireSameNames(values);
    return values;
  }
  bool targetIsHeight() const override { PYBIND11_OVERRIDE_NAME(bool, Controller, "target_is_height", targetIsHeight, ); }

  /// Columns must not change or be exchanged in the middle of a recording.
  void requireSameNames(const std::vector<std::pair<std::string, double>>& signals) const {
    std::vector<std::string> names;
    for (const auto& [name, value] : signals) names.push_back(name);
    if (!signal_names_) signal_names_ = names;
    if (names != *signal_names_)
      throw BadParameter("signals", fmt::format("{}", fmt::join(names, ", ")),
                         fmt::format("have the same names in the same order at all times: {}", fmt::join(*signal_names_, ", ")));
  }

  /// Python may keep the state that it gets, so it gets one of its own.
  static Action pressuresOf(const py::function& function, const State& state) {
    Action action(state.command.size());
    const py::object pressures = function(State(state));
    if (pressures.is_none())
      throw BadParameter(
          fmt::format("the controller returned None: return an array of {} pressures (fractions of full scale, 0 .. 1)", action.size()));
    readPressures(pressures, "the controller's output", action);
    return action;
  }

 private:
  mutable std::optional<std::vector<std::string>> signal_names_;  ///< of the first call
};

/// Passes on to the C++ part of a Python object, and keeps that object.
class HeldController final : public Controller {
 public:
  explicit HeldController(py::object owner) : owner_(std::move(owner)), controller_(owner_.cast<Controller&>()) {}
  ~HeldController() override {
    const py::gil_scoped_acquire lock;
    owner_ = py::object();
  }
  HeldController(const HeldController&) = delete;
  HeldController& operator=(const HeldController&) = delete;

  Action output(const State& state) override { return controller_.output(state); }
  std::optional<double> activity() const override { return controller_.activity(); }
  std::optional<Vector> targetMm() const override { return controller_.targetMm(); }
  bool targetIsHeight() const override { return controller_.targetIsHeight(); }
  std::vector<std::pair<std::string, double>> signals() const override { return controller_.signals(); }

 private:
  py::object owner_;
  Controller& controller_;
};

/// Asks a function of the state.
class FunctionController final : public Controller {
 public:
  explicit FunctionController(py::function function) : function_(std::move(function)) {}
  ~FunctionController() override {
    const py::gil_scoped_acquire lock;
    function_ = py::function();
  }
  FunctionController(const FunctionController&) = delete;
  FunctionController& operator=(const FunctionController&) = delete;

  Action output(const State& state) override {
    const py::gil_scoped_acquire lock;
    return ControllerOfPython::pressuresOf(function_, state);
  }

 private:
  py::function function_;
};

using Column = std::vector<double> State::*;

/// An attribute of State: a view without a copy.
auto viewOfColumn(Column column) {
  return [column](const py::object& self) { return viewOf(self.cast<const State&>().*column, self); };
}

py::object handOf(const py::object& self) {
  const auto& hand = self.cast<const State&>().hand_mm;
  return hand ? py::object(viewOf(hand->data(), 3, self)) : py::none();
}

py::object targetOf(const Controller& controller) {
  const auto target = controller.targetMm();
  return target ? py::object(py::array_t<double>(3, target->data())) : py::none();
}

}  // namespace

std::unique_ptr<Controller> controllerFrom(const py::object& controller) {
  if (py::isinstance<Controller>(controller)) return std::make_unique<HeldController>(controller);
  if (PyCallable_Check(controller.ptr()) && !PyType_Check(controller.ptr()))
    return std::make_unique<FunctionController>(py::reinterpret_borrow<py::function>(controller));
  throw BadParameter("controller", py::repr(controller).cast<std::string>(),
                     "be a name, an object of a subclass of Controller, or a function of the state");
}

void bindControllers(py::module_& module) {
  py::class_<State>(module, "State", "The readings of a robot at one time. Arrays are read-only views, one entry per muscle or joint.")
      .def_readonly("time_s", &State::time_s, "Time in s.")
      .def_property_readonly("command", viewOfColumn(&State::command), "Commanded pressures, shape (muscles,), fraction of full scale.")
      .def_property_readonly("pressure", viewOfColumn(&State::pressure), "Pressures, shape (muscles,), fraction of full scale.")
      .def_property_readonly("force_N", viewOfColumn(&State::force_N), "Tensions in N, shape (muscles,), pulling positive.")
      .def_property_readonly("length_mm", viewOfColumn(&State::length_mm), "Lengths in mm, shape (muscles,).")
      .def_property_readonly("angle_deg", viewOfColumn(&State::angle_deg), "Joint angles in degrees, shape (joints,).")
      .def_property_readonly("hand_mm", handOf, "Position of the hand in mm, shape (3,), y up; None if the robot reports none.");
  py::class_<Controller, ControllerOfPython>(module, "Controller",
                                             "Decides the pressures. A subclass defines output(state) and, if it likes, activity(), "
                                             "target_mm(), target_is_height() and signals().\n\n"
                                             "    class Swing(musclesim.Controller):\n"
                                             "        def output(self, state):\n"
                                             "            return [0.5 + 0.3 * math.sin(state.time_s), 0.5]")
      .def(py::init<>())
      .def("output", &Controller::output, py::arg("state"),
           "Pressures to command now: an array of shape (muscles,), fraction of full scale 0..1. Called once per control step.")
      .def("activity", &Controller::activity, "Activity for the recording's column `activity`, a pure number; None: no column.")
      .def("target_mm", targetOf, "Target of the hand in mm, shape (3,), for the columns `target_*_mm`; None: no columns.")
      .def(
          "signals",
          [](const Controller& controller) {
            py::dict signals;
            for (const auto& [name, value] : controller.signals()) signals[py::str(name)] = value;
            return signals;
          },
          "Further columns of the recording: {name: number}, the same names at all times, target_<joint>_deg or controller_<name>.")
      .def("target_is_height", &Controller::targetIsHeight, "Whether only the target's height (y) counts.");
}

}  // namespace musclesim::python
