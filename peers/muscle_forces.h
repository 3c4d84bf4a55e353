/// Forces of muscles in the units of the other engines (m, N).
///
/// The libraries of the engines compile these functions themselves, and this header needs no C++20: Simbody's headers do not allow it.
#pragma once

namespace musclesim {

class Actuator;

namespace peers {

/// The force that a muscle's law gives, N: as in the simulation, without effects.
double tensionN(const Actuator& actuator, double pressure_ratio, double length_m);

/// The force of a line muscle, N: its law's, a slider's friction, and the stop at its longest length (LineOfPull).
double lineForceN(const Actuator& actuator, double pressure_ratio, double length_m, double speed_m_per_s);

/// The stops of the hinges between links at plus and minus this angle, which close as the chain shortens.
double hingeStopRad(const Actuator& actuator, double length_m);

}  // namespace peers
}  // namespace musclesim
