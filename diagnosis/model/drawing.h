/// The drawing of a robot for the report.
#pragma once

#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// The simulation's robot as it stands, projected onto the plane of x and y.
RobotDrawing drawingOf(Simulation& simulation);

}  // namespace musclesim
