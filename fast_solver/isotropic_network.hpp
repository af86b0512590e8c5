#pragma once

#include <vector>

#include <weft/fast_solver/sparse_matrix.hpp>

namespace weft::fast {

/// A network whose springs resist as much across as along, without masses. Made by NetworkForces.
struct IsotropicNetwork {
  SymmetricMatrix matrix;       ///< [N/m]
  std::vector<double> lengths;  ///< of the spring of each entry, at rest [m]
};

}  // namespace weft::fast
