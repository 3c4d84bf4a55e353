/// The contents of a run's figure: which signals of a recording it shows, in which colours and under which titles.
#pragma once

#include <string>
#include <vector>

#include "curve.h"
#include "musclesim/base/color.h"
#include "musclesim/log/recording.h"

namespace musclesim {

/// How one signal is drawn.
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

/// The upper panel: height, target and activity; for a robot without a hand the first that is measured of angles, lengths and forces.
Panel upperPanel(const Recording& recording, const std::vector<Color>& muscle_colors);

/// The lower panel: the pressures, or the commands if no pressure is measured.
Panel lowerPanel(const Recording& recording, const std::vector<Color>& muscle_colors);

/// Chosen signals, one panel per quantity and unit; see signalsFigureSvg.
std::vector<Panel> signalPanels(const Recording& recording, const std::vector<std::string>& signals,
                                const std::vector<Color>& muscle_colors);

/// The signals of a recording that have one of these names; a name may end in *. Throws BadParameter for a name that none has.
std::vector<const Signal*> signalsNamed(const Recording& recording, const std::vector<std::string>& names);

}  // namespace musclesim
