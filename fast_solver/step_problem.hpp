#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp.

#include <span>

#include <weft/core/types.hpp>
#include <weft/fast_solver/network/element_stiffness.hpp>
#include <weft/fast_solver/node_constraints.hpp>

namespace weft::fast {

/// Forces that depend on the positions within a step, in addition to those of the network. They are minus the gradient of an
/// energy.
template <class Scalar>
class StepForces {
 public:
  virtual ~StepForces() = default;
  /// forces += those at positions, both 3 x n [m], [N].
  virtual void add_forces(ConstMatrix3XRef<Scalar> positions, Matrix3XRef<Scalar> forces) const = 0;
  /// Whether stiffness() is known; if not, the constant one of the network stands for it wherever nodes are.
  [[nodiscard]] virtual bool has_stiffness() const { return false; }
  /// Their stiffness at positions, if it is known: not null then, and valid until the next call.
  [[nodiscard]] virtual ElementStiffness* stiffness(ConstMatrix3XRef<Scalar> /*positions*/) const {
    return nullptr;
  }
  /// [J]
  [[nodiscard]] virtual double energy(ConstMatrix3XRef<Scalar> positions) const = 0;

 protected:
  StepForces() = default;
  StepForces(StepForces&&) = default;
  StepForces& operator=(StepForces&&) = default;
};

/// One implicit step. It asks for the x that solves
///
///   m_i (x_i - y_i) / h'^2 = f_i(x) + contact_i         for free nodes
///
/// where f are the forces of a SpringNetwork and of StepForces and y are the inertial positions. Implicit Euler has h' = h.
template <class Scalar>
struct StepProblem {
  Eigen::Ref<const Matrix3X<Scalar>>
      inertial_positions;  ///< y, 3 x n [m]; of pinned nodes: where they go
  Eigen::Ref<const Matrix3X<Scalar>> start_positions;  ///< q, 3 x n [m] at the start of the step
  Scalar time_step;                                    ///< h [s]: of dampers
  Scalar inertia_step;                                 ///< h' [s]: of nodes and rigid bodies
  std::span<const PlaneContact<Scalar>> contacts = {};
  std::span<const KinematicNode<Scalar>> kinematic = {};
  std::span<const RigidInertia<Scalar>> bodies = {};
  const StepForces<Scalar>* forces = nullptr;  ///< beside the network's
  /// The step was solved before: positions are the solution, and contacts are the same, with other planes or more of them behind.
  bool continues = false;
  std::span<const InertiaCoupling<Scalar>> couplings = {};  ///< between two of bodies
  std::span<const NodeSupport<Scalar>> supports = {};       ///< ascending by node
};

}  // namespace weft::fast
