/// The parts of the Python module `_musclesim`, one function per source.
#pragma once

#include <pybind11/pybind11.h>

namespace musclesim::python {

namespace py = pybind11;

/// C++ exceptions become those of musclesim/_errors.py.
void translateErrors();
void bindRecording(py::module_& module);
void bindControllers(py::module_& module);
void bindForceLaws(py::module_& module);
void bindSimulation(py::module_& module);
void bindReplay(py::module_& module);
void bindDiagnosis(py::module_& module);
/// Lists of what there is: robots, controllers, effects.
void bindCatalogues(py::module_& module);

}  // namespace musclesim::python
