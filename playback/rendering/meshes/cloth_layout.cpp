#include <weft/playback/rendering/meshes/cloth_layout.hpp>

#include <array>
#include <map>
#include <tuple>
#include <utility>

#include <weft/playback/rendering/meshes/tube_mesh.hpp>

namespace weft::scenes {
namespace {

bool is_closed(const Triangles& triangles) {
  std::map<std::pair<int, int>, int> uses;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) ++uses[std::minmax({triangles(k, t), triangles((k + 1) % 3, t)})];
  }
  for (const auto& [edge, count] : uses) {
    if (count != 2) return false;
  }
  return !uses.empty();
}

Edges rope_edges(const ClothMesh& mesh) {
  if (mesh.has_edge_set("stretch")) return mesh.edges_of({"stretch"});
  return Edges(2, 0);
}

}  // namespace

ClothLayout make_layout(const ClothMesh& mesh) {
  ClothLayout layout;
  layout.triangles = mesh.triangles;
  if (mesh.triangles.cols() == 0) {
    layout.rope = rope_edges(mesh);
    layout.has_coordinates = true;  // the tube's own: around it and along it
    return layout;
  }
  layout.is_closed = is_closed(mesh.triangles);
  const Matrix2X<double> coordinates = corner_coordinates(mesh);
  layout.has_coordinates = coordinates.cols() > 0;
  const Vector3<double> center = mesh.rest_positions.rowwise().mean();
  // One vertex per node and place in the texture: corners of a seam share the node only.
  std::map<std::tuple<int, float, float>, std::uint32_t> known;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int node = mesh.triangles(k, t);
      Eigen::Vector2f place(0, 0);
      if (layout.has_coordinates) place = coordinates.col(3 * t + k).cast<float>();
      const auto vertex = static_cast<std::uint32_t>(layout.nodes.size());
      const auto [entry, is_new] = known.try_emplace({node, place.x(), place.y()}, vertex);
      layout.corners.push_back(entry->second);
      if (!is_new) continue;
      layout.nodes.push_back(node);
      layout.coordinates.push_back(place);
      layout.rest_places.emplace_back((mesh.rest_positions.col(node) - center).cast<float>());
    }
  }
  return layout;
}

SurfaceMesh cloth_surface(const ClothLayout& layout, ConstMatrix3XRef<double> positions,
                          double rope_radius, const DrawLimits& limits) {
  if (layout.rope.cols() > 0) return tube_surface(layout.rope, positions, rope_radius, limits);
  const SurfaceMesh by_node = cloth_surface(layout.triangles, positions, limits);
  SurfaceMesh mesh;
  mesh.nodes = layout.nodes;
  mesh.vertices.reserve(layout.nodes.size());
  for (std::size_t v = 0; v < layout.nodes.size(); ++v) {
    SurfaceVertex vertex = by_node.vertices[static_cast<std::size_t>(layout.nodes[v])];
    vertex.value = layout.coordinates[v];
    vertex.extra = layout.rest_places[v];
    mesh.vertices.push_back(vertex);
  }
  // by_node has left out the triangles that cannot be drawn; the rest come in the same order.
  std::size_t drawn = 0;
  for (Eigen::Index t = 0; t < layout.triangles.cols() && drawn < by_node.indices.size(); ++t) {
    bool is_same = true;
    for (int k = 0; k < 3; ++k) {
      is_same = is_same && by_node.indices[drawn + static_cast<std::size_t>(k)] ==
                               static_cast<std::uint32_t>(layout.triangles(k, t));
    }
    if (!is_same) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.indices.push_back(layout.corners[3 * static_cast<std::size_t>(t) + k]);
    }
    drawn += 3;
  }
  return mesh;
}

}  // namespace weft::scenes
