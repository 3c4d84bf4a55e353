/// Reports of the load-frame experiment: errors, a table of points, figures.
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

/// Select points: those with at least one free link; with all links at stops; of one direction (loading or unloading).
std::vector<FramePoint> freePoints(const std::vector<FramePoint>& points);
std::vector<FramePoint> stoppedPoints(const std::vector<FramePoint>& points);
std::vector<FramePoint> pointsOf(const std::vector<FramePoint>& points, FrameWay way);

/// Two lines per specimen, as Markdown: the error function of both experiments; points with all links at stops are counted separately.
std::string frameTable(const std::vector<FrameReport>& reports);

/// All points as CSV, in the columns that `musclesim fit` reads.
std::string frameCsv(const FrameReport& report);

/// Figures 4 to 6 of the paper, as SVG: force over length with the law's curves, for imposed loads and for imposed lengths; length and
/// number of links at their long stops over the load, which shows the kink.
std::string frameFigureSvg(const FrameReport& report, const ForceLaw& law);

/// Differences of simulated and measured forces at the same pressure and length.
struct DataComparison {
  double relative_squared_error = 0;
  int compared_count = 0, outside_count = 0;  ///< points outside the simulated pressures or lengths, and censored points, are not compared
};

/// Compares simulated forces with measured points. A simulated force is F(p, l) plus the deviation from it that the experiment with imposed
/// lengths shows (mean of loading and unloading, interpolated linearly over pressure and length, constant up to 3 % beyond the range).
DataComparison compareWithData(const std::vector<FramePoint>& lengths, const ForceLaw& law, const StaticPoints& measured);
/// The law that the muscle of the load frame follows.
std::unique_ptr<ForceLaw> frameLaw(const FrameSpecimen& specimen, const Parameters& parameters);

}  // namespace musclesim
