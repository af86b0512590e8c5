#include <weft/custom_forces/spring_damping.hpp>

#include <weft/custom_forces/law_input.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/custom_forces/spring_geometry.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kParameters[] = {
    {.name = "damping", .symbol = "c", .unit = "N*s/m", .summary = "damping along the edge"},
};

}  // namespace

template <class Scalar>
const LawInfo SpringDamping<Scalar>::kInfo{
    .id = "spring_damping",
    .summary = "Viscous dampers along edges",
    .formula = "f_i = c ((v_j - v_i) . u) u, f_j = -f_i",
    .source = "dashpot parallel to each spring",
    .traits = {.internal = true, .has_energy = false, .dissipative = true, .uses_edges = true},
    .parameters = kParameters};

template <class Scalar>
SpringDamping<Scalar>::SpringDamping(const LawSpecification& specification, const ClothMesh& mesh)
    : assembly_(law_edges(specification, mesh), mesh.num_nodes()),
      rest_lengths_(
          law_rest_lengths(specification, mesh, assembly_.elements()).template cast<Scalar>()),
      damping_(law_scalar(specification, "damping")) {}

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
  const auto& edges = assembly_.elements();
  const auto kernel = [&](Eigen::Index e, std::array<Vector3<Scalar>, 2>& parts) {
    const int i = edges(0, e);
    const int j = edges(1, e);
    const auto spring =
        spring_geometry<Scalar>(state.positions.col(i), state.positions.col(j), rest_lengths_[e]);
    const Vector3<Scalar> relative = velocity_changes.col(j) - velocity_changes.col(i);
    const Scalar rate = relative.dot(spring.direction);
    parts[0] = (damping_ * rate) * spring.direction;
    parts[1] = -parts[0];
  };
  assembly_.template add<Scalar>(kernel, scratch, product);
}

template <class Scalar>
void SpringDamping<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                                  ConstMatrix3XRef<Scalar> displacements,
                                                  Matrix3XRef<Scalar> scratch,
                                                  Matrix3XRef<Scalar> product) const {
  const auto& edges = assembly_.elements();
  const auto kernel = [&](Eigen::Index e, std::array<Vector3<Scalar>, 2>& parts) {
    const int i = edges(0, e);
    const int j = edges(1, e);
    const auto spring =
        spring_geometry<Scalar>(state.positions.col(i), state.positions.col(j), rest_lengths_[e]);
    if (!spring.has_direction) {
      parts[0].setZero();
      parts[1].setZero();
      return;
    }
    // The direction turns: du = (I - u u^T) (dx_j - dx_i) / l
    const Vector3<Scalar>& u = spring.direction;
    const Vector3<Scalar> change = displacements.col(j) - displacements.col(i);
    const Vector3<Scalar> turn = (change - u.dot(change) * u) / spring.length;
    const Vector3<Scalar> relative = state.velocities.col(j) - state.velocities.col(i);
    parts[0] = damping_ * (relative.dot(turn) * u + relative.dot(u) * turn);
    parts[1] = -parts[0];
  };
  assembly_.template add<Scalar>(kernel, scratch, product);
}

template <class Scalar>
Scalar SpringDamping<Scalar>::non_conservative_power(const State<Scalar>& state) const {
  const auto& edges = assembly_.elements();
  Scalar power(0);
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const int i = edges(0, e);
    const int j = edges(1, e);
    const auto spring =
        spring_geometry<Scalar>(state.positions.col(i), state.positions.col(j), rest_lengths_[e]);
    const Vector3<Scalar> relative = state.velocities.col(j) - state.velocities.col(i);
    const Scalar rate = relative.dot(spring.direction);
    power -= damping_ * rate * rate;
  }
  return power;
}

template class SpringDamping<float>;
template class SpringDamping<double>;
template class SpringDamping<Dual>;

}  // namespace weft::forces
