/// Unique names.
#pragma once

#include <string>

namespace musclesim {

/// 16 hexadecimal digits from the system's source of randomness, to name files and processes: process ids are not unique, since several
/// containers may share a folder. Do not use it in a simulation.
std::string uniqueName();

}  // namespace musclesim
