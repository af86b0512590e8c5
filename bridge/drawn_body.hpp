#pragma once

// Tested by tests/bridge/drawn_body_test.cpp.

#include <cstddef>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/mesh/cloth_mesh.hpp>
#include <weft/mesh/embedding/cloth_embedding.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Where a renderer wants its vertices: arrays of its own, or one array of structures.
struct VertexBuffers {
  float* positions =
      nullptr;  ///< of the first vertex, 3 numbers in a row [m]; null: not wanted, as below
  float* normals = nullptr;   ///< 3 numbers, unit [-]
  float* tangents = nullptr;  ///< 3 numbers, unit [-]
  std::size_t stride =
      3 *
      sizeof(
          float);  ///< [byte] from a vertex to the next, of all three; a multiple of sizeof(float)
};

/// Clothes on a character: a fine drawn mesh that a coarse btSoftBody leads (ClothEmbedding).
///
///   weft::bridge::DrawnBody shirt(mesh, drawn, {.max_distance = 0.03});  // once
///   shirt.update(*body);                                                 // after each stepSimulation()
///   shirt.write({.positions = vertices, .normals = normals});
///
/// The body needs no laws and no solver of Weft. It may tear: update() notices, drawn triangles part with it, and there are
/// more vertices than before. Apart from that nothing is allocated.
class DrawnBody {
 public:
  /// For a body of make_cloth_body(): the drawn mesh lies around the rest positions. Throws InvalidArgument as ClothEmbedding.
  DrawnBody(const ClothMesh& mesh, const DrawnMesh& drawn, const EmbeddingOptions& options = {});
  /// For any body with faces: the drawn mesh lies around its nodes where they are now.
  DrawnBody(const btSoftBody& body, const DrawnMesh& drawn, const EmbeddingOptions& options = {});

  /// Number of vertices and the triangles of them, which change where update() says so.
  [[nodiscard]] const ClothEmbedding& embedding() const { return embedding_; }

  /// Takes the nodes as they are now; true if the body has torn since and vertices and triangles are other ones. Throws
  /// InvalidArgument for a body that is not the one that was bound.
  bool update(const btSoftBody& body);

  [[nodiscard]] DrawnVertex vertex(int v) const { return embedding_.vertex(pose_, v); }
  /// Writes the vertices of the last update(). Throws InvalidArgument for a stride that is too short or no multiple of sizeof(float).
  void write(const VertexBuffers& buffers) const;
  /// The same for vertices from first to last - 1 only: parts may be written by different threads at once.
  void write(const VertexBuffers& buffers, int first, int last) const;

 private:
  void follow_tear(const btSoftBody& body);

  Triangles corners_;  ///< corner of the face that each corner of the cloth's triangles is
  ClothEmbedding embedding_;
  ClothPose pose_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
