#include "tests/contract/checks/invariance_checks.hpp"

#include <Eigen/Geometry>

#include "tests/contract/evaluate.hpp"

namespace weft::contract {
namespace {

// Sums are taken in double, so that only the law's own rounding is measured.
Vector3<double> torque_of(const Matrix3X<double>& positions, const Matrix3X<double>& forces) {
  Vector3<double> torque = Vector3<double>::Zero();
  for (Eigen::Index node = 0; node < forces.cols(); ++node) {
    torque += Vector3<double>(positions.col(node)).cross(Vector3<double>(forces.col(node)));
  }
  return torque;
}

template <class Scalar, class Check>
Measurement worst_over_deformations(const Subject& subject, const Check& check) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<Scalar>(mesh);
  Measurement worst = check(*law, cast<Scalar>(at_rest(mesh)));
  for (const Deformation deformation : kDeformations) {
    worst = worse(worst, check(*law, cast<Scalar>(deformed(mesh, deformation))));
  }
  return worst;
}

}  // namespace

template <class Scalar>
Measurement net_force_is_zero(const Subject& subject) {
  const auto check = [](const auto& law, const Sample<Scalar>& sample) -> Measurement {
    const Matrix3X<double> force = forces_of(law, sample).template cast<double>();
    return {largest(force.rowwise().sum()),
            roundoff<Scalar>(sample.num_nodes(), force_scale(law, sample)), "|sum f| [N]"};
  };
  return worst_over_deformations<Scalar>(subject, check);
}

template <class Scalar>
Measurement net_torque_is_zero(const Subject& subject) {
  const auto check = [](const auto& law, const Sample<Scalar>& sample) -> Measurement {
    const Matrix3X<double> force = forces_of(law, sample).template cast<double>();
    const Matrix3X<double> positions = sample.positions.template cast<double>();
    const double scale = force_scale(law, sample) * largest(sample.positions);
    return {largest(torque_of(positions, force)), roundoff<Scalar>(sample.num_nodes(), scale),
            "|sum x cross f| [N m]"};
  };
  return worst_over_deformations<Scalar>(subject, check);
}

template <class Scalar>
Measurement force_turns_with_the_body(const Subject& subject) {
  const RigidPlacement placement = oblique_placement();
  const auto check = [&](const auto& law, const Sample<Scalar>& sample) -> Measurement {
    const Sample<Scalar> moved = cast<Scalar>(placed(cast<double>(sample), placement));
    const Matrix3X<double> expected =
        placement.rotation * forces_of(law, sample).template cast<double>();
    const Matrix3X<double> found = forces_of(law, moved).template cast<double>();
    const double scale = force_scale(law, sample) + force_scale(law, moved);
    return {largest(found - expected), roundoff<Scalar>(sample.num_nodes(), scale),
            "|f(Rx + t, Rv) - R f(x, v)| [N]"};
  };
  return worst_over_deformations<Scalar>(subject, check);
}

template <class Scalar>
Measurement rigid_motion_adds_no_force(const Subject& subject) {
  const auto check = [](const auto& law, Sample<Scalar> sample) -> Measurement {
    sample.velocities.setZero();
    const Matrix3X<Scalar> standing = forces_of(law, sample);
    sample.velocities =
        rigid_velocities(sample.positions.template cast<double>()).template cast<Scalar>();
    const Matrix3X<Scalar> moving = forces_of(law, sample);
    return {largest(moving - standing),
            roundoff<Scalar>(sample.num_nodes(), force_scale(law, sample)),
            "|f(x, omega x r + v0) - f(x, 0)| [N]"};
  };
  return worst_over_deformations<Scalar>(subject, check);
}

template <class Scalar>
Measurement rest_shape_is_free_of_force(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<Scalar>(mesh);
  const Sample<Scalar> sample = cast<Scalar>(at_rest(mesh));
  return {largest(forces_of(*law, sample)),
          roundoff<Scalar>(sample.num_nodes(), force_scale(*law, sample)),
          "|f| at the rest shape [N]"};
}

#define WEFT_INSTANTIATE(Scalar)                                           \
  template Measurement net_force_is_zero<Scalar>(const Subject&);          \
  template Measurement net_torque_is_zero<Scalar>(const Subject&);         \
  template Measurement force_turns_with_the_body<Scalar>(const Subject&);  \
  template Measurement rigid_motion_adds_no_force<Scalar>(const Subject&); \
  template Measurement rest_shape_is_free_of_force<Scalar>(const Subject&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft::contract
