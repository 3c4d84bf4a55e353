/// Sliders, switches and live plots beside the scene. In a build without Dear ImGui there is none.
#pragma once

#include <memory>

#include "console.h"
#include "history.h"
#include "overlay.h"

namespace musclesim {

/// Lives in the window's context; events come from the window.
class Panel {
 public:
  /// Null in a build without Dear ImGui.
  static std::unique_ptr<Panel> make();
  virtual ~Panel() = default;

  virtual int widthPx() const = 0;
  virtual void resize(int width, int height) = 0;
  /// Events; the first three say whether the panel takes them from the scene.
  virtual bool key(unsigned char character) = 0;
  virtual bool button(int glut_button, int glut_state, int x, int y) = 0;
  virtual bool move(int x, int y) = 0;
  virtual void keyUp(unsigned char character) = 0;
  /// Draws the overlay into the scene's part and, if wanted, the panel.
  virtual void draw(Console& console, const Snapshot& snapshot, const History& history, int width, int height) = 0;
};

}  // namespace musclesim
