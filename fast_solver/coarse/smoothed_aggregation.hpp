#pragma once

// Tested by tests/fast_solver/coarse/coarse_correction_test.cpp.

#include <vector>

#include <weft/fast_solver/coarse/prolongation.hpp>
#include <weft/fast_solver/network/connectivity_graph.hpp>

namespace weft::fast {

/// Weights that an unknown has at most.
inline constexpr int kMostWeights = 3;

/// The reach of coarse basis functions: whether an unknown is free affects those of unknowns up to so many springs away.
inline constexpr int kBasisReach = 4;

/// Aggregates: disjoint sets of unknowns that springs connect.
struct Aggregates {
  int count = 0;
  std::vector<int> of_unknown;  ///< -1: none
};

/// About num_aggregates aggregates or fewer, but at least one in each connected component, numbered by their first unknowns. An
/// unknown without springs belongs to none. Whether unknowns are free makes no difference.
[[nodiscard]] Aggregates find_aggregates(const ConnectivityGraph& network, int num_aggregates);

/// Coarse basis functions by smoothed aggregation (Vanek, Mandel and Brezina 1996): damped Jacobi sweeps smooth the indicator
/// function of each aggregate, and an unknown keeps its kMostWeights largest weights. The functions are small near fixed
/// unknowns. Unknowns that are not free or have no aggregate have no weights.
[[nodiscard]] Prolongation smoothed_aggregation(const ConnectivityGraph& network,
                                                const std::vector<bool>& is_free,
                                                const Aggregates& aggregates);
/// For the unknowns of rings 0 to kBasisReach only, the first ones of a network of rings up to twice that.
[[nodiscard]] Prolongation smoothed_aggregation(const ConnectivityGraph& network,
                                                const std::vector<bool>& is_free,
                                                const Aggregates& aggregates,
                                                const std::vector<int>& ends_of_rings);

}  // namespace weft::fast
