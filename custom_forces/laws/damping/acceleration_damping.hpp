#pragma once

#include <weft/custom_forces/force_law.hpp>
#include <weft/custom_forces/laws/damping/free_nodes.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::forces {

/// Damping of accelerations: an added inertia against all motion relative to the centre of mass.
///
///   f_i <- m_i (a_c + (a_i - a_c) / (1 + beta))     a_i = f_i / m_i, a_c = sum f / sum m
///
/// over the free nodes, f the sum of all other forces; forces on pinned nodes stay as they are. An
/// inertia-level law: it takes the present forces and so needs no acceleration of the step before
/// (feeding that back diverges for beta > 1).
///
/// The centre of mass moves as without it, so free fall and P stay; the static shape stays; L stays
/// under internal forces, while external torques turn the body 1 + beta times more slowly, and a
/// spinning body is held together against (1 + beta) m omega^2 r. Oscillations take sqrt(1 + beta)
/// times as long, and the largest stable explicit step is that much longer. It takes no energy: the
/// added inertia stores (beta / 2) sum m |v - v_c|^2 (added_kinetic_energy).
///
/// Symbols  beta  ratio of the added inertia to the mass  [-]  >= 0
/// Source   own derivation: F = -c a relative to the centre of mass, c = beta m, solved for a
/// Checked  contract tests; acceleration_damping
template <class Scalar>
class AccelerationDamping final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  AccelerationDamping(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void redistribute_forces(const State<Scalar>& state, Matrix3XRef<Scalar> forces) const override;
  [[nodiscard]] Scalar added_kinetic_energy(const State<Scalar>& state) const override;

 private:
  Scalar beta_;  ///< [-]
  FreeNodes free_;
};

extern template class AccelerationDamping<float>;
extern template class AccelerationDamping<double>;

}  // namespace weft::forces
