/// The figures of report.html. All of them read in black and white as well: what matters is darker, thicker or labelled.
#pragma once

#include <string>
#include <vector>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// Bars with a label on the left, or above where the page is narrow, and a number on the right; `full` is the value of a bar over the whole
/// width.
struct Bar {
  std::string label;
  double value;
  std::string number;
  bool strong = true;
};
std::string barsFigure(const std::string& title, const std::vector<Bar>& bars, double full);

/// The way of a sample through the five stages, each as dark as its share of the gap.
std::string stagesFigure(const std::vector<Place>& where);

/// The robot from the front with the component of the first place marked.
std::string robotFigure(const RobotDrawing& drawing, const Place& place);

/// Measured, before and, if there is one, after over time. The page's script zooms all of them together.
std::string traceFigure(const Trace& trace, bool has_after);

/// JavaScript that zooms every trace of the page: drag to select a stretch of time, double click to see all.
std::string zoomScript();

}  // namespace musclesim
