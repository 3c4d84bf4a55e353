#include "conversions.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/effect/effects_file.h"

namespace musclesim::python {

namespace {

std::string typeOf(const py::handle& value) {
  return Py_TYPE(value.ptr())->tp_name;
}

std::string textOf(const py::handle& value) {
  return py::str(value).cast<std::string>();
}

Parameter::Value valueFrom(const py::handle& value, const std::string& name) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  try {
    return value.cast<double>();
  } catch (const py::cast_error&) {
    throw BadParameter(name, textOf(value), fmt::format("be a number or a word, not {}", typeOf(value)));
  }
}

ActiveEffect effectFrom(const py::handle& value) {
  if (!py::isinstance<py::dict>(value))
    throw BadParameter("effect", textOf(value), R"(be {"id": ..., "component": ..., "parameters": {...}})");
  ActiveEffect effect;
  for (const auto& [key, entry] : value.cast<py::dict>()) {
    const auto name = textOf(key);
    if (name == "parameters" && py::isinstance<py::dict>(entry)) {
      for (const auto& [parameter, number] : entry.cast<py::dict>())
        effect.parameters[textOf(parameter)] = valueFrom(number, fmt::format("{}.{}", effect.id, textOf(parameter)));
    } else if ((name == "id" || name == "component") && py::isinstance<py::str>(entry)) {
      (name == "id" ? effect.id : effect.component) = entry.cast<std::string>();
    } else {
      throw BadParameter("effect." + name, textOf(entry), "be one of id (str), component (str), parameters (dict)");
    }
  }
  if (effect.id.empty()) throw BadParameter("effect", textOf(value), "have an id");
  return effect;
}

}  // namespace

Numbers numbersFrom(const py::handle& values, const std::string& what) {
  Numbers numbers;
  try {
    numbers = Numbers(py::reinterpret_borrow<py::object>(values));
  } catch (py::error_already_set& problem) {
    if (problem.matches(PyExc_KeyboardInterrupt)) throw;
    throw BadParameter(what, textOf(values), fmt::format("be an array of numbers, not {}", typeOf(values)));
  }
  if (numbers.ndim() != 1) throw BadParameter(what, "shape " + textOf(numbers.attr("shape")), "have one axis");
  return numbers;
}

void readPressures(const py::handle& values, const std::string& what, Action& action) {
  const Numbers numbers = numbersFrom(values, what);
  if (static_cast<std::size_t>(numbers.size()) != action.size())
    throw BadParameter(what, "shape " + textOf(numbers.attr("shape")), fmt::format("be ({},), one pressure per muscle", action.size()));
  const double* first = numbers.data();
  for (std::size_t i = 0; i < action.size(); ++i)
    if (!(first[i] >= 0 && first[i] <= 1))
      throw BadParameter(fmt::format("{}[{}]", what, i), fmt::format("{}", first[i]), "lie in 0 .. 1 of full scale");
  action.assign(first, first + action.size());
}

py::array_t<double> viewOf(const double* first, std::size_t count, const py::handle& owner) {
  py::array_t<double> view({static_cast<py::ssize_t>(count)}, {static_cast<py::ssize_t>(sizeof(double))}, first, owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

Parameters parametersFrom(const py::dict& values) {
  Parameters parameters;
  for (const auto& [key, value] : values) {
    const auto name = textOf(key);
    parameters.set(name, valueFrom(value, name), "parameters");
  }
  return parameters;
}

py::object toPython(const Parameter::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return py::float_(*number);
  return py::str(std::get<std::string>(value));
}

std::vector<ActiveEffect> effectsFrom(const py::object& effects) {
  if (effects.is_none()) return {};
  if (py::isinstance<py::str>(effects) || py::hasattr(effects, "__fspath__"))
    return readEffects(py::module_::import("os").attr("fspath")(effects).cast<std::string>());
  if (!py::isinstance<py::sequence>(effects)) throw BadParameter("effects", textOf(effects), "be a list of effects, or a file");
  std::vector<ActiveEffect> result;
  for (const py::handle effect : effects) result.push_back(effectFrom(effect));
  return result;
}

py::object fromJson(const std::string& text) {
  return py::module_::import("json").attr("loads")(text);
}

std::string toJson(const py::object& value) {
  return py::module_::import("json").attr("dumps")(value).cast<std::string>();
}

}  // namespace musclesim::python
