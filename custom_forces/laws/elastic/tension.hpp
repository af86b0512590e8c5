#pragma once

#include <weft/custom_forces/assembly/spring_set.hpp>
#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// Linear springs along edges.
///
///   E = k' (l - l0)^2 / 2     f_i = k' (l - l0) u     f_j = -f_i     u = (x_j - x_i) / l
///   k' = k if l >= l0, else ratio k
///
/// Symbols  k      stiffness          [N/m]  >= 0, of each spring, however long: the moduli of a
///                                           sheet are multiples of it (membrane_moduli.hpp)
///          ratio  compression_ratio  [1]    0 to 1; 0: slack, 1 (default): pushes as it pulls
///          l0     rest length        [m]    > 0, from the mesh
/// Errors   InvalidArgument at construction; a spring shorter than kMinLengthRatio l0 exerts
///          no force
/// Source   Werth 2008 (tension constant times length minus rest length); signs as
///          docs/conventions.md
/// Checked  contract tests; hanging_chain, oscillator
template <class Scalar>
class Tension final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  Tension(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  [[nodiscard]] Eigen::Index scratch_columns() const override { return springs_.scratch_columns(); }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  [[nodiscard]] Scalar potential_energy(const State<Scalar>& state) const override;

 private:
  struct Stiffness {
    Scalar stretched{};   ///< [N/m]
    Scalar compressed{};  ///< [N/m]
    [[nodiscard]] Scalar at(Scalar extension) const {
      return extension < Scalar(0) ? compressed : stretched;
    }
  };

  SpringSet<Scalar> springs_;
  Stiffness stiffness_;
};

extern template class Tension<float>;
extern template class Tension<double>;

}  // namespace weft::forces
