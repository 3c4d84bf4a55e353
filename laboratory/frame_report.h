/// What the load-frame experiment tells: errors, a table of points, figures.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "load_frame.h"
#include "static_points.h"

namespace musclesim {

/// Both experiments with one muscle.
struct FrameReport {
  FrameSpecimen specimen;
  std::vector<FramePoint> loads, lengths;
};

/// Points with at least one free link; with all links at stops; of one way.
std::vector<FramePoint> freePoints(const std::vector<FramePoint>& points);
std::vector<FramePoint> stoppedPoints(const std::vector<FramePoint>& points);
std::vector<FramePoint> pointsOf(const std::vector<FramePoint>& points, FrameWay way);

/// Two lines per specimen, as Markdown: error function of both experiments, apart where all links are at stops.
std::string frameTable(const std::vector<FrameReport>& reports);

/// All points as CSV, in the columns that `musclesim fit` reads.
std::string frameCsv(const FrameReport& report);

/// Figures 4 to 6 of the paper and the kink: force over length with the law's curves for loads hung and for lengths imposed; length and
/// number of links at their long stops over the load. SVG.
std::string frameFigureSvg(const FrameReport& report, const ForceLaw& law);

/// How far simulated forces are from measured ones at the same pressure and length.
struct DataComparison {
  double relative_squared_error = 0;
  int compared_count = 0, outside_count = 0;  ///< outside: beyond the simulated pressures or lengths, or censored
};

/// Simulated forces against measured points. A simulated force is F(p, l) plus what the experiment with imposed lengths reads above it
/// (mean of both ways, straight lines between the nearest pressures and lengths, constant for 3 % of the range beyond the outermost).
DataComparison compareWithData(const std::vector<FramePoint>& lengths, const ForceLaw& law, const StaticPoints& measured);
/// The law that the muscle of the load frame follows.
std::unique_ptr<ForceLaw> frameLaw(const FrameSpecimen& specimen, const Parameters& parameters);

}  // namespace musclesim
