#pragma once

// Tested by tests/custom_forces/law_set_test.cpp, tests/contract/law_contract_test.cpp.

#include <vector>

#include <weft/core/types.hpp>
#include <weft/custom_forces/law_info.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::forces {

/// What a law may look at: nothing but this.
template <class Scalar>
struct State {
  Eigen::Ref<const Matrix3X<Scalar>> positions;   ///< x, 3 x n [m]
  Eigen::Ref<const Matrix3X<Scalar>> velocities;  ///< v, 3 x n [m/s]
  Eigen::Ref<const VectorX<Scalar>> masses;       ///< m, n [kg]; a pinned node has its mass too
  double time = 0.0;                              ///< t [s], for laws with targets that move
};

/// How strongly a law ties two nodes at the rest shape.
template <class Scalar>
struct PairStiffness {
  int first;
  int second;
  Scalar trace;  ///< of the 3 x 3 block (first, second) of -df/dx [N/m]
};

/// A force law: a pure function of State. It holds its topology and parameters, checked when it was
/// made, and afterwards never changes: no clock, no random numbers, no allocation while it runs, no
/// engine.
///
/// Shapes   all matrices 3 x n, one column per node, world frame
/// Threads  add_* functions run on num_threads() threads; two calls at once on one law are safe with different
/// scratch
template <class Scalar>
class ForceLaw {
 public:
  virtual ~ForceLaw() = default;

  [[nodiscard]] virtual const LawInfo& info() const noexcept = 0;

  /// Columns of 3 x k scratch memory that add_* need. The caller owns it, so that a law allocates
  /// nothing.
  [[nodiscard]] virtual Eigen::Index scratch_columns() const { return 0; }

  /// forces += f(state) [N], also on pinned nodes: what a node may do with its force is the
  /// engine's matter.
  virtual void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                          Matrix3XRef<Scalar> forces) const = 0;

  /// product += (df/dx) displacements [N]. With add_damping_product all that an implicit solver and
  /// the stable-step estimate need.
  virtual void add_stiffness_product(const State<Scalar>& /*state*/,
                                     ConstMatrix3XRef<Scalar> /*displacements*/,
                                     Matrix3XRef<Scalar> /*scratch*/,
                                     Matrix3XRef<Scalar> /*product*/) const {}

  /// product += (df/dv) velocity_changes [N].
  virtual void add_damping_product(const State<Scalar>& /*state*/,
                                   ConstMatrix3XRef<Scalar> /*velocity_changes*/,
                                   Matrix3XRef<Scalar> /*scratch*/,
                                   Matrix3XRef<Scalar> /*product*/) const {}

  /// Appends the pairs of different nodes that each element ties at the rest shape, each pair once an element. rest: the
  /// positions that the law was made with. Only for laws of bending, which no product would show as cheaply.
  virtual void add_rest_stiffness(const State<Scalar>& /*rest*/,
                                  std::vector<PairStiffness<Scalar>>& /*pairs*/) const {}

  /// Stored energy [J]; 0 for a law that stores none.
  [[nodiscard]] virtual Scalar potential_energy(const State<Scalar>& /*state*/) const {
    return Scalar(0);
  }

  /// Power of the part that does not come from the energy [W]: negative for a damper, positive for
  /// a driver.
  [[nodiscard]] virtual Scalar non_conservative_power(const State<Scalar>& /*state*/) const {
    return Scalar(0);
  }

  /// Only for traits.level == kVelocity: the exact action of the law alone on velocities over
  /// time_step [s]. Engines that project positions apply this after the projection; there
  /// add_forces is not called.
  virtual void advance_velocities(const State<Scalar>& /*state*/, Scalar /*time_step*/,
                                  Matrix3XRef<Scalar> /*velocities*/) const {}

  /// Only for traits.level == kInertia: replaces the sum of all other forces on the body by those
  /// that give the law's accelerations. Linear in forces, so that products of the others can be
  /// redistributed as well.
  virtual void redistribute_forces(const State<Scalar>& /*state*/,
                                   Matrix3XRef<Scalar> /*forces*/) const {}

  /// Only for traits.level == kInertia: kinetic energy that the added inertia stores [J], a
  /// quadratic form of the velocities. With it, and with the plain kinetic energy, the balance of
  /// the redistributed forces closes.
  [[nodiscard]] virtual Scalar added_kinetic_energy(const State<Scalar>& /*state*/) const {
    return Scalar(0);
  }
};

}  // namespace weft::forces
