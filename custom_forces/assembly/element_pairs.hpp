#pragma once

// Tested by tests/fast_solver/network/rest_stiffness_test.cpp.

#include <cstddef>
#include <vector>

#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// Appends each pair of corners of element e, tied by stiffness(corner, other) [N/m]. elements: node indices, one column per
/// element.
template <class Scalar, class Elements, class Stiffness>
void append_pairs(const Elements& elements, Eigen::Index e, const Stiffness& stiffness,
                  std::vector<PairStiffness<Scalar>>& pairs) {
  const auto num_nodes = static_cast<int>(elements.rows());
  for (int corner = 0; corner < num_nodes; ++corner) {
    for (int other = corner + 1; other < num_nodes; ++other) {
      pairs.push_back(
          {elements(corner, e), elements(other, e),
           stiffness(static_cast<std::size_t>(corner), static_cast<std::size_t>(other))});
    }
  }
}

}  // namespace weft::forces
