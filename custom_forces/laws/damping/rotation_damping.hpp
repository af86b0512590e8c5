#pragma once

#include <weft/custom_forces/force_law.hpp>
#include <weft/custom_forces/laws/damping/body_damping.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::forces {

/// The rotation part of the rigid motion that carries a body's momenta: omega x r.
template <class Nodes>
class RigidRotation {
 public:
  explicit RigidRotation(const Nodes& nodes) : nodes_(nodes), body_(body_motion(nodes)) {}
  [[nodiscard]] Vector3<typename Nodes::Number> velocity(int node) const {
    return body_.spin(nodes_.position(node));
  }

 private:
  const Nodes& nodes_;
  BodyMotion<typename Nodes::Number> body_;
};

/// The rigid rotation of a body about its centre of mass decays; shape and path do not notice.
///
///   f_i = -m_i rate omega x r_i     r_i = x_i - x_c, omega = I^-1 L about the centre of mass x_c
///   power = -rate omega . L         alone: L(t) = L(0) exp(-rate t), in magnitude and direction,
///                                   for an asymmetric body too; P stays, and a body that does not
///                                   turn feels nothing
///
/// A velocity-level law: v_i -= (1 - exp(-h rate)) omega x r_i is its exact action over a time h.
/// The sums run over the free nodes; pinned nodes feel no force, but a body with pinned nodes turns
/// about the centre of the others, which is seldom what one wants.
/// A body on a line turns about axes across the line only (omega = 2 L / trace I).
///
/// Symbols  rate  1 / tau, tau the time constant  [1/s]  >= 0
/// Source   own derivation: the torque -rate L, shared out as a rigid motion
/// Checked  contract tests; rotation_damping
template <class Scalar>
class RotationDamping final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  RotationDamping(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  void add_damping_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocity_changes,
                           Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> product) const override;
  [[nodiscard]] Scalar non_conservative_power(const State<Scalar>& state) const override;
  void advance_velocities(const State<Scalar>& state, Scalar time_step,
                          Matrix3XRef<Scalar> velocities) const override;

 private:
  BodyDamping<Scalar, RigidRotation> damping_;
};

extern template class RotationDamping<float>;
extern template class RotationDamping<double>;

}  // namespace weft::forces
