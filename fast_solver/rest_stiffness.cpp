#include <weft/fast_solver/rest_stiffness.hpp>

#include <algorithm>
#include <cstddef>

#include <weft/custom_forces/law_set.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::fast {
namespace {

using Neighbours = std::vector<std::vector<int>>;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

template <class Nodes>
void couple(const Nodes& nodes, Neighbours& neighbours) {
  for (const int a : nodes) {
    for (const int b : nodes) {
      if (a != b) neighbours[at(a)].push_back(b);
    }
  }
}

void couple_triangles(const Triangles& triangles, Neighbours& neighbours) {
  // Two triangles with an edge in common share two of the three nodes around each of their corners.
  Neighbours of_node(neighbours.size());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (const int node : triangles.col(t)) of_node[at(node)].push_back(static_cast<int>(t));
  }
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(k, t);
      const int b = triangles((k + 1) % 3, t);
      const int c = triangles((k + 2) % 3, t);
      for (const int other : of_node[at(a)]) {
        const auto corners = triangles.col(other);
        if (other == t || (corners.array() != b).all()) continue;
        for (const int d : corners) {
          if (d != a && d != b) neighbours[at(c)].push_back(d);
        }
      }
      neighbours[at(a)].push_back(b);
      neighbours[at(b)].push_back(a);
    }
  }
}

Neighbours neighbours_of(const ClothMesh& mesh) {
  Neighbours neighbours(at(mesh.num_nodes()));
  couple_triangles(mesh.triangles, neighbours);
  couple_triangles(mesh.crossed_triangles, neighbours);
  for (const LineSet& set : mesh.line_sets) {
    for (const auto triple : set.triples.colwise()) {
      couple(std::vector<int>{triple[0], triple[1], triple[2]}, neighbours);
    }
  }
  for (std::vector<int>& of_node : neighbours) {
    std::sort(of_node.begin(), of_node.end());
    of_node.erase(std::unique(of_node.begin(), of_node.end()), of_node.end());
  }
  return neighbours;
}

/// Groups of nodes of which no two have a neighbour in common: one product shows all their columns.
std::vector<std::vector<int>> groups_of(const Neighbours& neighbours) {
  std::vector<int> group_of(neighbours.size(), -1);
  std::vector<std::vector<int>> groups;
  std::vector<int> last_user;  // of each group: the node that may not join it
  for (int node = 0; node < static_cast<int>(neighbours.size()); ++node) {
    const auto exclude = [&](int other) {
      if (group_of[at(other)] >= 0) last_user[at(group_of[at(other)])] = node;
    };
    for (const int other : neighbours[at(node)]) {
      exclude(other);
      for (const int far : neighbours[at(other)]) exclude(far);
    }
    const auto found =
        std::find_if(last_user.begin(), last_user.end(), [&](int user) { return user != node; });
    const auto group = found - last_user.begin();
    if (found == last_user.end()) {
      last_user.push_back(-1);
      groups.emplace_back();
    }
    group_of[at(node)] = static_cast<int>(group);
    groups[static_cast<std::size_t>(group)].push_back(node);
  }
  return groups;
}

}  // namespace

std::vector<MatrixPart> rest_stiffness(const ClothMesh& mesh,
                                       const std::vector<forces::LawSpecification>& laws) {
  std::vector<MatrixPart> parts;
  if (laws.empty()) return parts;
  forces::LawSet<double> set;
  for (const forces::LawSpecification& law : laws) set.add(forces::make_law<double>(law, mesh));
  const int n = mesh.num_nodes();
  const Matrix3X<double> no_velocities = Matrix3X<double>::Zero(3, n);
  const forces::State<double> state{mesh.rest_positions, no_velocities, mesh.masses, 0.0};
  const Neighbours neighbours = neighbours_of(mesh);
  Matrix3X<double> displacements(3, n);
  Matrix3X<double> product(3, n);
  std::vector<double> trace(at(n));
  for (const std::vector<int>& group : groups_of(neighbours)) {
    std::fill(trace.begin(), trace.end(), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      displacements.setZero();
      for (const int node : group) displacements(axis, node) = 1.0;
      product.setZero();
      set.add_stiffness_product(state, displacements, product);
      for (int i = 0; i < n; ++i) trace[at(i)] -= product(axis, i);
    }
    for (const int node : group) {
      for (const int other : neighbours[at(node)]) {
        if (other > node && trace[at(other)] != 0) parts.push_back({node, other, trace[at(other)]});
      }
    }
  }
  return parts;
}

}  // namespace weft::fast
