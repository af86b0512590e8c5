#pragma once

#include <vector>

#include <weft/fast_solver/coarse/prolongation.hpp>
#include <weft/fast_solver/network/connectivity_graph.hpp>

namespace weft::fast {

/// Weights that an unknown has at most.
inline constexpr int kMostWeights = 3;

/// Springs in a row, beyond which it says nothing about an unknown's coarse basis functions whether another one is free.
inline constexpr int kBasisReach = 4;

/// Unknowns that are near each other over springs.
struct Aggregates {
  int count = 0;
  std::vector<int> of_unknown;  ///< -1: none
};

/// About num_aggregates of them or fewer, one in each piece of the network at least, numbered by their first unknowns. What has
/// no springs has none. Whether unknowns are free makes no difference.
[[nodiscard]] Aggregates find_aggregates(const ConnectivityGraph& network, int num_aggregates);

/// Coarse basis functions over aggregates, which overlap: an unknown has the part of each aggregate that it would have if its neighbors' parts were
/// averaged some times (smoothed aggregation, Vanek, Mandel and Brezina 1996), the kMostWeights largest of them. Near
/// what holds unknowns, coarse basis functions are low; those that are not free have none, nor has what has no aggregate.
[[nodiscard]] Prolongation smoothed_aggregation(const ConnectivityGraph& network,
                                                const std::vector<bool>& is_free,
                                                const Aggregates& aggregates);
/// For the unknowns of rings 0 to kBasisReach only, the first ones of a network of rings up to twice that.
[[nodiscard]] Prolongation smoothed_aggregation(const ConnectivityGraph& network,
                                                const std::vector<bool>& is_free,
                                                const Aggregates& aggregates,
                                                const std::vector<int>& ends_of_rings);

}  // namespace weft::fast
