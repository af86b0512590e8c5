#pragma once

// Tested by tests/fast_solver/coarse/coarse_correction_test.cpp, tests/fast_solver/implicit_solver_test.cpp.

#include <vector>

#include <weft/fast_solver/network/sparse_matrix.hpp>

namespace weft::fast {

/// The graph Laplacian of the springs, weighted by their stiffness: as if a spring resisted transverse motion as much as axial
/// motion. It has no masses. NetworkForces makes it.
struct ConnectivityGraph {
  SymmetricMatrix matrix;       ///< [N/m]
  std::vector<double> lengths;  ///< for the spring of each entry, at rest [m]
};

/// The k-ring neighborhood of some nodes: ring 0 is these nodes, and ring k is k springs away.
struct Neighborhood {
  std::vector<int> nodes;  ///< ring after ring
  std::vector<int> ends;   ///< rings 0 to k are the first ends[k] nodes
};

}  // namespace weft::fast
