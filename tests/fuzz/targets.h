/// Fuzz targets: one for every reader of external text. Each target takes any bytes. It may throw an Error of this library; a crash, any
/// other exception or a run time above one second is a failure.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace musclesim {

using FuzzTarget = void (*)(const std::string& bytes);

/// All targets by name; tests/fuzz/corpus/NAME holds inputs that found faults or cover special cases.
const std::vector<std::pair<std::string, FuzzTarget>>& fuzzTargets();

}  // namespace musclesim
