#include <weft/bridge/drawn_body.hpp>

#include <string>

#include <weft/bridge/adoption/body_mesh.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Bullet's faces as they are: the same triangles, but not always wound as their neighbors.
Triangles faces_of_body(const btSoftBody& body) {
  Triangles faces(3, body.m_faces.size());
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      faces(corner, f) = static_cast<int>(body.m_faces[f].m_n[corner] - &body.m_nodes[0]);
    }
  }
  return faces;
}

/// Which corner of a face is each corner of the triangle of the same nodes.
Triangles corners_of_faces(const Triangles& triangles, const Triangles& faces) {
  Triangles corners(3, triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (faces(j, t) == triangles(i, t)) corners(i, t) = j;
      }
    }
  }
  return corners;
}

void put(float* first, std::size_t stride, int v, const Vector3<double>& value) {
  if (first == nullptr) return;
  float* place = first + static_cast<std::size_t>(v) * (stride / sizeof(float));
  for (int i = 0; i < 3; ++i) place[i] = static_cast<float>(value[i]);
}

}  // namespace

DrawnBody::DrawnBody(const ClothMesh& mesh, const DrawnMesh& drawn, const EmbeddingOptions& options)
    : corners_(corners_of_faces(mesh.triangles, mesh.triangles)),
      embedding_(mesh.rest_positions, mesh.triangles, drawn, options),
      pose_(embedding_.make_pose()) {}

DrawnBody::DrawnBody(const btSoftBody& body, const DrawnMesh& drawn,
                     const EmbeddingOptions& options)
    : DrawnBody(mesh_of(body).mesh, drawn, options) {
  const Triangles faces = faces_of_body(body);
  corners_ = corners_of_faces(mesh_of(body).mesh.triangles, faces);
}

bool DrawnBody::update(const btSoftBody& body) {
  const bool has_torn = body.m_nodes.size() != embedding_.num_nodes();
  if (has_torn) follow_tear(body);
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btVector3& x = body.m_nodes[i].m_x;
    pose_.positions.col(i) << static_cast<double>(x.x()), static_cast<double>(x.y()),
        static_cast<double>(x.z());
  }
  embedding_.update_pose(pose_);
  return has_torn;
}

void DrawnBody::follow_tear(const btSoftBody& body) {
  if (body.m_nodes.size() < embedding_.num_nodes() || body.m_faces.size() != corners_.cols()) {
    throw InvalidArgument("drawn body: a body of " + std::to_string(body.m_nodes.size()) +
                          " nodes and " + std::to_string(body.m_faces.size()) +
                          " faces, expected that of " + std::to_string(embedding_.num_nodes()) +
                          " nodes and " + std::to_string(corners_.cols()) +
                          " faces, or what it has become by tearing");
  }
  const Triangles faces = faces_of_body(body);
  Triangles triangles(3, faces.cols());
  for (Eigen::Index t = 0; t < faces.cols(); ++t) {
    for (int i = 0; i < 3; ++i) triangles(i, t) = faces(corners_(i, t), t);
  }
  embedding_.follow_tear(triangles, body.m_nodes.size());
  pose_ = embedding_.make_pose();
}

void DrawnBody::write(const VertexBuffers& buffers) const {
  write(buffers, 0, embedding_.num_vertices());
}

void DrawnBody::write(const VertexBuffers& buffers, int first, int last) const {
  if (buffers.stride < 3 * sizeof(float) || buffers.stride % sizeof(float) != 0) {
    throw InvalidArgument("drawn body: stride = " + std::to_string(buffers.stride) +
                          " [byte], expected a multiple of 4 and at least 12");
  }
  for (int v = first; v < last; ++v) {
    const DrawnVertex drawn = embedding_.vertex(pose_, v);
    put(buffers.positions, buffers.stride, v, drawn.position);
    put(buffers.normals, buffers.stride, v, drawn.normal);
    put(buffers.tangents, buffers.stride, v, drawn.tangent);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
