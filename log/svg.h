/// A small writer of SVG drawings.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "musclesim/base/color.h"

namespace musclesim {

/// A place in a drawing, in pixels from the upper left corner.
struct SvgPoint {
  double x = 0, y = 0;
};

/// A rectangle of a drawing, in pixels.
struct SvgBox {
  double left = 0, top = 0, width = 0, height = 0;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

/// How a point is drawn: not at all (only lines), as a disc, as a ring, as a cross.
enum class SvgMark { none, disc, ring, cross };

enum class SvgAnchor { start, middle, end };

struct SvgTextStyle {
  double size = 12;
  SvgAnchor anchor = SvgAnchor::start;
  std::string color = "#333333";
  bool bold = false;
  bool turned = false;  ///< by 90 degrees, to read upwards
};

/// Escapes text for use between tags and in attributes; replaces control characters and invalid UTF-8 by "?".
std::string escapedXml(std::string_view text);

/// "#rrggbb"; components outside 0..1 are clamped.
std::string hexColor(const Color& color);

/// The same hue, each component multiplied by `ratio`.
Color darkened(const Color& color, double ratio);

/// How bright a colour looks on a screen, 0 (black) .. 1 (white). Source: ITU-R BT.709, luma coefficients.
double brightness(const Color& color);

/// A drawing. Later elements cover earlier ones.
class Svg {
 public:
  Svg(double width, double height, const std::string& title);

  void line(SvgPoint from, SvgPoint to, const std::string& color, double width);
  void frame(const SvgBox& box, const std::string& color);
  void fill(const SvgBox& box, const std::string& color);
  void text(SvgPoint where, const std::string& words, const SvgTextStyle& style);
  /// Lines through the points of each piece, clipped to `clip`. A piece of one point is drawn as a dot. Light colours get a darker outline
  /// to be visible on white. `hint` is the tooltip.
  void curve(const std::vector<std::vector<SvgPoint>>& pieces, const Color& color, double width, const SvgBox& clip,
             const std::string& hint);
  /// A short line that stands for a curve in a legend.
  void sample(SvgPoint from, double length, const Color& color, double width);

  /// A point. `hint` is the tooltip.
  void mark(SvgPoint where, SvgMark mark, const Color& color, const std::string& hint);

  /// The finished document.
  std::string document() const { return out_ + "</svg>\n"; }

 private:
  void path(const std::string& data, const std::string& color, double width, const std::string& attributes, const std::string& hint);
  void casedPath(const std::string& data, const Color& color, double width, const std::string& attributes, const std::string& hint);

  std::string out_;
  int clip_count_ = 0;
};

}  // namespace musclesim
