#pragma once

#include <weft/fast_solver/network_forces.hpp>
#include <weft/fast_solver/node_arrays.hpp>

namespace weft::fast {

/// vectors, 3 x n, as the solver keeps them.
template <class Scalar>
[[nodiscard]] NodeArrays<Scalar> arrays_of(const Matrix3X<Scalar>& vectors) {
  NodeArrays<Scalar> arrays(fill_up(static_cast<int>(vectors.cols())), 3);
  to_arrays<Scalar>(vectors, arrays);
  return arrays;
}

/// Of a network at places x, 3 x n [N].
template <class Scalar>
[[nodiscard]] Matrix3X<Scalar> forces_at(NetworkForces<Scalar>& network,
                                         const Matrix3X<Scalar>& x) {
  NodeArrays<Scalar> forces = NodeArrays<Scalar>::Zero(fill_up(network.num_nodes()), 3);
  network.add_forces(arrays_of(x), forces);
  Matrix3X<Scalar> result(3, x.cols());
  from_arrays<Scalar>(forces, result);
  return result;
}

}  // namespace weft::fast
