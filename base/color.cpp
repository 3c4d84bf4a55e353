#include "musclesim/base/color.h"

namespace musclesim {

namespace {

/// Colours that differ well, also for colour-blind readers. Source: Okabe and Ito 2008.
const std::vector<Color> distinct_colors = {
    {0.0, 0.45, 0.70, "blue"},  {0.84, 0.37, 0.0, "vermilion"}, {0.0, 0.62, 0.45, "bluish green"}, {0.80, 0.47, 0.65, "rose"},
    {0.90, 0.62, 0.0, "amber"}, {0.34, 0.71, 0.91, "sky blue"}, {0.35, 0.35, 0.35, "dark gray"}};

}  // namespace

Color muscleColor(std::size_t muscle, const std::vector<Color>& given) {
  if (muscle < given.size()) return given[muscle];
  const std::size_t further = muscle - given.size();
  const std::size_t times_through_all = further / distinct_colors.size();
  const double brightness = 1 / (1 + 0.45 * static_cast<double>(times_through_all));
  const Color& color = distinct_colors[further % distinct_colors.size()];
  return {color.red * brightness, color.green * brightness, color.blue * brightness, times_through_all == 0 ? color.name : ""};
}

}  // namespace musclesim
