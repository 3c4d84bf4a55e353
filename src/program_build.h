/// Identifies the running program beyond its version.
#pragma once

#include <map>
#include <string>

namespace musclesim::command_line {

/// What the numbers of a run depend on beside its inputs: the linker's build ids (ELF note NT_GNU_BUILD_ID, a hash of the contents) of the
/// program, ODE and the C library's mathematical functions, and the name of the processor, since these functions differ between
/// processors. "unknown" where there is none.
std::map<std::string, std::string> programBuild();

}  // namespace musclesim::command_line
