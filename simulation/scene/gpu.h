/// OpenGL objects: shader programs, meshes and render targets. Create, use and destroy each while its context is current.
#pragma once

#include <Eigen/Core>
#include <string>

#include "gl.h"
#include "image.h"
#include "mesh.h"

namespace musclesim {

/// A vertex and a fragment shader. The attributes "position" and "normal" are 0 and 1.
class GpuProgram {
 public:
  /// Throws SceneError with the compiler's message.
  GpuProgram(const Gl& gl, const char* vertex_source, const char* fragment_source);
  ~GpuProgram();
  GpuProgram(const GpuProgram&) = delete;
  GpuProgram& operator=(const GpuProgram&) = delete;

  void use() const { gl_.UseProgram(id_); }
  /// Sets a uniform of the program in use.
  void set(const char* name, float value) const { gl_.Uniform1f(place(name), value); }
  void set(const char* name, const Eigen::Vector3f& v) const { gl_.Uniform3f(place(name), v.x(), v.y(), v.z()); }
  void set(const char* name, const Eigen::Vector4f& v) const { gl_.Uniform4f(place(name), v.x(), v.y(), v.z(), v.w()); }
  void set(const char* name, const Eigen::Matrix3f& m) const { gl_.UniformMatrix3fv(place(name), 1, GL_FALSE, m.data()); }
  void set(const char* name, const Eigen::Matrix4f& m) const { gl_.UniformMatrix4fv(place(name), 1, GL_FALSE, m.data()); }

 private:
  GLint place(const char* name) const { return gl_.GetUniformLocation(id_, name); }
  const Gl& gl_;
  GLuint id_;
};

/// A mesh in the memory of OpenGL.
class GpuMesh {
 public:
  explicit GpuMesh(const Gl& gl);
  GpuMesh(const Gl& gl, const Mesh& mesh) : GpuMesh(gl) { load(mesh, GL_STATIC_DRAW); }
  ~GpuMesh();
  GpuMesh(const GpuMesh&) = delete;
  GpuMesh& operator=(const GpuMesh&) = delete;

  void load(const Mesh& mesh, GLenum usage);
  void draw() const;

 private:
  const Gl& gl_;
  GLuint buffers_[2] = {0, 0};
  GLsizei index_count_ = 0;
};

/// A render target with up to `samples` samples per pixel, if OpenGL supports them.
class GpuTarget {
 public:
  static constexpr int smooth = 4, plain = 0;
  GpuTarget(const Gl& gl, int width, int height, int samples);
  ~GpuTarget();
  GpuTarget(const GpuTarget&) = delete;
  GpuTarget& operator=(const GpuTarget&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  bool isSmooth() const { return samples_ > plain; }
  /// Makes this the target of all further drawing.
  void bind() const;
  /// Averages the samples and copies the picture to the context's own buffer, which becomes the current target.
  void show() const;
  /// Reads the picture that was shown last.
  Image read() const;

 private:
  const Gl& gl_;
  int width_, height_, samples_;
  GLuint framebuffer_ = 0, color_ = 0, depth_ = 0;
};

}  // namespace musclesim
