#pragma once

#include <vector>

#include <weft/fast_solver/coarse/interpolation.hpp>
#include <weft/fast_solver/network/isotropic_network.hpp>

namespace weft::fast {

/// Weights that an unknown has at most.
inline constexpr int kMostWeights = 3;

/// Springs in a row, beyond which it says nothing about an unknown's hats whether another one is free.
inline constexpr int kHatReach = 4;

/// Unknowns that are near each other over springs.
struct Patches {
  int count = 0;
  std::vector<int> of_unknown;  ///< -1: none
};

/// About num_patches of them or fewer, one in each piece of the network at least, numbered by their first unknowns. What has
/// no springs has none. Whether unknowns are free makes no difference.
[[nodiscard]] Patches find_patches(const IsotropicNetwork& network, int num_patches);

/// Hats over patches, which overlap: an unknown has the part of each patch that it would have if its neighbours' parts were
/// averaged some times (smoothed aggregation, Vanek, Mandel and Brezina 1996), the kMostWeights largest of them. Near
/// what holds unknowns, hats are low; those that are not free have none, nor has what has no patch.
[[nodiscard]] Interpolation smoothed_aggregates(const IsotropicNetwork& network,
                                                const std::vector<bool>& is_free,
                                                const Patches& patches);
/// For the unknowns of rings 0 to kHatReach only, the first ones of a network of rings up to twice that.
[[nodiscard]] Interpolation smoothed_aggregates(const IsotropicNetwork& network,
                                                const std::vector<bool>& is_free,
                                                const Patches& patches,
                                                const std::vector<int>& ends_of_rings);

}  // namespace weft::fast
