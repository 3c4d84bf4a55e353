/// What was measured, over all recordings.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "plant.h"

namespace musclesim {

/// All finite values of a compared signal; none if there is no such signal.
std::vector<double> measuredValues(const Plant& plant, const std::string& signal);

/// Where the hand was, mm, along x, y and z. If its position was not measured, it follows from the lengths and angles that were: by the
/// linear function of them that agrees best, by least squares, with the model without effects on the first recording; without values along
/// an axis in which the model moves it by less than 1 mm. Where one muscle pulls the hand along a straight line that is exact.
std::array<std::vector<double>, 3> handMm(const Plant& plant);

}  // namespace musclesim
