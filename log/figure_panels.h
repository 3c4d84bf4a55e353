/// What the figure of a run shows: which signals of a recording, in which colours, under which titles.
#pragma once

#include <string>
#include <vector>

#include "curve.h"
#include "musclesim/base/color.h"
#include "musclesim/log/recording.h"

namespace musclesim {

/// One signal as it shall be drawn.
struct Curve {
  const Signal* signal;
  Color color;
  std::string label;
  Between between = Between::straight;
  double width = 1.3;
};

/// One diagram: its curves and the titles of its axes.
struct Panel {
  std::vector<Curve> curves;
  std::string axis_title;
  std::vector<Curve> right_curves;
  std::string right_axis_title;
  bool is_fraction = false;  ///< the axis shows at least 0..1
  bool empty() const { return curves.empty() && right_curves.empty(); }
};

/// Above: height, target and activity; without a hand the angles, lengths or forces, whichever is measured first.
Panel upperPanel(const Recording& recording, const std::vector<Color>& muscle_colors);

/// Below: the pressures, or the commands if no pressure is measured.
Panel lowerPanel(const Recording& recording, const std::vector<Color>& muscle_colors);

}  // namespace musclesim
