#include <weft/mesh/mesh_part.hpp>

#include <weft/core/index.hpp>

#include <algorithm>

namespace weft {
namespace {

bool is_marked(const std::vector<char>& flags, int node) {
  return flags[at(node)] != 0;
}

/// Columns of elements that have a node with a flag.
template <class Elements>
std::vector<Eigen::Index> touching(const Elements& elements, const std::vector<char>& flags) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index e = 0; e < elements.cols(); ++e) {
    char any = 0;
    for (Eigen::Index k = 0; k < elements.rows(); ++k) any |= flags[at(elements(k, e))];
    if (any != 0) columns.push_back(e);
  }
  return columns;
}

template <class Elements>
Elements chosen(const Elements& elements, const std::vector<Eigen::Index>& columns) {
  return elements(Eigen::all, columns);
}

/// Triangles with a wanted node, and all around their nodes.
Triangles with_next(const Triangles& triangles, const std::vector<char>& is_wanted) {
  std::vector<char> is_near = is_wanted;
  for (const Eigen::Index t : touching(triangles, is_wanted)) {
    for (const int node : triangles.col(t)) is_near[at(node)] = 1;
  }
  return chosen(triangles, touching(triangles, is_near));
}

template <class Elements>
void mark(const Elements& elements, std::vector<char>& flags) {
  for (const int node : elements.reshaped()) flags[at(node)] = 1;
}

template <class Elements>
void rename(const std::vector<int>& number_of, Elements& elements) {
  for (int& node : elements.reshaped()) node = number_of[at(node)];
}

ClothMesh elements_around(const ClothMesh& mesh, const std::vector<char>& is_wanted) {
  ClothMesh part;
  for (const EdgeSet& set : mesh.edge_sets) {
    part.edge_sets.push_back({set.name, chosen(set.edges, touching(set.edges, is_wanted))});
  }
  for (const LineSet& set : mesh.line_sets) {
    part.line_sets.push_back({set.name, chosen(set.triples, touching(set.triples, is_wanted))});
  }
  part.triangles = with_next(mesh.triangles, is_wanted);
  part.crossed_triangles = with_next(mesh.crossed_triangles, is_wanted);
  // Laws ask whether there are any.
  if (part.crossed_triangles.cols() == 0 && mesh.crossed_triangles.cols() > 0) {
    part.crossed_triangles = mesh.crossed_triangles.leftCols(1);
  }
  return part;
}

}  // namespace

MeshPart part_around(const ClothMesh& mesh, const std::vector<char>& is_wanted) {
  MeshPart part{elements_around(mesh, is_wanted), {}};
  std::vector<char> is_in = is_wanted;
  for (const EdgeSet& set : part.mesh.edge_sets) mark(set.edges, is_in);
  for (const LineSet& set : part.mesh.line_sets) mark(set.triples, is_in);
  mark(part.mesh.triangles, is_in);
  mark(part.mesh.crossed_triangles, is_in);
  std::vector<int> number_of(is_in.size(), -1);
  for (std::size_t node = 0; node < is_in.size(); ++node) {
    if (is_in[node] == 0) continue;
    number_of[node] = static_cast<int>(part.nodes.size());
    part.nodes.push_back(static_cast<int>(node));
  }
  for (EdgeSet& set : part.mesh.edge_sets) rename(number_of, set.edges);
  for (LineSet& set : part.mesh.line_sets) rename(number_of, set.triples);
  rename(number_of, part.mesh.triangles);
  rename(number_of, part.mesh.crossed_triangles);
  part.mesh.rest_positions = mesh.rest_positions(Eigen::all, part.nodes);
  part.mesh.masses = mesh.masses(part.nodes);
  for (const int node : mesh.pinned) {
    if (is_marked(is_in, node)) part.mesh.pinned.push_back(number_of[at(node)]);
  }
  return part;
}

}  // namespace weft
