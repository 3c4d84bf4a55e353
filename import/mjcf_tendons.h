/// Tendons and actuators of an MJCF file.
#pragma once

#include "mjcf_bodies.h"
#include "mjcf_document.h"

namespace musclesim {

/// Reads <tendon> and <actuator>: a spatial tendon that an actuator drives becomes a muscle, another one that is straight and has a
/// stiffness a spring. Says in the notes what else there is.
void readMjcfTendons(const MjcfDocument& document, MjcfModel& model);

}  // namespace musclesim
