#pragma once

#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// Uniform gravity.
///
///   f = m g     E = -m g . x
///
/// Symbols  g  acceleration  [m/s^2], vector
/// Source   uniform field
/// Checked  contract tests; hanging_chain, hang
template <class Scalar>
class Gravity final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  Gravity(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  [[nodiscard]] Scalar potential_energy(const State<Scalar>& state) const override;

 private:
  Vector3<Scalar> acceleration_;  ///< [m/s^2]
};

extern template class Gravity<float>;
extern template class Gravity<double>;

}  // namespace weft::forces
