/// Units in the names of parameters.
#pragma once

#include <string>

namespace musclesim::description {

/// The unit at the end of a name: "mm" of "lever_mm", "N/mm" of "spring_N_per_mm"; empty if there is none that is known.
std::string unitFromSuffix(const std::string& name);

}  // namespace musclesim::description
