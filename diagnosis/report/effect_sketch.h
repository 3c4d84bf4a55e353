/// Small drawings of what effects do, from their laws with strengths that show well.
#pragma once

#include <string>

namespace musclesim {

/// An inline SVG: expected (thin, dashed) and with the effect (thick). Empty for an effect without a drawing.
std::string effectSketch(const std::string& id);

}  // namespace musclesim
