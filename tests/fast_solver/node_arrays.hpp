#pragma once

#include <weft/fast_solver/network/network_forces.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>

namespace weft::fast {

/// vectors, 3 x n, as the solver keeps them.
template <class Scalar>
[[nodiscard]] NodeArrays<Scalar> arrays_of(const Matrix3X<Scalar>& vectors) {
  const int rows = rows_for(static_cast<int>(vectors.cols()));
  NodeArrays<Scalar> arrays(rows, 3);
  to_arrays<Scalar>(vectors, {0, rows}, arrays);
  return arrays;
}

/// starts: q, 3 x n [m].
template <class Scalar>
void begin_step(NetworkForces<Scalar>& network, const Matrix3X<Scalar>& starts, Scalar time_step) {
  network.set_time_step(time_step);
  network.begin_step(network.all_nodes(), arrays_of(starts));
}

/// The forces of a network at positions x, 3 x n [N].
template <class Scalar>
[[nodiscard]] Matrix3X<Scalar> forces_at(NetworkForces<Scalar>& network, const Matrix3X<Scalar>& x,
                                         bool linearizes = true) {
  NodeArrays<Scalar> forces = NodeArrays<Scalar>::Zero(rows_for(network.num_nodes()), 3);
  network.add_forces(network.all_nodes(), arrays_of(x), forces, linearizes);
  Matrix3X<Scalar> result(3, x.cols());
  from_arrays<Scalar>(forces, network.all_nodes(), result);
  return result;
}

}  // namespace weft::fast
