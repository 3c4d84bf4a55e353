/// Diagrams of y over x with curves and points; several in one figure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/color.h"
#include "svg.h"

namespace musclesim {

/// A curve (mark none) or a set of points in a diagram.
struct DiagramSeries {
  std::string label;  ///< for the legend and the tooltip; empty: not in the legend
  Color color;
  std::vector<double> x, y;  ///< NaN in y: a gap
  SvgMark mark = SvgMark::none;
  double width = 1.6;
};

/// A pale band about 0, behind the curves.
struct DiagramBand {
  double half_width;  ///< in the unit of y
  std::string label;  ///< for the legend
};

struct Diagram {
  std::string title, x_title, y_title;
  std::vector<DiagramSeries> series;
  std::optional<DiagramBand> band = std::nullopt;
};

/// Colour scale for a quantity from 0 to 1: blue, green, orange, red, of similar brightness.
Color orderedColor(double ratio);

/// Draws the diagrams in rows of `column_count`, each with its axes and `cell_height` pixels high, under one common legend. Returns a
/// self-contained SVG.
std::string diagramsSvg(const std::string& title, const std::vector<Diagram>& diagrams, int column_count, double cell_height = 400);

}  // namespace musclesim
