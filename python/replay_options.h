/// The model of a replay or a diagnosis.
#pragma once

#include "bindings.h"
#include "musclesim/simulation/replay.h"

namespace musclesim::python {

/// From keyword arguments: robot, physics, step_s, seed, parameters, effects, initial_state, stepper, substeps, plane. What is not given is
/// the recording's.
ReplayOptions replayOptionsFrom(const py::dict& given);

}  // namespace musclesim::python
