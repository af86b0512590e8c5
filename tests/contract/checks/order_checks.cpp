#include "tests/contract/checks/order_checks.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include <weft/core/parallel/threads.hpp>

#include "tests/contract/evaluate.hpp"

namespace weft::contract {
namespace {

/// A fixed permutation of 0 .. n-1 without a pattern that a grid shares.
std::vector<int> shuffled(int n) {
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  const Matrix3X<double> keys = random_directions(n, 5);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return keys(0, a) < keys(0, b); });
  return order;
}

template <class Elements>
void shuffle_columns(Elements& elements) {
  const Elements old = elements;
  const std::vector<int> order = shuffled(static_cast<int>(old.cols()));
  for (Eigen::Index e = 0; e < old.cols(); ++e) {
    elements.col(order[static_cast<std::size_t>(e)]) = old.col(e);
  }
}

/// Nodes renumbered: node i becomes node new_index[i].
ClothMesh renumbered(const ClothMesh& mesh, const std::vector<int>& new_index) {
  const auto map = [&](int node) { return new_index[static_cast<std::size_t>(node)]; };
  ClothMesh result = mesh;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    result.rest_positions.col(map(node)) = mesh.rest_positions.col(node);
    result.masses[map(node)] = mesh.masses[node];
  }
  for (int& node : result.triangles.reshaped()) node = map(node);
  for (int& node : result.crossed_triangles.reshaped()) node = map(node);
  for (EdgeSet& set : result.edge_sets) {
    for (auto edge : set.edges.colwise()) {
      const int a = map(edge[0]);
      const int b = map(edge[1]);
      edge << std::min(a, b), std::max(a, b);
    }
  }
  for (LineSet& set : result.line_sets) {
    for (int& node : set.triples.reshaped()) node = map(node);
  }
  for (ConnectionSet& set : result.connection_sets) {
    for (int& node : set.connections.reshaped()) node = map(node);
  }
  for (NodeSet& set : result.node_sets) {
    for (int& node : set.nodes) node = map(node);
    std::sort(set.nodes.begin(), set.nodes.end());
  }
  for (int& node : result.pinned) node = map(node);
  std::sort(result.pinned.begin(), result.pinned.end());
  return result;
}

template <class Scalar>
Matrix3X<Scalar> permuted(const Matrix3X<Scalar>& columns, const std::vector<int>& new_index) {
  Matrix3X<Scalar> result(3, columns.cols());
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    result.col(new_index[static_cast<std::size_t>(i)]) = columns.col(i);
  }
  return result;
}

template <class Scalar>
double different_bits(const Matrix3X<Scalar>& a, const Matrix3X<Scalar>& b) {
  double count = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (std::memcmp(a.data() + i, b.data() + i, sizeof(Scalar)) != 0) ++count;
  }
  return count;
}

/// Forces, stiffness product and damping product side by side, 3 x 3n [N].
template <class Scalar>
Matrix3X<Scalar> everything(const forces::ForceLaw<Scalar>& law, const Sample<Scalar>& sample) {
  const Eigen::Index n = sample.num_nodes();
  const Matrix3X<Scalar> b = random_directions(n, 17).template cast<Scalar>();
  Matrix3X<Scalar> all(3, 3 * n);
  all << forces_of(law, sample), stiffness_product(law, sample, b), damping_product(law, sample, b);
  return all;
}

}  // namespace

template <class Scalar>
Measurement edge_order_does_not_matter(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  ClothMesh other = mesh;
  for (EdgeSet& set : other.edge_sets) shuffle_columns(set.edges);
  for (LineSet& set : other.line_sets) shuffle_columns(set.triples);
  for (ConnectionSet& set : other.connection_sets) shuffle_columns(set.connections);
  for (NodeSet& set : other.node_sets) std::reverse(set.nodes.begin(), set.nodes.end());
  shuffle_columns(other.triangles);
  shuffle_columns(other.crossed_triangles);
  const auto law = subject.make<Scalar>(mesh);
  const auto other_law = subject.make<Scalar>(other);
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  return {largest(everything(*law, sample) - everything(*other_law, sample)),
          roundoff<Scalar>(sample.num_nodes(), force_scale(*law, sample)),
          "|change by edge order| [N]"};
}

template <class Scalar>
Measurement node_order_does_not_matter(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const std::vector<int> new_index = shuffled(mesh.num_nodes());
  const auto law = subject.make<Scalar>(mesh);
  const auto other_law = subject.make<Scalar>(renumbered(mesh, new_index));
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  Sample<Scalar> other{permuted(sample.positions, new_index),
                       permuted(sample.velocities, new_index), sample.masses};
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    other.masses[new_index[static_cast<std::size_t>(node)]] = sample.masses[node];
  }
  return {largest(permuted(forces_of(*law, sample), new_index) - forces_of(*other_law, other)),
          roundoff<Scalar>(sample.num_nodes(), force_scale(*law, sample)),
          "|change by node order| [N]"};
}

template <class Scalar>
Measurement calls_repeat_bit_for_bit(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<Scalar>(mesh);
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  const Matrix3X<Scalar> first = everything(*law, sample);
  return {different_bits(first, everything(*law, sample)), 0.0,
          "entries that change when repeated"};
}

