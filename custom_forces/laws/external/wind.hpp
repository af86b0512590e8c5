#pragma once

#include <weft/custom_forces/assembly/element_force.hpp>
#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// Air that moves past the faces, or faces that move through air.
///
///   f = rho (C_n |w.n| (w.n) n + C_t |w_t| w_t) A / 2 for each face, a third to each of its nodes
///   w  velocity of the air as the face sees it: u minus the mean velocity of its three nodes
///   n, A  normal and area of the face as it is now; w_t = w - (w.n) n
///
/// Both sides of a face feel the same: turning a triangle round changes nothing. A face does not
/// shelter another one, and the air is not slowed down.
///
/// Symbols  u    velocity         [m/s]    of the air, vector
///          rho  air_density      [kg/m^3] >= 0, default 1.2: air at 20 degrees Celsius
///          C_n  normal_drag      [1]      >= 0, default 1: the full dynamic pressure rho w^2 / 2 on
///               the face. A stiff square plate across the wind measures 1.2, cloth that lets air
///               through less than 1
///          C_t  tangential_drag  [1]      >= 0, default 0; measured on flags: about 0.01 to 0.1
/// Errors   InvalidArgument at construction for a triangle of nodes that the mesh does not have; a
///          face smaller than kMinAreaRatio of its rest area, or of no rest area, feels nothing
/// Source   quadratic drag, resolved along and across the face
/// Checked  contract tests; hover
template <class Scalar>
class Wind final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  Wind(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  [[nodiscard]] Eigen::Index scratch_columns() const override { return faces_.scratch_columns(); }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  void add_damping_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocity_changes,
                           Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> product) const override;
  [[nodiscard]] Scalar non_conservative_power(const State<Scalar>& state) const override;

  /// Smallest triangle whose normal is still trusted, as a fraction of its rest area [-].
  static constexpr double kMinAreaRatio = 1e-6;

 private:
  /// Force on a face [N].
  template <class Number>
  Vector3<Number> face_force(Eigen::Index f, const ElementState<Number, 3>& face) const;
  /// The kernel: a third of the face's force to each node.
  template <class Number>
  void add_face(Eigen::Index f, const ElementState<Number, 3>& face,
                ElementForces<Number, 3>& parts) const;

  ElementForce<Scalar, 3> faces_;
  Vector3<Scalar> velocity_;          ///< u [m/s]
  Scalar normal_factor_;              ///< rho C_n / 2 [kg/m^3]
  Scalar tangential_factor_;          ///< rho C_t / 2 [kg/m^3]
  VectorX<Scalar> smallest_normals_;  ///< squared length of twice the least area vector [m^4]
};

extern template class Wind<float>;
extern template class Wind<double>;

}  // namespace weft::forces
