/// The unit of a signal, from its name.
#pragma once

#include <string>

namespace musclesim {

/// The canonical unit of a signal: "s", "N", "mm", "deg"; empty for fractions, pure numbers and unknown names.
std::string signalUnit(const std::string& signal_name);

}  // namespace musclesim
