#pragma once

#include <weft/custom_forces/assembly/element_force.hpp>
#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// Gas in a closed mesh at one temperature: its pressure times its volume never changes.
///
///   p = p0 (V0 + V_r) / (V + V_r) - p_a      f = p dV/dx
///   E = -p0 (V0 + V_r) ln((V + V_r) / (V0 + V_r)) + p_a (V - V0)
///   V, V0  volume that the mesh encloses now and at rest
///
/// Each face carries p times its area, a third on each node: for a closed surface that is p dV/dx.
/// Below kMinVolumeRatio of V0 the pressure stays what it is there and the energy goes on linearly,
/// so that a mesh that is crushed flat or turned inside out feels large but finite forces outward.
/// A reservoir makes the gas softer; one far larger than V0 keeps the pressure constant.
///
/// Symbols  p0   pressure          [Pa]  >= 0, of the gas at the rest volume
///          p_a  outside_pressure  [Pa]  >= 0, default 0
///          V_r  reservoir_volume  [m^3] >= 0, default 0, of gas that is not in the mesh
/// Errors   InvalidArgument at construction for a surface that is not closed and for one that
///          encloses no volume > 0 at rest, as when its faces look inward
/// Source   Boyle's law
/// Checked  contract tests; balloon
template <class Scalar>
class Pressure final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  Pressure(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  [[nodiscard]] Eigen::Index scratch_columns() const override { return faces_.scratch_columns(); }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  [[nodiscard]] Scalar potential_energy(const State<Scalar>& state) const override;

  /// V [m^3], summed in the order of the faces on one thread: the same bits on any machine.
  [[nodiscard]] Scalar volume(const State<Scalar>& state) const;

  /// Volume below which the pressure no longer rises, as a fraction of V0 [-].
  static constexpr double kMinVolumeRatio = 0.01;

 private:
  /// p [Pa] at a volume, and dp/dV [Pa/m^3].
  struct Gas {
    Scalar pressure;
    Scalar slope;
  };
  [[nodiscard]] Gas gas_at(const Scalar& volume) const;

  ElementForce<Scalar, 3> faces_;
  Scalar outside_pressure_;  ///< p_a [Pa]
  Scalar reservoir_;         ///< V_r [m^3]
  Scalar rest_volume_;       ///< V0 [m^3]
  Scalar smallest_volume_;   ///< kMinVolumeRatio V0 [m^3]
  Scalar amount_;            ///< p0 (V0 + V_r) [J]
};

extern template class Pressure<float>;
extern template class Pressure<double>;

}  // namespace weft::forces
