#pragma once

#include <weft/fast_solver/interpolation.hpp>
#include <weft/fast_solver/isotropic_network.hpp>

namespace weft::fast {

/// Weights that an unknown has at most.
inline constexpr int kMostWeights = 3;

/// Patches of unknowns that are near each other over springs, about num_coarse of them or fewer, and hats over them that
/// overlap: an unknown has the part of each patch that it would have if its neighbours' parts were averaged some times
/// (smoothed aggregation, Vanek, Mandel and Brezina 1996), the kMostWeights largest of them. Near what holds
/// unknowns, hats are low; what no spring reaches has none.
[[nodiscard]] Interpolation smoothed_aggregates(const IsotropicNetwork& network, int num_coarse);

}  // namespace weft::fast
