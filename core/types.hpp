#pragma once

// Tested by tests/custom_forces/body_sources_test.cpp.

#include <weft/core/eigen_alignment.hpp>

namespace weft {

/// Shapes, everywhere in Weft: per-node vectors are 3 x n, one column per node, world frame.
template <class Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
template <class Scalar>
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
template <class Scalar>
using Matrix2X = Eigen::Matrix<Scalar, 2, Eigen::Dynamic>;
template <class Scalar>
using Matrix3X = Eigen::Matrix<Scalar, 3, Eigen::Dynamic>;
template <class Scalar>
using VectorX = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

template <class Scalar>
using Matrix3XRef = Eigen::Ref<Matrix3X<Scalar>>;
template <class Scalar>
using ConstMatrix3XRef = const Eigen::Ref<const Matrix3X<Scalar>>&;

/// Edges, 2 x m, triples and triangles, 3 x m, hinges, 4 x m: one column per element, entries are
/// node indices.
using Edges = Eigen::Matrix<int, 2, Eigen::Dynamic>;
using Triples = Eigen::Matrix<int, 3, Eigen::Dynamic>;
using Triangles = Eigen::Matrix<int, 3, Eigen::Dynamic>;
using Hinges = Eigen::Matrix<int, 4, Eigen::Dynamic>;

}  // namespace weft
