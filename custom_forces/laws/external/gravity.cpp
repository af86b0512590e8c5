#include <weft/custom_forces/laws/external/gravity.hpp>

#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kGravityParameters[] = {
    {.name = "acceleration",
     .symbol = "g",
     .unit = "m/s^2",
     .summary = "acceleration of free fall",
     .size = 3},
};

}  // namespace

template <class Scalar>
const LawInfo Gravity<Scalar>::kInfo{
    .id = "gravity",
    .summary = "Uniform gravity",
    .formula = "f = m g, E = -m g . x",
    .source = "uniform field",
    .checked_by = "cases hanging_chain, drape_sphere; tests Gravity.*",
    .traits = {.ignores_rigid_motion = true,
               .has_energy = true,
               .is_pointwise = true,
               .role = LawRole::kGravity},
    .parameters = kGravityParameters};

template <class Scalar>
Gravity<Scalar>::Gravity(const LawSpecification& specification, const ClothMesh&)
    : acceleration_(law_vector(specification, "acceleration").template cast<Scalar>()) {}

template <class Scalar>
void Gravity<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> /*scratch*/,
                                 Matrix3XRef<Scalar> forces) const {
  for (Eigen::Index node = 0; node < forces.cols(); ++node) {
    forces.col(node) += state.masses[node] * acceleration_;
  }
}

template <class Scalar>
Scalar Gravity<Scalar>::potential_energy(const State<Scalar>& state) const {
  Scalar energy(0);
  for (Eigen::Index node = 0; node < state.positions.cols(); ++node) {
    energy -= state.masses[node] * acceleration_.dot(state.positions.col(node));
  }
  return energy;
}

WEFT_INSTANTIATE_LAW(Gravity);

}  // namespace weft::forces
