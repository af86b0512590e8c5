#include <weft/custom_forces/laws/elastic/tension.hpp>

#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kTensionParameters[] = {
    {.name = "stiffness", .symbol = "k", .unit = "N/m", .summary = "spring stiffness"},
    {.name = "compression_ratio",
     .symbol = "ratio",
     .unit = "1",
     .summary = "stiffness under compression over stiffness under tension; 0 goes slack",
     .required = false,
     .default_value = 1.0,
     .maximum = 1.0},
};

}  // namespace

template <class Scalar>
const LawInfo Tension<Scalar>::kInfo{
    .id = "tension",
    .summary = "Linear springs along edges",
    .formula =
        "f_i = k' (l - l0) u, f_j = -f_i, E = k' (l - l0)^2 / 2, "
        "k' = k if l >= l0, else ratio k",
    .source = "Werth 2008: tension constant times (length minus rest length)",
    .checked_by = "cases hanging_chain, oscillator; tests Tension.*",
    .traits = {.internal = true,
               .ignores_rigid_motion = true,
               .free_at_rest = true,
               .has_energy = true,
               .elements = ElementKind::kEdges,
               .role = LawRole::kSpring},
    .parameters = kTensionParameters};

template <class Scalar>
Tension<Scalar>::Tension(const LawSpecification& specification, const ClothMesh& mesh)
    : springs_(specification, mesh) {
  const double stiffness = law_scalar(specification, "stiffness");
  stiffness_.stretched = Scalar(stiffness);
  stiffness_.compressed = Scalar(law_scalar(specification, "compression_ratio") * stiffness);
}

template <class Scalar>
void Tension<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                                 Matrix3XRef<Scalar> forces) const {
  const auto force = [stiffness = stiffness_](const Spring<Scalar>& spring) -> PlainVector<Scalar> {
    const Scalar extension = spring.extension();
    return Scalar(stiffness.at(extension) * extension) * spring.direction;
  };
  springs_.add_pairs(state, force, scratch, forces);
}

template <class Scalar>
void Tension<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                            ConstMatrix3XRef<Scalar> displacements,
                                            Matrix3XRef<Scalar> scratch,
                                            Matrix3XRef<Scalar> product) const {
  const auto force_change = [stiffness = stiffness_](
                                const Spring<Scalar>& spring,
                                const PlainVector<Scalar>& change) -> PlainVector<Scalar> {
    // df_i = k [u u^T + (1 - l0/l) (I - u u^T)] (dx_j - dx_i); u = 0, 1/l = 0 if l is too short
    const Scalar along = spring.direction.dot(change);
    const Scalar across_ratio = spring.extension() * spring.inverse_length;
    return stiffness.at(spring.extension()) *
           (across_ratio * change + Scalar((Scalar(1) - across_ratio) * along) * spring.direction);
  };
  springs_.add_pairs(state, force_change, scratch, product, displacements);
}

template <class Scalar>
Scalar Tension<Scalar>::potential_energy(const State<Scalar>& state) const {
  return springs_.sum(state, [&](const Spring<Scalar>& spring) -> Scalar {
    const Scalar extension = spring.extension();
    return Scalar(0.5) * stiffness_.at(extension) * extension * extension;
  });
}

WEFT_INSTANTIATE_LAW(Tension);

}  // namespace weft::forces
