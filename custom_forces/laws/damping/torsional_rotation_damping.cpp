#include <weft/custom_forces/laws/damping/torsional_rotation_damping.hpp>

#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kTorsionalRotationDampingParameters[] = {
    {.name = "rate",
     .symbol = "rate",
     .unit = "1/s",
     .summary = "decay rate of the swirl, 1 / time constant"},
};

}  // namespace

template <class Scalar>
const LawInfo TorsionalRotationDamping<Scalar>::kInfo{
    .id = "torsional_rotation_damping",
    .summary = "Swirl about the centre of mass that is not rigid rotation decays",
    .formula = "f = -M rate Pi v, Pi v = v without radial motion, translations and rigid rotations",
    .source = "own derivation: the orthogonal projector in the inner product of the masses",
    .checked_by = "cases rotation_damping, damped_hang; tests TorsionalRotationDamping.*",
    .traits = {.internal = true,
               .ignores_rigid_motion = true,
               .free_at_rest = true,
               .dissipative = true,
               .level = LawTraits::Level::kVelocity},
    .parameters = kTorsionalRotationDampingParameters};

template <class Scalar>
TorsionalRotationDamping<Scalar>::TorsionalRotationDamping(const LawSpecification& specification,
                                                           const ClothMesh& mesh)
    : damping_(law_scalar(specification, "rate"), mesh) {}

template <class Scalar>
void TorsionalRotationDamping<Scalar>::add_forces(const State<Scalar>& state,
                                                  Matrix3XRef<Scalar> /*scratch*/,
                                                  Matrix3XRef<Scalar> forces) const {
  damping_.subtract(state, state.velocities, forces);
}

template <class Scalar>
void TorsionalRotationDamping<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                                             ConstMatrix3XRef<Scalar> displacements,
                                                             Matrix3XRef<Scalar> /*scratch*/,
                                                             Matrix3XRef<Scalar> product) const {
  damping_.subtract_derivative(state, displacements, product);
}

template <class Scalar>
void TorsionalRotationDamping<Scalar>::add_damping_product(
    const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocity_changes,
    Matrix3XRef<Scalar> /*scratch*/, Matrix3XRef<Scalar> product) const {
  damping_.subtract(state, velocity_changes, product);  // the law is linear in v
}

template <class Scalar>
Scalar TorsionalRotationDamping<Scalar>::non_conservative_power(const State<Scalar>& state) const {
  return damping_.power(state);
}

template <class Scalar>
void TorsionalRotationDamping<Scalar>::advance_velocities(const State<Scalar>& state,
                                                          Scalar time_step,
                                                          Matrix3XRef<Scalar> velocities) const {
  damping_.advance(state, time_step, velocities);
}

WEFT_INSTANTIATE_LAW(TorsionalRotationDamping);

}  // namespace weft::forces
