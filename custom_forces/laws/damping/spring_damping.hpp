#pragma once

#include <weft/custom_forces/assembly/spring_set.hpp>
#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// Viscous damper along each edge.
///
///   f_i = c (w . u) u     f_j = -f_i     power = -c (w . u)^2
///   w = v_j - v_i         u = (x_j - x_i) / l
///
/// Symbols  c  damping  [N*s/m]  >= 0
/// Errors   InvalidArgument at construction; an edge shorter than kMinLengthRatio l0 exerts
///          no force
/// Source   dashpot parallel to a spring; acts on the change of length only, so that a rigid
///          motion feels nothing
/// Checked  contract tests; oscillator
template <class Scalar>
class SpringDamping final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  SpringDamping(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  [[nodiscard]] Eigen::Index scratch_columns() const override { return springs_.scratch_columns(); }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  void add_damping_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocity_changes,
                           Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> product) const override;
  [[nodiscard]] Scalar non_conservative_power(const State<Scalar>& state) const override;

 private:
  SpringSet<Scalar> springs_;
  Scalar damping_;  ///< [N s/m]
};

extern template class SpringDamping<float>;
extern template class SpringDamping<double>;

}  // namespace weft::forces
