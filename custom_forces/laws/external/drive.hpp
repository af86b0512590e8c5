#pragma once

#include <vector>

#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// A hand that leads nodes along a motion given in time: each is pulled to its target by a spring
/// and a damper.
///
///   f = k (x_t - x) + c (v_t - v)
///   x_t = x_c + d + u t + R (x0 - x_c)     v_t = u + omega x R (x0 - x_c)
///   x0   rest position of the node, x_c the mean rest position of all nodes of the law
///   R    rotation by |omega| t about omega
///   t    time of the state, 0 when the simulation starts
///
/// The hand is outside the cloth: what its springs hold counts as work of the hand, not as energy
/// of the cloth, so that E = 0 and P_nc = f . v. Nodes follow a moving target with a lag of the
/// order of (load) / k; for an exact motion pin the nodes and give the pin a velocity.
///
/// Symbols  k      stiffness         [N/m]   >= 0, of each node
///          c      damping           [N s/m] >= 0, of each node, default 0
///          d      displacement      [m]     vector, default 0: a jump at the start
///          u      velocity          [m/s]   vector, default 0
///          omega  angular_velocity  [rad/s] vector, default 0
/// Errors   InvalidArgument at construction for a node set that the mesh does not have and for a
///          node outside the mesh
/// Source   proportional-derivative control of positions
/// Checked  contract tests; drive_test
template <class Scalar>
class Drive final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  Drive(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  void add_damping_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocity_changes,
                           Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> product) const override;
  [[nodiscard]] Scalar non_conservative_power(const State<Scalar>& state) const override;

 private:
  /// Calls visit(node, force) for every node of the law, in order [N].
  template <class Visit>
  void for_each_force(const State<Scalar>& state, const Visit& visit) const;

  std::vector<int> nodes_;            ///< sorted
  Matrix3X<double> arms_;             ///< x0 - x_c of each of nodes_ [m]
  Vector3<double> start_;             ///< x_c + d [m]
  Vector3<double> velocity_;          ///< [m/s]
  Vector3<double> angular_velocity_;  ///< [rad/s]
  Scalar stiffness_;                  ///< [N/m]
  Scalar damping_;                    ///< [N s/m]
};

extern template class Drive<float>;
extern template class Drive<double>;

}  // namespace weft::forces
