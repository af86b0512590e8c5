// The graph that aggregation works on: which nodes springs connect, and how strongly.
#include <weft/fast_solver/network/connectivity_graph.hpp>

#include <cstddef>

#include <weft/core/index.hpp>
#include <weft/fast_solver/network/network_forces.hpp>

namespace weft::fast {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]

/// take(other, place) for each spring of a node.
template <class Take>
void for_each_spring(const EdgeSlots& slots, int node, const Take& take) {
  const SlotRange& range = slots.blocks[at(node / kNodeBlock)];
  for (int slot = range.begin; slot < range.end; ++slot) {
    const std::size_t place = at(slot) * kNodeBlock + at(node % kNodeBlock);
    if (slots.edges[place] >= 0) take(slots.others[place], place);
  }
}

}  // namespace

template <class Scalar>
ConnectivityGraph NetworkForces<Scalar>::connectivity_graph(const std::vector<int>& names) const {
  std::vector<int> unknown_of(at(num_nodes()), -1);
  for (std::size_t k = 0; k < names.size(); ++k) unknown_of[at(names[k])] = static_cast<int>(k);
  ConnectivityGraph result;
  SymmetricMatrix& matrix = result.matrix;
  matrix.starts.push_back(0);
  for (const int node : names) {
    double sum = 0;
    for_each_spring(*slots_, node, [&](int other, std::size_t place) {
      const Scalar* const spring =
          springs_->data() + place / kNodeBlock * 3 * kNodeBlock + place % kNodeBlock;
      const double stiffness =
          static_cast<double>(spring[kNodeBlock]) +
          (has_damping_ ? static_cast<double>(damping_[place]) / kTimeStep : 0.0) +
          (has_bending_ ? static_cast<double>(bending_[place]) : 0.0);
      sum += stiffness;
      const int unknown = unknown_of[at(other)];
      if (unknown < 0) return;
      matrix.columns.push_back(unknown);
      matrix.values.push_back(-stiffness);
      result.lengths.push_back(static_cast<double>(spring[0]));
    });
    matrix.diagonal.push_back(sum);
    matrix.starts.push_back(static_cast<int>(matrix.columns.size()));
  }
  return result;
}

template <class Scalar>
Neighborhood NetworkForces<Scalar>::neighborhood_of(const std::vector<int>& nodes,
                                                    int num_springs) const {
  std::vector<char> is_in(at(num_nodes()), 0);
  for (const int node : nodes) is_in[at(node)] = 1;
  Neighborhood neighborhood{nodes, {static_cast<int>(nodes.size())}};
  std::size_t next = 0;
  for (int ring = 1; ring <= num_springs; ++ring) {
    for (; next < at(neighborhood.ends.back()); ++next) {
      for_each_spring(*slots_, neighborhood.nodes[next], [&](int other, std::size_t) {
        if (is_in[at(other)] != 0) return;
        is_in[at(other)] = 1;
        neighborhood.nodes.push_back(other);
      });
    }
    neighborhood.ends.push_back(static_cast<int>(neighborhood.nodes.size()));
  }
  return neighborhood;
}

template ConnectivityGraph NetworkForces<float>::connectivity_graph(const std::vector<int>&) const;
template ConnectivityGraph NetworkForces<double>::connectivity_graph(const std::vector<int>&) const;
template Neighborhood NetworkForces<float>::neighborhood_of(const std::vector<int>&, int) const;
template Neighborhood NetworkForces<double>::neighborhood_of(const std::vector<int>&, int) const;

}  // namespace weft::fast
