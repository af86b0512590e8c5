#include <weft/custom_forces/laws/damping/velocity_damping.hpp>

#include <cmath>

#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kVelocityDampingParameters[] = {
    {.name = "rate", .symbol = "gamma", .unit = "1/s", .summary = "decay rate of the velocity"},
};

}  // namespace

template <class Scalar>
const LawInfo VelocityDamping<Scalar>::kInfo{
    .id = "velocity_damping",
    .summary = "Proportional loss of velocity, as in still air without area",
    .formula = "f = -gamma m v",
    .source = "de Joya 2011: damping as a proportional velocity loss",
    .checked_by = "cases oscillator, damped_hang; tests VelocityDamping.*",
    .traits = {.free_at_rest = true,
               .dissipative = true,
               .is_pointwise = true,
               .level = LawTraits::Level::kVelocity},
    .parameters = kVelocityDampingParameters};

template <class Scalar>
VelocityDamping<Scalar>::VelocityDamping(const LawSpecification& specification, const ClothMesh&)
    : rate_(law_scalar(specification, "rate")) {}

template <class Scalar>
void VelocityDamping<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                                         Matrix3XRef<Scalar> forces) const {
  add_damping_product(state, state.velocities, scratch, forces);  // the law is linear in v
}

template <class Scalar>
void VelocityDamping<Scalar>::add_damping_product(const State<Scalar>& state,
                                                  ConstMatrix3XRef<Scalar> velocity_changes,
                                                  Matrix3XRef<Scalar> /*scratch*/,
                                                  Matrix3XRef<Scalar> product) const {
  for (Eigen::Index node = 0; node < product.cols(); ++node) {
    product.col(node) -= (rate_ * state.masses[node]) * velocity_changes.col(node);
  }
}

template <class Scalar>
Scalar VelocityDamping<Scalar>::non_conservative_power(const State<Scalar>& state) const {
  Scalar power(0);
  for (Eigen::Index node = 0; node < state.velocities.cols(); ++node) {
    power -= rate_ * state.masses[node] * state.velocities.col(node).squaredNorm();
  }
  return power;
}

template <class Scalar>
void VelocityDamping<Scalar>::advance_velocities(const State<Scalar>& /*state*/, Scalar time_step,
                                                 Matrix3XRef<Scalar> velocities) const {
  using std::exp;
  const Scalar factor = exp(Scalar(-rate_ * time_step));
  velocities *= factor;
}

WEFT_INSTANTIATE_LAW(VelocityDamping);

}  // namespace weft::forces
