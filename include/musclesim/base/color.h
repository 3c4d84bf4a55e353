/// Colours, shared by the screen and the plots.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace musclesim {

/// An RGB colour, each component 0..1, with the name people use for it.
struct Color {
  double red = 0.8, green = 0.8, blue = 0.8;
  std::string name;
};

/// The colour of a muscle: from `given` or, if `given` is too short, a colour that is easy to tell from the others.
Color muscleColor(std::size_t muscle, const std::vector<Color>& given);

}  // namespace musclesim
