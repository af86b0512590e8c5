#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <weft/playback/rendering/meshes/surface_mesh.hpp>
#include <weft/playback/rendering/opengl/gl_functions.hpp>

namespace weft::scenes {

/// A surface in the buffers of a context, which must be the current one when it is deleted.
class GpuMesh {
 public:
  explicit GpuMesh(const GlFunctions& gl);
  ~GpuMesh();
  GpuMesh(GpuMesh&& other) noexcept;
  GpuMesh& operator=(GpuMesh&&) = delete;
  GpuMesh(const GpuMesh&) = delete;
  GpuMesh& operator=(const GpuMesh&) = delete;

  void upload(const SurfaceMesh& mesh);
  void draw() const;

 private:
  const GlFunctions* gl_;
  GLuint array_ = 0;
  GLuint vertices_ = 0;
  GLuint indices_ = 0;
  GLsizei num_indices_ = 0;
};

}  // namespace weft::scenes
