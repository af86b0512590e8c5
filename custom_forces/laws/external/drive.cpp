#include <weft/custom_forces/laws/external/drive.hpp>

#include <Eigen/Geometry>

#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kDriveParameters[] = {
    {.name = "stiffness",
     .symbol = "k",
     .unit = "N/m",
     .summary = "pull of each node towards its target"},
    {.name = "damping",
     .symbol = "c",
     .unit = "N*s/m",
     .summary = "pull of each node's velocity towards that of its target",
     .required = false},
    {.name = "displacement",
     .symbol = "d",
     .unit = "m",
     .summary = "of the targets from the rest shape, from the start on",
     .size = 3,
     .required = false},
    {.name = "velocity",
     .symbol = "u",
     .unit = "m/s",
     .summary = "of the targets",
     .size = 3,
     .required = false},
    {.name = "angular_velocity",
     .symbol = "omega",
     .unit = "rad/s",
     .summary = "of the targets about the mean position of all nodes of the law",
     .size = 3,
     .required = false},
};

}  // namespace

template <class Scalar>
const LawInfo Drive<Scalar>::kInfo{
    .id = "drive",
    .summary = "Nodes that follow a given motion, as a hand leads them",
    .formula =
        "f = k (x_t - x) + c (v_t - v), x_t = x_c + d + u t + R(omega t) (x0 - x_c), "
        "v_t = u + omega x R (x0 - x_c)",
    .source = "proportional-derivative control of positions",
    .checked_by = "tests Drive.*",
    .traits = {.elements = ElementKind::kNodeSets},
    .parameters = kDriveParameters};

template <class Scalar>
Drive<Scalar>::Drive(const LawSpecification& specification, const ClothMesh& mesh)
    : nodes_(law_nodes(specification, mesh)),
      arms_(3, static_cast<Eigen::Index>(nodes_.size())),
      start_(law_vector(specification, "displacement")),
      velocity_(law_vector(specification, "velocity")),
      angular_velocity_(law_vector(specification, "angular_velocity")),
      stiffness_(law_scalar(specification, "stiffness")),
      damping_(law_scalar(specification, "damping")) {
  if (nodes_.empty()) return;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    arms_.col(static_cast<Eigen::Index>(i)) = mesh.rest_positions.col(nodes_[i]);
  }
  const Vector3<double> center = arms_.rowwise().mean();
  arms_.colwise() -= center;
  start_ += center;
}

template <class Scalar>
template <class Visit>
void Drive<Scalar>::for_each_force(const State<Scalar>& state, const Visit& visit) const {
  const double rate = angular_velocity_.norm();
  Matrix3<double> turn = Matrix3<double>::Identity();
  if (rate > 0) turn = Eigen::AngleAxisd(rate * state.time, angular_velocity_ / rate);
  const Vector3<double> center = start_ + velocity_ * state.time;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const int node = nodes_[i];
    const Vector3<double> arm = turn * arms_.col(static_cast<Eigen::Index>(i));
    const Vector3<double> target = center + arm;
    const Vector3<double> target_velocity = velocity_ + angular_velocity_.cross(arm);
    const Vector3<Scalar> x = state.positions.col(node);
    const Vector3<Scalar> v = state.velocities.col(node);
    const Vector3<Scalar> force =
        stiffness_ * Vector3<Scalar>(target.template cast<Scalar>() - x) +
        damping_ * Vector3<Scalar>(target_velocity.template cast<Scalar>() - v);
    visit(node, force);
  }
}

template <class Scalar>
void Drive<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> /*scratch*/,
                               Matrix3XRef<Scalar> forces) const {
  for_each_force(state, [&](int node, const Vector3<Scalar>& force) { forces.col(node) += force; });
}

template <class Scalar>
void Drive<Scalar>::add_stiffness_product(const State<Scalar>& /*state*/,
                                          ConstMatrix3XRef<Scalar> displacements,
                                          Matrix3XRef<Scalar> /*scratch*/,
                                          Matrix3XRef<Scalar> product) const {
  for (const int node : nodes_) product.col(node) -= stiffness_ * displacements.col(node);
}

template <class Scalar>
void Drive<Scalar>::add_damping_product(const State<Scalar>& /*state*/,
                                        ConstMatrix3XRef<Scalar> velocity_changes,
                                        Matrix3XRef<Scalar> /*scratch*/,
                                        Matrix3XRef<Scalar> product) const {
  for (const int node : nodes_) product.col(node) -= damping_ * velocity_changes.col(node);
}

template <class Scalar>
Scalar Drive<Scalar>::non_conservative_power(const State<Scalar>& state) const {
  Scalar power(0);
  for_each_force(state, [&](int node, const Vector3<Scalar>& force) {
    power += force.dot(Vector3<Scalar>(state.velocities.col(node)));
  });
  return power;
}

WEFT_INSTANTIATE_LAW(Drive);

}  // namespace weft::forces
