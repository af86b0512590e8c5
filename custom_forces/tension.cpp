#include <weft/custom_forces/tension.hpp>

#include <weft/custom_forces/law_input.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/custom_forces/spring_geometry.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kParameters[] = {
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
    .traits = {.internal = true, .has_energy = true, .uses_edges = true},
    .parameters = kParameters};

template <class Scalar>
Tension<Scalar>::Tension(const LawSpecification& specification, const ClothMesh& mesh)
    : assembly_(law_edges(specification, mesh), mesh.num_nodes()),
      rest_lengths_(
          law_rest_lengths(specification, mesh, assembly_.elements()).template cast<Scalar>()),
      stiffness_(law_scalar(specification, "stiffness")),
      compression_ratio_(law_scalar(specification, "compression_ratio")) {}

template <class Scalar>
void Tension<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                                 Matrix3XRef<Scalar> forces) const {
  const auto& edges = assembly_.elements();
  const auto kernel = [&](Eigen::Index e, std::array<Vector3<Scalar>, 2>& parts) {
    const auto spring = spring_geometry<Scalar>(state.positions.col(edges(0, e)),
                                                state.positions.col(edges(1, e)), rest_lengths_[e]);
    const Scalar extension = spring.length - rest_lengths_[e];
    parts[0] = (stiffness_at(extension) * extension) * spring.direction;
    parts[1] = -parts[0];
  };
  assembly_.template add<Scalar>(kernel, scratch, forces);
}

template <class Scalar>
void Tension<Scalar>::add_stiffness_product(const State<Scalar>& state,
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
    // df_i = k [u u^T + (1 - l0/l) (I - u u^T)] (dx_j - dx_i)
    const Vector3<Scalar> change = displacements.col(j) - displacements.col(i);
    const Scalar along = spring.direction.dot(change);
    const Scalar extension = spring.length - rest_lengths_[e];
    const Scalar across_ratio = extension / spring.length;
    const Scalar stiffness = stiffness_at(extension);
    parts[0] = stiffness *
               (across_ratio * change + ((Scalar(1) - across_ratio) * along) * spring.direction);
    parts[1] = -parts[0];
  };
  assembly_.template add<Scalar>(kernel, scratch, product);
}

template <class Scalar>
Scalar Tension<Scalar>::potential_energy(const State<Scalar>& state) const {
  const auto& edges = assembly_.elements();
  Scalar energy(0);
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const auto spring = spring_geometry<Scalar>(state.positions.col(edges(0, e)),
                                                state.positions.col(edges(1, e)), rest_lengths_[e]);
    const Scalar extension = spring.length - rest_lengths_[e];
    energy += Scalar(0.5) * stiffness_at(extension) * extension * extension;
  }
  return energy;
}

template class Tension<float>;
template class Tension<double>;
template class Tension<Dual>;

}  // namespace weft::forces
