#include <weft/custom_forces/laws/damping/acceleration_damping.hpp>

#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>
#include <weft/custom_forces/laws/damping/body_motion.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kAccelerationDampingParameters[] = {
    {.name = "beta", .symbol = "beta", .unit = "1", .summary = "added inertia over mass"},
};

}  // namespace

template <class Scalar>
const LawInfo AccelerationDamping<Scalar>::kInfo{
    .id = "acceleration_damping",
    .summary = "Accelerations relative to the centre of mass are divided by 1 + beta",
    .formula = "f <- m (a_c + (f / m - a_c) / (1 + beta)), a_c = sum f / sum m",
    .source = "own derivation: a force against the acceleration, solved for the acceleration",
    .checked_by = "cases acceleration_damping, damped_hang; tests AccelerationDamping.*",
    .traits = {.internal = true,
               .ignores_rigid_motion = true,
               .free_at_rest = true,
               .level = LawTraits::Level::kInertia},
    .parameters = kAccelerationDampingParameters};

template <class Scalar>
AccelerationDamping<Scalar>::AccelerationDamping(const LawSpecification& specification,
                                                 const ClothMesh& mesh)
    : beta_(static_cast<Scalar>(law_scalar(specification, "beta"))), free_(mesh) {}

template <class Scalar>
void AccelerationDamping<Scalar>::add_forces(const State<Scalar>& /*state*/,
                                             Matrix3XRef<Scalar> /*scratch*/,
                                             Matrix3XRef<Scalar> /*forces*/) const {}

template <class Scalar>
void AccelerationDamping<Scalar>::redistribute_forces(const State<Scalar>& state,
                                                      Matrix3XRef<Scalar> forces) const {
  using Number = Wide<Scalar>;
  const std::vector<int>& free = free_.of(forces.cols());
  if (free.empty()) return;
  Number mass(0);
  Vector3<Number> force = Vector3<Number>::Constant(Number(0));
  for (const int node : free) {
    mass += Number(state.masses[node]);
    force += forces.col(node).template cast<Number>();
  }
  const Number kept = Number(1) / (Number(1) + Number(beta_));
  const Vector3<Number> shared = force * Number((Number(1) - kept) / mass);
  for (const int node : free) {
    const Vector3<Number> own = forces.col(node).template cast<Number>();
    const Vector3<Number> result = kept * own + Number(state.masses[node]) * shared;
    forces.col(node) = result.template cast<Scalar>();
  }
}

template <class Scalar>
Scalar AccelerationDamping<Scalar>::added_kinetic_energy(const State<Scalar>& state) const {
  using Number = Wide<Scalar>;
  const BodyNodes<Scalar> nodes{state, free_.of(state.positions.cols()), state.velocities};
  if (nodes.free.empty()) return Scalar(0);
  Number mass(0);
  Vector3<Number> mean = Vector3<Number>::Constant(Number(0));
  for (const int node : nodes.free) {
    mass += nodes.mass(node);
    mean += nodes.mass(node) * nodes.velocity(node);
  }
  mean /= mass;
  Number sum(0);
  for (const int node : nodes.free) {
    sum += nodes.mass(node) * Vector3<Number>(nodes.velocity(node) - mean).squaredNorm();
  }
  return static_cast<Scalar>(Number(0.5) * Number(beta_) * sum);
}

WEFT_INSTANTIATE_LAW(AccelerationDamping);

}  // namespace weft::forces
