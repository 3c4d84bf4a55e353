/// Pictures without a display, by OSMesa.
#pragma once

#include <memory>

#include "scene.h"

namespace musclesim {

/// A context of OpenGL in memory with a scene in it, for the thread that made it. OSMesa is looked for at run time.
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
