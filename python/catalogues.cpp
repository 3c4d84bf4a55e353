#include <pybind11/stl.h>

#include "bindings.h"
#include "musclesim/controller/controller_registry.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/robot/robot_registry.h"

namespace musclesim::python {

namespace {

py::dict robots() {
  py::dict names;
  for (const auto& [name, description] : registeredRobots()) names[py::str(name)] = description;
  return names;
}

py::dict controllers() {
  py::dict names;
  for (const std::string& name : registeredControllers()) names[py::str(name)] = controllerDescription(name);
  return names;
}

py::dict entryOf(const EffectParameter& parameter) {
  py::dict entry;
  entry["unit"] = parameter.unit;
  entry["neutral"] = parameter.neutral;
  if (parameter.choices.empty())
    entry["range"] = py::make_tuple(parameter.minimum, parameter.maximum);
  else
    entry["choices"] = parameter.choices;
  entry["description"] = parameter.meaning;
  return entry;
}

py::dict effects() {
  py::dict catalogue;
  for (const EffectInfo& info : effectCatalogue()) {
    py::dict entry, parameters;
    for (const EffectParameter& parameter : info.parameters) parameters[py::str(parameter.name)] = entryOf(parameter);
    entry["stage"] = nameOf(info.stage);
    entry["summary"] = info.summary;
    entry["equation"] = info.equation;
    entry["parameters"] = parameters;
    catalogue[py::str(info.id)] = entry;
  }
  return catalogue;
}

}  // namespace

void bindCatalogues(py::module_& module) {
  module.def("robots", &robots, "{name: description} of all robots that have a name.");
  module.def("controllers", &controllers, "{name: description} of all controllers that have a name.");
  module.def("effects", &effects, "The catalogue of effects: {id: {stage, summary, equation, parameters}}.");
}

}  // namespace musclesim::python
