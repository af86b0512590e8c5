#pragma once

#include <vector>

#include <weft/fast_solver/network/sparse_matrix.hpp>

namespace weft::fast {

/// A network whose springs resist as much across as along, without masses. Made by NetworkForces.
struct ConnectivityGraph {
  SymmetricMatrix matrix;       ///< [N/m]
  std::vector<double> lengths;  ///< of the spring of each entry, at rest [m]
};

/// Nodes around some nodes, which are ring 0; ring k is k springs away.
struct Neighborhood {
  std::vector<int> nodes;  ///< ring after ring
  std::vector<int> ends;   ///< rings 0 to k are the first ends[k] nodes
};

}  // namespace weft::fast
