/// Draws pictures without a display, with OSMesa.
#pragma once

#include <memory>

#include "scene.h"

namespace musclesim {

/// An OpenGL context in memory with a scene, for use in the thread that made it. OSMesa is loaded at run time.
class Offscreen {
 public:
  /// Throws SceneError where there is no OSMesa, BadParameter for a size outside 16 .. 8192.
  Offscreen(int width, int height);
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  Image draw(const Snapshot& snapshot, const Camera& camera, const SceneStyle& style = {});

 private:
  class Context;
  std::unique_ptr<Context> context_;
  Gl gl_;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<GpuTarget> target_;
};

}  // namespace musclesim
