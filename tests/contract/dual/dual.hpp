#pragma once

#include <weft/core/eigen_alignment.hpp>

#include <unsupported/Eigen/AutoDiff>

namespace weft {

/// Forward automatic differentiation along one direction. Laws are instantiated for it so that
/// their stiffness and damping products can be checked without differences.
using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;

}  // namespace weft
