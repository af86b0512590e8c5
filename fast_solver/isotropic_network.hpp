#pragma once

#include <vector>

#include <weft/fast_solver/sparse_matrix.hpp>
#include <weft/fast_solver/spring_network.hpp>

namespace weft::fast {

/// A network whose springs resist as much across as along, without masses.
struct IsotropicNetwork {
  SymmetricMatrix matrix;       ///< [N/m]
  std::vector<double> lengths;  ///< of the spring of each entry, at rest [m]
};

/// Over the nodes names, ascending; what holds the others counts. network: by first, then by second node. Dampers count as in
/// steps of 1/60 s.
[[nodiscard]] IsotropicNetwork isotropic_network(const SpringNetwork& network, int num_nodes,
                                                 const std::vector<int>& names);

}  // namespace weft::fast
