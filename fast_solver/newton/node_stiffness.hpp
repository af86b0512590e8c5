#pragma once

// Tested by tests/fast_solver/newton/node_stiffness_test.cpp.

#include <cmath>
#include <limits>

#include <weft/core/types.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>

namespace weft::fast {

/// The stiffness of a node's springs against its own motion along a unit vector, from the diagonal blocks of a network [N/m].
template <class Scalar>
[[nodiscard]] Scalar stiffness_along(const BlockArrays& blocks, int node,
                                     const Vector3<Scalar>& direction) {
  const auto block = [&](int k) { return Scalar(blocks(node, k)); };
  const Vector3<Scalar>& n = direction;
  return block(0) * n[0] * n[0] + block(1) * n[1] * n[1] + block(2) * n[2] * n[2] +
         2 * (block(3) * n[0] * n[1] + block(4) * n[1] * n[2] + block(5) * n[2] * n[0]);
}

/// What some nodes gain by the rounding of their positions alone, twice an energy as in LinearGain [J]. blocks: the diagonal
/// blocks of their stiffness; inertia: m / h'^2 and drag, for each node [N/m].
template <class Scalar>
[[nodiscard]] double gain_of_rounding(NodeRange nodes, const BlockArrays& blocks,
                                      const VectorX<float>& inertia,
                                      const NodeArrays<Scalar>& positions) {
  constexpr double kVariance = 1.0 / 12;  // of numbers rounded to whole ones
  constexpr double kUnit = std::numeric_limits<Scalar>::epsilon();
  const int count = nodes.end - nodes.begin;
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto stiffness =
        blocks.col(axis).segment(nodes.begin, count) + inertia.segment(nodes.begin, count);
    const auto places = positions.col(axis).segment(nodes.begin, count);
    sum += static_cast<double>(places.cwiseAbs2().template cast<float>().dot(stiffness));
  }
  return kVariance * kUnit * kUnit * sum;
}

/// One step of Jacobi's method for the residual and constraint forces of some nodes [N], which positions on their grid cannot follow.
template <class Scalar>
void find_compensation(NodeRange nodes, const BlockArrays& blocks, const VectorX<float>& inertia,
                       const NodeArrays<Scalar>& residuals, const NodeArrays<Scalar>& constraints,
                       const NodeArrays<Scalar>& positions, NodeArrays<Scalar>& compensation) {
  constexpr Scalar kHalfRounding = std::numeric_limits<Scalar>::epsilon() / 2;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = nodes.begin; i < nodes.end; ++i) {
      const Scalar stiffness = Scalar(inertia[i] + blocks(i, axis));
      const Scalar left = residuals(i, axis) + constraints(i, axis);
      const Scalar most = kHalfRounding * std::abs(positions(i, axis));
      const Scalar displacement = left / (stiffness > 0 ? stiffness : Scalar(1));
      compensation(i, axis) = displacement > most    ? most
                              : displacement < -most ? -most
                                                     : displacement;
    }
  }
}

}  // namespace weft::fast
