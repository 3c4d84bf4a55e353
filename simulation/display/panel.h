/// The panel beside the scene: sliders, switches and live plots. A build without Dear ImGui has no panel.
#pragma once

#include <memory>

#include "console.h"
#include "history.h"
#include "overlay.h"

namespace musclesim {

/// Draws in the window's context. The window passes its events on.
class Panel {
 public:
  /// Null in a build without Dear ImGui.
  static std::unique_ptr<Panel> make();
  virtual ~Panel() = default;

  virtual int widthPx() const = 0;
  virtual void resize(int width, int height) = 0;
  /// Events. The first three return true if the panel uses the event, so that the scene must ignore it.
  virtual bool key(unsigned char character) = 0;
  virtual bool button(int glut_button, int glut_state, int x, int y) = 0;
  virtual bool move(int x, int y) = 0;
  virtual void keyUp(unsigned char character) = 0;
  /// Draws the overlay into the scene's part and, if wanted, the panel.
  virtual void draw(Console& console, const Snapshot& snapshot, const History& history, int width, int height) = 0;
};

}  // namespace musclesim
