/// The figures of report.html. All are readable in black and white: important parts are darker, thicker or labelled.
#pragma once

#include <string>
#include <vector>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// Bars with a label on the left (above on narrow pages) and a number on the right; `full` is the value of a bar of full width.
struct Bar {
  std::string label;
  double value;
  std::string number;
  bool strong = true;
};
std::string barsFigure(const std::string& title, const std::vector<Bar>& bars, double full);

/// The five stages that a sample passes, each as dark as its share of the gap.
std::string stagesFigure(const std::vector<Place>& where);

/// The robot from the front with the component of the first place marked.
std::string robotFigure(const RobotDrawing& drawing, const Place& place);

/// Measured values, simulation before and, if there is one, after, over time. The page's script zooms all traces together.
std::string traceFigure(const Trace& trace, bool has_after);

/// JavaScript that zooms all traces of the page: drag to select a time range, double click to see everything.
std::string zoomScript();

}  // namespace musclesim
