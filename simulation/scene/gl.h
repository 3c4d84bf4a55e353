/// The OpenGL functions that the scene uses, looked up at run time.
///
/// A window takes them from the system's OpenGL, an offscreen picture from OSMesa. Both libraries export the same names; since the scene
/// calls them through this table only, one process can use both.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <functional>

namespace musclesim {

// clang-format off
#define MUSCLESIM_GL_FUNCTIONS(X) \
  X(AttachShader) X(BindAttribLocation) X(BindBuffer) X(BindFramebuffer) X(BindRenderbuffer) X(BlendFunc) X(BlitFramebuffer) \
  X(BufferData) X(CheckFramebufferStatus) X(Clear) X(ClearColor) X(CompileShader) X(CreateProgram) X(CreateShader) X(CullFace) \
  X(DeleteBuffers) X(DeleteFramebuffers) X(DeleteProgram) X(DeleteRenderbuffers) X(DeleteShader) X(DepthMask) X(Disable) \
  X(DisableVertexAttribArray) X(DrawElements) X(Enable) X(EnableVertexAttribArray) X(Finish) X(FramebufferRenderbuffer) \
  X(GenBuffers) X(GenFramebuffers) X(GenRenderbuffers) X(GetIntegerv) X(GetProgramInfoLog) X(GetProgramiv) X(GetShaderInfoLog) \
  X(GetShaderiv) X(GetString) X(GetUniformLocation) X(LinkProgram) X(PixelStorei) X(ReadPixels) \
  X(RenderbufferStorageMultisample) X(ShaderSource) X(Uniform1f) X(Uniform3f) X(Uniform4f) X(UniformMatrix3fv) \
  X(UniformMatrix4fv) X(UseProgram) X(VertexAttribPointer) X(Viewport)
// clang-format on

/// gl.Clear(...) calls glClear(...) of the context that the table was made for.
struct Gl {
#define MUSCLESIM_GL_MEMBER(name) decltype(&::gl##name) name = nullptr;  // NOLINT(bugprone-macro-parentheses)
  MUSCLESIM_GL_FUNCTIONS(MUSCLESIM_GL_MEMBER)
#undef MUSCLESIM_GL_MEMBER

  using Find = std::function<void*(const char* name)>;
  /// Throws SceneError naming the first function that is missing: the scene needs OpenGL 3.0.
  static Gl load(const Find& find);
};

}  // namespace musclesim
