#include <weft/playback/rendering/meshes/surface_mesh.hpp>

#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

namespace weft::scenes {
SurfaceVertex body_vertex(const Vector3<double>& position, const Vector3<double>& normal,
                          const Eigen::Vector2d& texture_coordinates) {
  SurfaceVertex vertex;
  vertex.position = position.cast<float>();
  vertex.normal = normal.cast<float>();
  vertex.value = texture_coordinates.cast<float>();
  vertex.extra = vertex.position;
  return vertex;
}

SurfaceMesh cloth_surface(const Triangles& triangles, ConstMatrix3XRef<double> positions,
                          const DrawLimits& limits) {
  const auto num_nodes = static_cast<std::size_t>(positions.cols());
  SurfaceMesh mesh;
  mesh.vertices.resize(num_nodes);
  mesh.nodes.resize(num_nodes);
  std::iota(mesh.nodes.begin(), mesh.nodes.end(), 0);
  std::vector<bool> is_drawable(num_nodes);
  for (std::size_t i = 0; i < num_nodes; ++i) {
    const Vector3<double> x = positions.col(static_cast<Eigen::Index>(i)) - limits.origin;
    is_drawable[i] = x.allFinite() && x.cwiseAbs().maxCoeff() <= limits.largest;
    if (is_drawable[i]) mesh.vertices[i].position = x.cast<float>();
    mesh.vertices[i].normal.setZero();
  }
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const auto a = static_cast<std::size_t>(triangles(0, t));
    const auto b = static_cast<std::size_t>(triangles(1, t));
    const auto c = static_cast<std::size_t>(triangles(2, t));
    if (!is_drawable[a] || !is_drawable[b] || !is_drawable[c]) continue;
    for (const std::size_t node : {a, b, c}) {
      mesh.indices.push_back(static_cast<std::uint32_t>(node));
    }
    // Not normalised: a large triangle has more to say about the normal than a sliver.
    const Eigen::Vector3f normal =
        (mesh.vertices[b].position - mesh.vertices[a].position)
            .cross(mesh.vertices[c].position - mesh.vertices[a].position);
    for (const std::size_t node : {a, b, c}) mesh.vertices[node].normal += normal;
  }
  for (SurfaceVertex& vertex : mesh.vertices) {
    const float length = vertex.normal.norm();
    if (length > 0.0f && std::isfinite(length)) {
      vertex.normal /= length;
    } else {
      vertex.normal = Eigen::Vector3f::UnitY();
    }
  }
  return mesh;
}

SurfaceMesh with_barycentrics(const SurfaceMesh& mesh) {
  SurfaceMesh split;
  split.vertices.reserve(mesh.indices.size());
  split.indices.reserve(mesh.indices.size());
  for (std::size_t k = 0; k < mesh.indices.size(); ++k) {
    SurfaceVertex vertex = mesh.vertices[mesh.indices[k]];
    vertex.extra = Eigen::Vector3f::Unit(static_cast<Eigen::Index>(k % 3));
    split.vertices.push_back(vertex);
    if (!mesh.nodes.empty()) split.nodes.push_back(mesh.nodes[mesh.indices[k]]);
    split.indices.push_back(static_cast<std::uint32_t>(k));
  }
  return split;
}

SurfaceMesh ground_surface(double extent) {
  constexpr int kDivisions = 72;
  SurfaceMesh mesh;
  const auto spread = [&](double part) {
    const double t = 2.0 * part - 1.0;
    return extent * t * (0.15 + 0.85 * t * t);
  };
  append_patch(mesh, kDivisions, kDivisions, [&](double u, double v) {
    return body_vertex({spread(u), 0.0, -spread(v)}, Vector3<double>::UnitY(), {u, v});
  });
  return mesh;
}

}  // namespace weft::scenes