template <class Scalar>
Measurement threads_change_no_bit(const Subject& subject) {
  const ClothMesh mesh = subject.large_mesh();
  const auto law = subject.make<Scalar>(mesh);
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  const auto with = [&](int threads) {
    return with_threads(threads, [&] { return everything(*law, sample); });
  };
  const Matrix3X<Scalar> expected = with(1);
  double count = 0;
  for (const int threads : {2, 4, 4, 4}) {
    count += different_bits(expected, with(threads));
  }
  return {count, 0.0, "entries that change with the number of threads"};
}

template <class Scalar>
Measurement some_nodes_are_enough(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<Scalar>(mesh);
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  Matrix3X<Scalar> none(3, 0);
  Matrix3X<Scalar> in_parts = Matrix3X<Scalar>::Zero(3, sample.num_nodes());
  const Eigen::Index size = 7;
  for (Eigen::Index begin = 0; begin < sample.num_nodes(); begin += size) {
    const Eigen::Index count = std::min(size, sample.num_nodes() - begin);
    law->add_forces(
        {sample.positions.middleCols(begin, count), sample.velocities.middleCols(begin, count),
         sample.masses.segment(begin, count)},
        none, in_parts.middleCols(begin, count));
  }
  return {different_bits(forces_of(*law, sample), in_parts), 0.0,
          "entries that change when asked for some nodes at a time"};
}

template <class Scalar>
Measurement results_are_added(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<Scalar>(mesh);
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  const Eigen::Index n = sample.num_nodes();
  const Matrix3X<Scalar> before = random_directions(n, 23).template cast<Scalar>();
  const Matrix3X<Scalar> b = random_directions(n, 17).template cast<Scalar>();
  Matrix3X<Scalar> scratch(3, law->scratch_columns());
  Matrix3X<Scalar> force = before;
  Matrix3X<Scalar> stiffness = before;
  Matrix3X<Scalar> damping = before;
  law->add_forces(sample.state(), scratch, force);
  law->add_stiffness_product(sample.state(), b, scratch, stiffness);
  law->add_damping_product(sample.state(), b, scratch, damping);
  Matrix3X<Scalar> added(3, 3 * n);
  added << force - before, stiffness - before, damping - before;
  return {largest(added - everything(*law, sample)),
          roundoff<Scalar>(n, largest(before) + force_scale(*law, sample)),
          "|result - what was there - what a law gives| [N]"};
}

template <class Scalar>
Measurement no_elements_no_force(const Subject& subject) {
  ClothMesh mesh = subject.mesh();
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  for (EdgeSet& set : mesh.edge_sets) set.edges.resize(2, 0);
  for (LineSet& set : mesh.line_sets) set.triples.resize(3, 0);
  for (ConnectionSet& set : mesh.connection_sets) set.connections.resize(2, 0);
  for (NodeSet& set : mesh.node_sets) set.nodes.clear();
  mesh.triangles.resize(3, 0);
  mesh.crossed_triangles.resize(3, 0);
  double size = largest(everything(*subject.make<Scalar>(mesh), sample));
  mesh.edge_sets.clear();
  mesh.line_sets.clear();
  mesh.connection_sets.clear();
  mesh.node_sets.clear();
  size += largest(everything(*subject.make<Scalar>(mesh), sample));
  return {size, 0.0, "|f| without elements [N]"};
}

template <class Scalar>
Measurement two_nodes_suffice(const Subject& subject) {
  if (subject.traits.needs_closed_surface) return {0.0, 0.0, "two nodes enclose nothing"};
  ClothMesh mesh;
  mesh.rest_positions.resize(3, 2);
  mesh.rest_positions << 0.1, 0.4, 0.2, 0.2, -0.3, 0.1;
  mesh.triangles.resize(3, 0);
  mesh.edge_sets.push_back({"stretch", Edges(2, 1)});
  mesh.edge_sets.front().edges << 0, 1;
  mesh.masses = VectorX<double>::Constant(2, 0.5);
  Sample<Scalar> sample = cast<Scalar>(at_rest(mesh));
  sample.positions(0, 1) += Scalar(0.2);
  sample.velocities.setOnes();
  const Matrix3X<Scalar> all = everything(*subject.make<Scalar>(mesh), sample);
  return {static_cast<double>((all.array() - all.array() != Scalar(0)).count()), 0.0,
          "entries that are not finite on a mesh of two nodes"};
}

#define WEFT_INSTANTIATE(Scalar)                                           \
  template Measurement edge_order_does_not_matter<Scalar>(const Subject&); \
  template Measurement node_order_does_not_matter<Scalar>(const Subject&); \
  template Measurement calls_repeat_bit_for_bit<Scalar>(const Subject&);   \
  template Measurement threads_change_no_bit<Scalar>(const Subject&);      \
  template Measurement some_nodes_are_enough<Scalar>(const Subject&);      \
  template Measurement results_are_added<Scalar>(const Subject&);          \
  template Measurement no_elements_no_force<Scalar>(const Subject&);       \
  template Measurement two_nodes_suffice<Scalar>(const Subject&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft::contract
