/// Diagrams of numbers over numbers: curves and measured points, several in one figure.
#pragma once

#include <string>
#include <vector>

#include "musclesim/base/color.h"
#include "svg.h"

namespace musclesim {

/// One curve (mark none) or set of points of a diagram.
struct DiagramSeries {
  std::string label;  ///< for the legend and where the mouse rests; empty: not in the legend
  Color color;
  std::vector<double> x, y;  ///< NaN in y: a gap
  SvgMark mark = SvgMark::none;
  double width = 1.6;
};

struct Diagram {
  std::string title, x_title, y_title;
  std::vector<DiagramSeries> series;
};

/// Colours for an ordered quantity from 0 to 1: blue, green, orange, red, of like brightness.
Color orderedColor(double ratio);

/// The diagrams in rows of `column_count`, each with its axes, one legend for all on top. A self-contained SVG.
std::string diagramsSvg(const std::string& title, const std::vector<Diagram>& diagrams, int column_count);

}  // namespace musclesim
