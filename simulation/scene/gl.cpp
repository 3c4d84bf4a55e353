#include "gl.h"

#include <string>

#include "scene_error.h"

namespace musclesim {

namespace {

void* require(const Gl::Find& find, const char* name) {
  void* function = find(name);
  if (!function) throw SceneError(std::string("this OpenGL has no function ") + name + "; OpenGL 3.0 is needed");
  return function;
}

}  // namespace

Gl Gl::load(const Find& find) {
  Gl gl;
#define MUSCLESIM_GL_LOAD(name) gl.name = reinterpret_cast<decltype(gl.name)>(require(find, "gl" #name));
  MUSCLESIM_GL_FUNCTIONS(MUSCLESIM_GL_LOAD)
#undef MUSCLESIM_GL_LOAD
  return gl;
}

}  // namespace musclesim
