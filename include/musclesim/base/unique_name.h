/// Names that nobody else has.
#pragma once

#include <string>

namespace musclesim {

/// 16 hexadecimal digits from the system's source of randomness, for names of files and processes: ids of processes are the same in several
/// containers that share a folder. Not for anything that a simulation computes.
std::string uniqueName();

}  // namespace musclesim
