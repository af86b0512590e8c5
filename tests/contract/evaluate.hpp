#pragma once

#include "tests/contract/dual/dual.hpp"
#include "tests/contract/sample.hpp"

namespace weft::contract {

/// Calls of one law with scratch memory of their own; results start from zero.

template <class Scalar>
[[nodiscard]] Matrix3X<Scalar> forces_of(const forces::ForceLaw<Scalar>& law,
                                         const Sample<Scalar>& sample) {
  Matrix3X<Scalar> scratch(3, law.scratch_columns());
  Matrix3X<Scalar> result = Matrix3X<Scalar>::Constant(3, sample.num_nodes(), Scalar(0));
  law.add_forces(sample.state(), scratch, result);
  return result;
}

template <class Scalar>
[[nodiscard]] Matrix3X<Scalar> stiffness_product(const forces::ForceLaw<Scalar>& law,
                                                 const Sample<Scalar>& sample,
                                                 const Matrix3X<Scalar>& displacements) {
  Matrix3X<Scalar> scratch(3, law.scratch_columns());
  Matrix3X<Scalar> result = Matrix3X<Scalar>::Constant(3, sample.num_nodes(), Scalar(0));
  law.add_stiffness_product(sample.state(), displacements, scratch, result);
  return result;
}

template <class Scalar>
[[nodiscard]] Matrix3X<Scalar> damping_product(const forces::ForceLaw<Scalar>& law,
                                               const Sample<Scalar>& sample,
                                               const Matrix3X<Scalar>& velocity_changes) {
  Matrix3X<Scalar> scratch(3, law.scratch_columns());
  Matrix3X<Scalar> result = Matrix3X<Scalar>::Constant(3, sample.num_nodes(), Scalar(0));
  law.add_damping_product(sample.state(), velocity_changes, scratch, result);
  return result;
}

/// Largest entry in magnitude; 0 for an empty matrix.
template <class Derived>
[[nodiscard]] double largest(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix.size() == 0
             ? 0.0
             : static_cast<double>(matrix.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>());
}

/// Size of the terms whose sum is the force [N], as far as a black box shows it: the force itself
/// and what the rounding of positions and velocities is multiplied with. Forces cancel at rest, the
/// terms do not.
template <class Scalar>
[[nodiscard]] double force_scale(const forces::ForceLaw<Scalar>& law,
                                 const Sample<Scalar>& sample) {
  const Matrix3X<Scalar> probe = random_directions(sample.num_nodes(), 99).template cast<Scalar>();
  return largest(forces_of(law, sample)) +
         largest(stiffness_product(law, sample, probe)) * largest(sample.positions) +
         largest(damping_product(law, sample, probe)) * largest(sample.velocities);
}

/// The sample with derivatives along the two directions.
[[nodiscard]] inline Sample<Dual> seeded(const Sample<double>& sample,
                                         const Matrix3X<double>& position_direction,
                                         const Matrix3X<double>& velocity_direction) {
  Sample<Dual> dual = cast<Dual>(sample);
  for (Eigen::Index i = 0; i < sample.positions.size(); ++i) {
    dual.positions.data()[i].derivatives()[0] = position_direction.data()[i];
    dual.velocities.data()[i].derivatives()[0] = velocity_direction.data()[i];
  }
  return dual;
}

[[nodiscard]] inline Matrix3X<double> derivatives_of(const Matrix3X<Dual>& dual) {
  Matrix3X<double> result(3, dual.cols());
  for (Eigen::Index i = 0; i < dual.size(); ++i) result.data()[i] = dual.data()[i].derivatives()[0];
  return result;
}

}  // namespace weft::contract
