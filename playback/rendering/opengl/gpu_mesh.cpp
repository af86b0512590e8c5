#include <weft/playback/rendering/opengl/gpu_mesh.hpp>

#include <cstddef>
#include <iterator>
#include <utility>

namespace weft::scenes {

GpuMesh::GpuMesh(const GlFunctions& gl) : gl_(&gl) {
  gl.GenVertexArrays(1, &array_);
  gl.GenBuffers(1, &vertices_);
  gl.GenBuffers(1, &indices_);
  gl.BindVertexArray(array_);
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  static_assert(sizeof(SurfaceVertex) == 11 * sizeof(float), "the attributes below need no gaps");
  const struct {
    GLint size;
    std::size_t offset;
  } attributes[] = {{3, offsetof(SurfaceVertex, position)},
                    {3, offsetof(SurfaceVertex, normal)},
                    {2, offsetof(SurfaceVertex, value)},
                    {3, offsetof(SurfaceVertex, extra)}};
  for (GLuint i = 0; i < std::size(attributes); ++i) {
    gl.EnableVertexAttribArray(i);
    gl.VertexAttribPointer(
        i, attributes[i].size, GL_FLOAT, GL_FALSE, sizeof(SurfaceVertex),
        // OpenGL takes offsets as pointers.
        reinterpret_cast<const void*>(attributes[i].offset));  // NOLINT(performance-no-int-to-ptr)
  }
}

GpuMesh::GpuMesh(GpuMesh&& other) noexcept
    : gl_(other.gl_),
      array_(std::exchange(other.array_, 0)),
      vertices_(std::exchange(other.vertices_, 0)),
      indices_(std::exchange(other.indices_, 0)),
      num_indices_(std::exchange(other.num_indices_, 0)) {}

GpuMesh::~GpuMesh() {
  gl_->DeleteBuffers(1, &indices_);
  gl_->DeleteBuffers(1, &vertices_);
  gl_->DeleteVertexArrays(1, &array_);
}

void GpuMesh::upload(const SurfaceMesh& mesh) {
  num_indices_ = static_cast<GLsizei>(mesh.indices.size());
  if (num_indices_ == 0) return;
  gl_->BindVertexArray(array_);
  gl_->BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_->BufferData(GL_ARRAY_BUFFER,
                  static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(SurfaceVertex)),
                  mesh.vertices.data(), GL_DYNAMIC_DRAW);
  gl_->BufferData(GL_ELEMENT_ARRAY_BUFFER,
                  static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)),
                  mesh.indices.data(), GL_DYNAMIC_DRAW);
}

void GpuMesh::draw() const {
  if (num_indices_ == 0) return;
  gl_->BindVertexArray(array_);
  gl_->DrawElements(GL_TRIANGLES, num_indices_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace weft::scenes
