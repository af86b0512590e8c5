#pragma once

#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// Proportional loss of velocity, the same for every mass.
///
///   f = -gamma m v     power = -gamma m v^2     alone: v(t) = v(0) exp(-gamma t)
///
/// A velocity-level law: engines apply the exact factor exp(-gamma dt) after their step, so that
/// the decay does not depend on the time step.
///
/// Symbols  gamma  rate  [1/s]  >= 0
/// Source   de Joya 2011: damping as a proportional velocity loss
/// Checked  contract tests; oscillator
template <class Scalar>
class VelocityDamping final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  VelocityDamping(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_damping_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocity_changes,
                           Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> product) const override;
  [[nodiscard]] Scalar non_conservative_power(const State<Scalar>& state) const override;
  void advance_velocities(const State<Scalar>& state, Scalar time_step,
                          Matrix3XRef<Scalar> velocities) const override;

 private:
  Scalar rate_;  ///< [1/s]
};

extern template class VelocityDamping<float>;
extern template class VelocityDamping<double>;

}  // namespace weft::forces
