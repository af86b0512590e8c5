#include <weft/custom_forces/laws/damping/spring_damping.hpp>

#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kSpringDampingParameters[] = {
    {.name = "damping", .symbol = "c", .unit = "N*s/m", .summary = "damping along the edge"},
};

}  // namespace

template <class Scalar>
const LawInfo SpringDamping<Scalar>::kInfo{.id = "spring_damping",
                                           .summary = "Viscous dampers along edges",
                                           .formula = "f_i = c ((v_j - v_i) . u) u, f_j = -f_i",
                                           .source = "dashpot parallel to each spring",
                                           .checked_by =
                                               "cases oscillator, rotation_damping (a spinning "
                                               "ring keeps its spin); tests SpringDamping.*",
                                           .traits = {.internal = true,
                                                      .ignores_rigid_motion = true,
                                                      .free_at_rest = true,
                                                      .dissipative = true,
                                                      .elements = ElementKind::kEdges,
                                                      .role = LawRole::kSpringDamper},
                                           .parameters = kSpringDampingParameters};

template <class Scalar>
SpringDamping<Scalar>::SpringDamping(const LawSpecification& specification, const ClothMesh& mesh)
    : springs_(specification, mesh), damping_(law_scalar(specification, "damping")) {}

template <class Scalar>
void SpringDamping<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                                       Matrix3XRef<Scalar> forces) const {
  add_damping_product(state, state.velocities, scratch, forces);  // the law is linear in v
}

template <class Scalar>
void SpringDamping<Scalar>::add_damping_product(const State<Scalar>& state,
                                                ConstMatrix3XRef<Scalar> velocity_changes,
                                                Matrix3XRef<Scalar> scratch,
                                                Matrix3XRef<Scalar> product) const {
  const auto force = [damping = damping_](
                         const Spring<Scalar>& spring,
                         const PlainVector<Scalar>& relative) -> PlainVector<Scalar> {
    return Scalar(damping * relative.dot(spring.direction)) * spring.direction;
  };
  springs_.add_pairs(state, force, scratch, product, velocity_changes);
}

template <class Scalar>
void SpringDamping<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                                  ConstMatrix3XRef<Scalar> displacements,
                                                  Matrix3XRef<Scalar> scratch,
                                                  Matrix3XRef<Scalar> product) const {
  const auto force_change = [damping = damping_](
                                const Spring<Scalar>& spring, const PlainVector<Scalar>& change,
                                const PlainVector<Scalar>& relative) -> PlainVector<Scalar> {
    // The direction turns: du = (I - u u^T) (dx_j - dx_i) / l
    const PlainVector<Scalar>& u = spring.direction;
    const PlainVector<Scalar> turn = spring.inverse_length * (change - u.dot(change) * u);
    return damping * (relative.dot(turn) * u + relative.dot(u) * turn);
  };
  springs_.add_pairs(state, force_change, scratch, product, displacements, state.velocities);
}

template <class Scalar>
Scalar SpringDamping<Scalar>::non_conservative_power(const State<Scalar>& state) const {
  const auto power = [damping = damping_](const Spring<Scalar>& spring,
                                          const PlainVector<Scalar>& relative) -> Scalar {
    const Scalar rate = relative.dot(spring.direction);
    return damping * rate * rate;
  };
  return -springs_.sum(state, power, state.velocities);
}

WEFT_INSTANTIATE_LAW(SpringDamping);

}  // namespace weft::forces
