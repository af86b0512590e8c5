#include <weft/mesh/rope.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <weft/core/error.hpp>

namespace weft {
namespace {

constexpr int kMaxNodes = 10'000'000;

void require_rope(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("rope: " + message);
}

void check(const Rope& rope) {
  require_rope(
      rope.nodes >= 2 && rope.nodes <= kMaxNodes,
      "nodes = " + std::to_string(rope.nodes) + ", expected 2 to " + std::to_string(kMaxNodes));
  const double length = (rope.end - rope.start).norm();
  require_rope(
      std::isfinite(length) && length > 0,
      "length from start to end = " + std::to_string(length) + " [m], expected > 0 and finite");
  require_rope(
      std::isfinite(rope.total_mass) && rope.total_mass > 0,
      "total_mass = " + std::to_string(rope.total_mass) + " [kg], expected > 0 and finite");
}

/// Node i and the one that many nodes further, for every i.
Edges edges_of_step(int num_nodes, int step) {
  Edges edges(2, std::max(0, num_nodes - step));
  for (int i = 0; i + step < num_nodes; ++i) edges.col(i) << i, i + step;
  return edges;
}

VectorX<double> node_masses(const Rope& rope) {
  VectorX<double> masses = VectorX<double>::Ones(rope.nodes);
  if (rope.lumping == MassLumping::kArea) masses[0] = masses[rope.nodes - 1] = 0.5;
  return masses * (rope.total_mass / masses.sum());
}

}  // namespace

ClothMesh make_rope(const Rope& rope) {
  check(rope);
  ClothMesh mesh;
  mesh.rest_positions.resize(3, rope.nodes);
  mesh.texture_coordinates = Matrix2X<double>::Zero(2, rope.nodes);
  for (int i = 0; i < rope.nodes; ++i) {
    const double part = i / (rope.nodes - 1.0);
    // Both ends exactly as given.
    mesh.rest_positions.col(i) = (1 - part) * rope.start + part * rope.end;
    mesh.texture_coordinates(0, i) = part;
  }
  mesh.triangles.resize(3, 0);
  mesh.edge_sets.push_back({"stretch", edges_of_step(rope.nodes, 1)});
  mesh.edge_sets.push_back({"bend", edges_of_step(rope.nodes, 2)});
  Triples lines(3, std::max(0, rope.nodes - 2));
  for (int i = 0; i + 2 < rope.nodes; ++i) lines.col(i) << i, i + 1, i + 2;
  mesh.line_sets.push_back({"lines", lines});
  mesh.masses = node_masses(rope);
  return mesh;
}

}  // namespace weft
