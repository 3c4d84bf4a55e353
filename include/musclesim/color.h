/// Colours, shared by the screen and the plots.
#pragma once

#include <string>

namespace musclesim {

/// An RGB colour, each component 0..1, with the name people use for it.
struct Color {
  double red = 0.8, green = 0.8, blue = 0.8;
  std::string name;
};

}  // namespace musclesim
