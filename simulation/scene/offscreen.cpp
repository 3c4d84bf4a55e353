#include "offscreen.h"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <cstdint>
#include <string>
#include <vector>

#include "scene_error.h"

namespace musclesim {

namespace {

constexpr int smallest = 16, largest = 8192;

void requireSize(const char* name, int size) {
  if (size < smallest || size > largest)
    throw BadParameter(std::string("picture's ") + name, std::to_string(size), "lie in 16 .. 8192 pixels");
}

/// Loads OSMesa in a separate namespace, because it exports the same names as the system's OpenGL. It stays loaded.
void* library() {
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
    if (void* found = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return found;
  throw SceneError("pictures without a display need OSMesa, which is not installed; Debian: apt-get install libosmesa6");
}

template <class Function>
Function* functionOf(void* library, const char* name) {
  void* function = dlsym(library, name);
  if (!function) throw SceneError(std::string("this OSMesa has no ") + name);
  return reinterpret_cast<Function*>(function);
}

}  // namespace

class Offscreen::Context {
 public:
  Context(int width, int height) : library_(library()), pixels_(static_cast<std::size_t>(width) * height * 4) {
    const auto create = functionOf<decltype(OSMesaCreateContextExt)>(library_, "OSMesaCreateContextExt");
    const auto make_current = functionOf<decltype(OSMesaMakeCurrent)>(library_, "OSMesaMakeCurrent");
    constexpr GLint depth_bits = 24;
    context_ = create(OSMESA_RGBA, depth_bits, 0, 0, nullptr);
    if (!context_ || !make_current(context_, pixels_.data(), GL_UNSIGNED_BYTE, width, height))
      throw SceneError("OSMesa cannot draw pictures of " + std::to_string(width) + " x " + std::to_string(height));
  }
  ~Context() { functionOf<decltype(OSMesaDestroyContext)>(library_, "OSMesaDestroyContext")(context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  Gl functions() const {
    const auto find = functionOf<decltype(OSMesaGetProcAddress)>(library_, "OSMesaGetProcAddress");
    return Gl::load([find](const char* name) { return reinterpret_cast<void*>(find(name)); });
  }

 private:
  void* library_;
  std::vector<std::uint8_t> pixels_;
  OSMesaContext context_ = nullptr;
};

Offscreen::Offscreen(int width, int height) {
  requireSize("width", width);
  requireSize("height", height);
  context_ = std::make_unique<Context>(width, height);
  gl_ = context_->functions();
  scene_ = std::make_unique<Scene>(gl_);
  target_ = std::make_unique<GpuTarget>(gl_, width, height, GpuTarget::smooth);
}

Offscreen::~Offscreen() = default;

Image Offscreen::draw(const Snapshot& snapshot, const Camera& camera, const SceneStyle& style) {
  scene_->draw(snapshot, camera, style, *target_);
  return target_->read();
}

}  // namespace musclesim
