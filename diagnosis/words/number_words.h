/// Numbers as readers expect them: rounded to what is known, with intervals.
#pragma once

#include <cstddef>
#include <string>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

inline constexpr double nearly_all = 99.95;  ///< percent; larger values must not read as 100.0

/// With so many decimals; what rounds to zero has no sign.
std::string roundedWords(double value, int decimals);
/// "0.081 (0.077 to 0.085)": as many decimals as the interval justifies. "8" without an interval; a remark if the recordings do not
/// determine the value.
std::string estimateWords(const Estimate& estimate);
/// Whether a parameter was not fitted because nothing in the data depends on it.
bool isLeftOut(const Estimate& estimate);
/// "1 number", "2 numbers".
std::string counted(std::size_t count, const std::string& one, const std::string& several = "");
/// "96.2 %"; "more than 99.9 %" instead of a rounded 100 %.
std::string percentWords(double percent);
/// "3.8 %"; "less than 0.1 %" instead of a rounded 0.
std::string leftWords(double percent);
/// "93 %"; "over 99 %": nothing is certain.
std::string probabilityWords(double probability);

}  // namespace musclesim
