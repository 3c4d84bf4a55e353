/// Controllers and force laws that are written in Python.
#pragma once

#include <memory>

#include "bindings.h"
#include "musclesim/controller/controller.h"
#include "musclesim/robot/robot.h"

namespace musclesim::python {

/// A controller that asks `controller`: an object of a subclass of Controller, or a function of the state. It holds Python's lock while it
/// asks. Throws BadParameter for anything else.
std::unique_ptr<Controller> controllerFrom(const py::object& controller);

/// Gives the robot's muscles the law `force_law`: one object for all, or a function (muscle, minimum_length_mm, maximum_length_mm) that
/// makes one. None leaves the laws as they are. Throws BadParameter for anything else.
void setForceLaws(Robot& robot, const py::object& force_law);

}  // namespace musclesim::python
