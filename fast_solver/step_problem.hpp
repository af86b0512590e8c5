#pragma once

#include <span>

#include <weft/custom_forces/core/types.hpp>
#include <weft/fast_solver/node_constraints.hpp>

namespace weft::fast {

/// One implicit step: find x with
///
///   m_i (x_i - y_i) / h'^2 = f_i(x) + contact_i         for free nodes
///
/// f of a SpringNetwork, y where the node would go without f. Implicit Euler has h' = h.
template <class Scalar>
struct StepProblem {
  Eigen::Ref<const Matrix3X<Scalar>> targets;  ///< y, 3 x n [m]; of pinned nodes: where they go
  Eigen::Ref<const Matrix3X<Scalar>> starts;   ///< q, 3 x n [m] at the start of the step
  Scalar time_step;                            ///< h [s]: of dampers and of rigid bodies
  Scalar inertia_step;                         ///< h' [s]
  std::span<const PlaneContact<Scalar>> contacts = {};
  std::span<const LedNode<Scalar>> led = {};
  std::span<const RigidInertia<Scalar>> bodies = {};
};

}  // namespace weft::fast
