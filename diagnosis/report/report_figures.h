/// The figures of report.html. All are readable in black and white: important parts are darker, thicker, dashed or labelled.
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
  std::string look = "plain";  ///< "plain", "strong" or "removed" (hatched)
  double start = 0;            ///< where the bar begins
};
std::string barsFigure(const std::string& title, const std::vector<Bar>& bars, double full);

/// The five stages that a sample passes, each as dark as its share of the gap, with those where a cause was found.
std::string stagesFigure(const Diagnosis& d);

/// The robot from the front with the components of some places marked.
std::string robotFigure(const RobotDrawing& drawing, const std::vector<Place>& places);

struct TraceWords {
  std::string title, unit, remark;
};
/// Measured and simulated values over time, before and, if there is an explanation, after; below them the residuals with the band of
/// twice the noise floor. The page's script zooms all traces together. Of the samples within `pixels_per_column` pixels only the lowest
/// and the highest are drawn.
std::string traceFigure(const Trace& trace, const TraceWords& words, double noise_sigma, int pixels_per_column);

struct LoopCurve {
  std::vector<double> x, y;
};
/// One signal over another: measured, simulated before and, if there is one, after.
struct Loop {
  std::string title, across, up;
  std::vector<LoopCurve> curves;
};
std::string loopFigure(const Loop& loop);

/// What a reader may believe.
enum class Belief { explained, partly, cannot_tell, no_gap };
/// A traffic sign whose shape differs as much as its colour.
std::string signFigure(Belief belief);

}  // namespace musclesim
