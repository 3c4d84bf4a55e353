/// Python's values as those of the library, and back.
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <vector>

#include "bindings.h"
#include "musclesim/base/parameters.h"
#include "musclesim/log/active_effect.h"
#include "musclesim/robot/state.h"

namespace musclesim::python {

/// An array of numbers that is read where it lies if it is contiguous and of type float64, and is converted otherwise.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Throws BadParameter, with the name `what`, for what is no array of numbers with one axis.
Numbers numbersFrom(const py::handle& values, const std::string& what);
/// One pressure per muscle into `action`, whose size is the number of muscles. Throws BadParameter for another shape and for a pressure
/// that is not finite or not in 0..1.
void readPressures(const py::handle& values, const std::string& what, Action& action);

/// A read-only array on memory that belongs to `owner`, which lives as long as the array.
py::array_t<double> viewOf(const double* first, std::size_t count, const py::handle& owner);
inline py::array_t<double> viewOf(const std::vector<double>& values, const py::handle& owner) {
  return viewOf(values.data(), values.size(), owner);
}

/// {"name": number or word}. Throws BadParameter for values of another type.
Parameters parametersFrom(const py::dict& values);
py::object toPython(const Parameter::Value& value);
/// A list of {"id": ..., "component": ..., "parameters": {...}}, or the name of an effects file. Throws BadParameter, or as readEffects.
std::vector<ActiveEffect> effectsFrom(const py::object& effects);

/// What json.loads makes of a text, and the text that json.dumps makes of an object.
py::object fromJson(const std::string& text);
std::string toJson(const py::object& value);

}  // namespace musclesim::python
