#include "gpu.h"

#include <algorithm>
#include <cstddef>

#include "scene_error.h"

namespace musclesim {

namespace {

GLuint compile(const Gl& gl, GLenum kind, const char* source) {
  const GLuint shader = gl.CreateShader(kind);
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint fine = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &fine);
  if (fine) return shader;
  char log[1024] = "";
  gl.GetShaderInfoLog(shader, sizeof log, nullptr, log);
  throw SceneError(std::string("this OpenGL cannot compile a shader: ") + log);
}

}  // namespace

GpuProgram::GpuProgram(const Gl& gl, const char* vertex_source, const char* fragment_source) : gl_(gl), id_(gl.CreateProgram()) {
  for (const auto& [kind, source] : {std::pair{GL_VERTEX_SHADER, vertex_source}, std::pair{GL_FRAGMENT_SHADER, fragment_source}}) {
    const GLuint shader = compile(gl, static_cast<GLenum>(kind), source);
    gl.AttachShader(id_, shader);
    gl.DeleteShader(shader);  // OpenGL keeps it as long as the program exists
  }
  gl.BindAttribLocation(id_, 0, "position");
  gl.BindAttribLocation(id_, 1, "normal");
  gl.LinkProgram(id_);
  GLint fine = 0;
  gl.GetProgramiv(id_, GL_LINK_STATUS, &fine);
  if (!fine) throw SceneError("this OpenGL cannot link a shader program");
}

GpuProgram::~GpuProgram() {
  gl_.DeleteProgram(id_);
}

GpuMesh::GpuMesh(const Gl& gl) : gl_(gl) {
  gl_.GenBuffers(2, buffers_);
}

GpuMesh::~GpuMesh() {
  gl_.DeleteBuffers(2, buffers_);
}

void GpuMesh::load(const Mesh& mesh, GLenum usage) {
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vertex)), mesh.vertices.data(), usage);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)), mesh.indices.data(), usage);
  index_count_ = static_cast<GLsizei>(mesh.indices.size());
}

void GpuMesh::draw() const {
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  gl_.EnableVertexAttribArray(0);
  gl_.EnableVertexAttribArray(1);
  gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  gl_.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<const void*>(offsetof(Vertex, normal)));
  gl_.DrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  gl_.DisableVertexAttribArray(0);
  gl_.DisableVertexAttribArray(1);
  gl_.BindBuffer(GL_ARRAY_BUFFER, 0);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

GpuTarget::GpuTarget(const Gl& gl, int width, int height, int samples) : gl_(gl), width_(width), height_(height), samples_(samples) {
  GLint most = 0;
  gl_.GetIntegerv(GL_MAX_SAMPLES, &most);
  gl_.GenFramebuffers(1, &framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const auto attach = [&](GLuint& buffer, GLenum format, GLenum where) {
    gl_.GenRenderbuffers(1, &buffer);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, std::min(samples, most), format, width_, height_);
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, buffer);
  };
  attach(color_, GL_RGBA8, GL_COLOR_ATTACHMENT0);
  attach(depth_, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
  const bool complete = gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  if (!complete) throw SceneError("this OpenGL cannot draw pictures of " + std::to_string(width) + " x " + std::to_string(height));
}

GpuTarget::~GpuTarget() {
  gl_.DeleteFramebuffers(1, &framebuffer_);
  gl_.DeleteRenderbuffers(1, &color_);
  gl_.DeleteRenderbuffers(1, &depth_);
}

void GpuTarget::bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_, height_);
}

void GpuTarget::show() const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
}

Image GpuTarget::read() const {
  Image image{width_, height_, std::vector<std::uint8_t>(static_cast<std::size_t>(width_) * height_ * 3)};
  std::vector<std::uint8_t> upside_down(image.rgb.size());
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
  const auto row_size = static_cast<std::ptrdiff_t>(width_) * 3;
  for (int row = 0; row < height_; ++row)
    std::copy_n(upside_down.begin() + (height_ - 1 - row) * row_size, row_size, image.rgb.begin() + row * row_size);
  return image;
}

}  // namespace musclesim
