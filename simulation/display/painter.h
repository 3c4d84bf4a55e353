/// Draws text and rectangles over a picture, in pixels from the upper left corner.
#pragma once

#include <string>

#include "musclesim/base/color.h"

namespace musclesim {

class Painter {
 public:
  virtual ~Painter() = default;
  virtual void rectangle(float x, float y, float width, float height, const Color& color, float alpha) = 0;
  /// `y` is the upper edge of the line.
  virtual void text(float x, float y, const std::string& text, const Color& color) = 0;
  virtual float widthOf(const std::string& text) const = 0;
  virtual float lineHeight() const = 0;
};

/// Draws with the bitmap fonts of GLUT, for a window without a panel. The window's context must be current.
class BitmapPainter final : public Painter {
 public:
  /// The size of the window.
  BitmapPainter(int width_px, int height_px);
  ~BitmapPainter() override;
  BitmapPainter(const BitmapPainter&) = delete;
  BitmapPainter& operator=(const BitmapPainter&) = delete;
  void rectangle(float x, float y, float width, float height, const Color& color, float alpha) override;
  void text(float x, float y, const std::string& text, const Color& color) override;
  float widthOf(const std::string& text) const override;
  float lineHeight() const override;
};

}  // namespace musclesim
