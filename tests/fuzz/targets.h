/// What is fuzzed: every reader of text from outside. Each target takes any bytes, and must return: an Error of this library is right, a
/// crash, another exception or more than a second is not.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace musclesim {

using FuzzTarget = void (*)(const std::string& bytes);

/// By name; tests/fuzz/corpus/NAME holds inputs that once mattered.
const std::vector<std::pair<std::string, FuzzTarget>>& fuzzTargets();

}  // namespace musclesim
