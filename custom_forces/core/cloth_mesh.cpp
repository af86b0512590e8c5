#include <weft/custom_forces/core/cloth_mesh.hpp>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include <weft/custom_forces/core/error.hpp>

namespace weft {

int ClothMesh::num_edges() const {
  int count = 0;
  for (const EdgeSet& set : edge_sets) count += static_cast<int>(set.edges.cols());
  return count;
}

bool ClothMesh::has_edge_set(std::string_view name) const {
  return std::any_of(edge_sets.begin(), edge_sets.end(),
                     [&](const EdgeSet& set) { return set.name == name; });
}

Vector3<double> ClothMesh::pinned_velocity(std::size_t i) const {
  if (pinned_velocities.cols() == 0) return Vector3<double>::Zero();
  return pinned_velocities.col(static_cast<Eigen::Index>(i));
}

Edges ClothMesh::edges_of(const std::vector<std::string>& set_names) const {
  Edges edges(2, 0);
  for (const std::string& name : set_names) {
    const auto found = std::find_if(edge_sets.begin(), edge_sets.end(),
                                    [&](const EdgeSet& set) { return set.name == name; });
    if (found == edge_sets.end()) {
      std::string known;
      for (const EdgeSet& set : edge_sets) known += (known.empty() ? "" : ", ") + set.name;
      throw InvalidArgument("cloth mesh: edge set '" + name +
                            "' is unknown, expected one of: " + known);
    }
    const Eigen::Index old = edges.cols();
    edges.conservativeResize(2, old + found->edges.cols());
    edges.rightCols(found->edges.cols()) = found->edges;
  }
  return edges;
}

void connect(ClothMesh& mesh, const std::string& name, int node,
             const std::vector<int>& far_nodes) {
  const auto taken = [&](const ConnectionSet& set) { return set.name == name; };
  if (std::any_of(mesh.connection_sets.begin(), mesh.connection_sets.end(), taken)) {
    throw InvalidArgument("cloth mesh: connection set '" + name +
                          "' is there already, expected a new name");
  }
  ConnectionSet set{name, Edges(2, static_cast<Eigen::Index>(far_nodes.size()))};
  Eigen::Index column = 0;
  for (const int far : far_nodes) {
    for (const int end : {node, far}) {
      if (end < 0 || end >= mesh.num_nodes()) {
        throw InvalidArgument("cloth mesh: connection '" + name + "' names node " +
                              std::to_string(end) + ", expected 0 to " +
                              std::to_string(mesh.num_nodes() - 1));
      }
    }
    if (far == node) {
      throw InvalidArgument("cloth mesh: connection '" + name + "' ties node " +
                            std::to_string(node) + " to itself, expected another node");
    }
    set.connections.col(column++) << node, far;
  }
  mesh.connection_sets.push_back(std::move(set));
}

Matrix2X<double> corner_coordinates(const ClothMesh& mesh) {
  const Eigen::Index num_corners = mesh.triangles.size();
  const Matrix2X<double>& corners = mesh.corner_texture_coordinates;
  const Matrix2X<double>& nodes = mesh.texture_coordinates;
  const auto check = [](Eigen::Index number, Eigen::Index expected, const std::string& what) {
    if (number == expected) return;
    throw InvalidArgument("cloth mesh: " + std::to_string(number) + " texture coordinates of " +
                          what + ", expected " + std::to_string(expected));
  };
  if (corners.cols() > 0) {
    check(corners.cols(), num_corners, "corners");
    return corners;
  }
  if (nodes.cols() == 0) return nodes;
  check(nodes.cols(), mesh.num_nodes(), "nodes");
  return nodes(Eigen::all, mesh.triangles.reshaped());
}

VectorX<double> node_areas(const ClothMesh& mesh) {
  VectorX<double> areas = VectorX<double>::Zero(mesh.num_nodes());
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i nodes = mesh.triangles.col(t);
    const Vector3<double> a = mesh.rest_positions.col(nodes[0]);
    const Vector3<double> b = mesh.rest_positions.col(nodes[1]);
    const Vector3<double> c = mesh.rest_positions.col(nodes[2]);
    const double third = (b - a).cross(c - a).norm() / 6.0;
    for (const int node : nodes) areas[node] += third;
  }
  return areas;
}

VectorX<double> edge_lengths(ConstMatrix3XRef<double> positions, const Edges& edges) {
  VectorX<double> lengths(edges.cols());
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    lengths[e] = (positions.col(edges(1, e)) - positions.col(edges(0, e))).norm();
  }
  return lengths;
}

}  // namespace weft
