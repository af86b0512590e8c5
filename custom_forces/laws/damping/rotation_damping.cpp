#include <weft/custom_forces/laws/damping/rotation_damping.hpp>

#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kRotationDampingParameters[] = {
    {.name = "rate",
     .symbol = "rate",
     .unit = "1/s",
     .summary = "decay rate of the angular momentum, 1 / time constant"},
};

}  // namespace

template <class Scalar>
const LawInfo RotationDamping<Scalar>::kInfo{
    .id = "rotation_damping",
    .summary = "Rotation of the body as a whole decays",
    .formula = "f = -m rate omega x r, omega = I^-1 L about the centre of mass",
    .source = "own derivation: a torque against the angular momentum, shared out as a rigid motion",
    .checked_by = "cases rotation_damping, damped_hang; tests RotationDamping.*",
    .traits = {.free_at_rest = true, .dissipative = true, .level = LawTraits::Level::kVelocity},
    .parameters = kRotationDampingParameters};

template <class Scalar>
RotationDamping<Scalar>::RotationDamping(const LawSpecification& specification,
                                         const ClothMesh& mesh)
    : damping_(law_scalar(specification, "rate"), mesh) {}

template <class Scalar>
void RotationDamping<Scalar>::add_forces(const State<Scalar>& state,
                                         Matrix3XRef<Scalar> /*scratch*/,
                                         Matrix3XRef<Scalar> forces) const {
  damping_.subtract(state, state.velocities, forces);
}

template <class Scalar>
void RotationDamping<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                                    ConstMatrix3XRef<Scalar> displacements,
                                                    Matrix3XRef<Scalar> /*scratch*/,
                                                    Matrix3XRef<Scalar> product) const {
  damping_.subtract_derivative(state, displacements, product);
}

template <class Scalar>
void RotationDamping<Scalar>::add_damping_product(const State<Scalar>& state,
                                                  ConstMatrix3XRef<Scalar> velocity_changes,
                                                  Matrix3XRef<Scalar> /*scratch*/,
                                                  Matrix3XRef<Scalar> product) const {
  damping_.subtract(state, velocity_changes, product);  // the law is linear in v
}

template <class Scalar>
Scalar RotationDamping<Scalar>::non_conservative_power(const State<Scalar>& state) const {
  return damping_.power(state);
}

template <class Scalar>
void RotationDamping<Scalar>::advance_velocities(const State<Scalar>& state, Scalar time_step,
                                                 Matrix3XRef<Scalar> velocities) const {
  damping_.advance(state, time_step, velocities);
}

WEFT_INSTANTIATE_LAW(RotationDamping);

}  // namespace weft::forces
