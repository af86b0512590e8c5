#include <weft/mesh/cloth_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>

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

namespace {

void require_mesh(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("cloth mesh: " + message);
}

class NodeCheck {
 public:
  explicit NodeCheck(int num_nodes) : num_nodes_(num_nodes) {}

  /// elements: one column each. what: "triangle", "edge of the set 'shear'".
  template <class Elements>
  void operator()(const Elements& elements, const std::string& what) const {
    for (Eigen::Index e = 0; e < elements.cols(); ++e) {
      for (const int node : elements.col(e)) {
        if (is_node(node)) continue;
        refuse(what + " " + std::to_string(e), node);
      }
    }
  }
  void operator()(const std::vector<int>& nodes, const std::string& what) const {
    for (const int node : nodes) {
      if (!is_node(node)) refuse(what, node);
    }
  }

 private:
  [[nodiscard]] bool is_node(int node) const { return node >= 0 && node < num_nodes_; }
  void refuse(const std::string& what, int node) const {
    require_mesh(false, what + " names node " + std::to_string(node) + ", expected 0 to " +
                            std::to_string(num_nodes_ - 1));
  }
  int num_nodes_;
};

void check_nodes(const ClothMesh& mesh) {
  const int num_nodes = mesh.num_nodes();
  require_mesh(num_nodes > 0, "it has no node, expected at least one");
  require_mesh(mesh.masses.size() == num_nodes, std::to_string(mesh.masses.size()) +
                                                    " masses, expected one for each of the " +
                                                    std::to_string(num_nodes) + " nodes");
  for (int i = 0; i < num_nodes; ++i) {
    const double mass = mesh.masses[i];
    if (std::isfinite(mass) && mass > 0) continue;
    require_mesh(false, "mass of node " + std::to_string(i) + " = " + std::to_string(mass) +
                            " [kg], expected > 0 and finite");
  }
  for (int i = 0; i < num_nodes; ++i) {
    if (mesh.rest_positions.col(i).allFinite()) continue;
    require_mesh(false, "rest position of node " + std::to_string(i) + " is not finite [m]");
  }
}

}  // namespace

void check_mesh(const ClothMesh& mesh) {
  check_nodes(mesh);
  const Eigen::Index num_velocities = mesh.pinned_velocities.cols();
  require_mesh(
      num_velocities == 0 || num_velocities == static_cast<Eigen::Index>(mesh.pinned.size()),
      std::to_string(num_velocities) + " velocities of pinned nodes, expected none or " +
          std::to_string(mesh.pinned.size()));
  require_mesh(mesh.pinned_velocities.allFinite(),
               "a velocity of a pinned node is not finite [m/s]");
  const NodeCheck check_indices(mesh.num_nodes());
  check_indices(mesh.pinned, "the list of pinned nodes");
  check_indices(mesh.triangles, "triangle");
  check_indices(mesh.crossed_triangles, "crossed triangle");
  for (const EdgeSet& set : mesh.edge_sets) {
    check_indices(set.edges, "edge set '" + set.name + "', edge");
  }
  for (const LineSet& set : mesh.line_sets) {
    check_indices(set.triples, "line set '" + set.name + "', triple");
  }
  for (const ConnectionSet& set : mesh.connection_sets) {
    check_indices(set.connections, "connection set '" + set.name + "', connection");
  }
  for (const NodeSet& set : mesh.node_sets) check_indices(set.nodes, "node set '" + set.name + "'");
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
