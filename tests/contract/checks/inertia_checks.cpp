#include "tests/contract/checks/inertia_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <Eigen/Geometry>

#include <weft/core/parallel/threads.hpp>

#include "tests/contract/evaluate.hpp"

namespace weft::contract {
namespace {

ClothMesh with_pins(ClothMesh mesh) {
  mesh.pinned = {0, 7};
  return mesh;
}

bool is_pinned(const ClothMesh& mesh, Eigen::Index node) {
  return std::binary_search(mesh.pinned.begin(), mesh.pinned.end(), static_cast<int>(node));
}

/// A law on a mesh, with one state of it.
template <class Scalar>
struct Setup {
  ClothMesh mesh;
  std::unique_ptr<forces::ForceLaw<Scalar>> law;
  Sample<Scalar> sample;

  Setup(const Subject& subject, ClothMesh on)
      : mesh(std::move(on)),
        law(subject.make<Scalar>(mesh)),
        sample(cast<Scalar>(deformed(mesh, Deformation::kMixed))) {}

  [[nodiscard]] Matrix3X<Scalar> directions(std::uint64_t seed) const {
    return random_directions(mesh.num_nodes(), seed).template cast<Scalar>();
  }
  [[nodiscard]] Matrix3X<Scalar> redistributed(Matrix3X<Scalar> forces) const {
    law->redistribute_forces(sample.state(), forces);
    return forces;
  }
  /// Forces that give these accelerations without the law.
  [[nodiscard]] Matrix3X<Scalar> forces_for(const Matrix3X<Scalar>& accelerations) const {
    return accelerations * sample.masses.asDiagonal();
  }
  [[nodiscard]] double roundoff(double scale) const {
    return contract::roundoff<Scalar>(mesh.num_nodes(), scale);
  }
};

/// A body with two pinned nodes.
template <class Scalar>
Setup<Scalar> pinned_setup(const Subject& subject) {
  return Setup<Scalar>(subject, with_pins(subject.mesh()));
}

/// Random forces along the mesh's edges, equal and opposite at their ends [N].
Matrix3X<double> forces_along_edges(const ClothMesh& mesh, const Matrix3X<double>& positions) {
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, positions.cols());
  for (const EdgeSet& set : mesh.edge_sets) {
    const Matrix3X<double> sizes = random_directions(set.edges.cols(), 41);
    for (Eigen::Index e = 0; e < set.edges.cols(); ++e) {
      const int i = set.edges(0, e);
      const int j = set.edges(1, e);
      const Vector3<double> pull = sizes(0, e) * (positions.col(j) - positions.col(i)).normalized();
      forces.col(i) += pull;
      forces.col(j) -= pull;
    }
  }
  return forces;
}

template <class Scalar>
double sum_of_products(const Matrix3X<Scalar>& a, const Matrix3X<Scalar>& b) {
  return a.template cast<double>().cwiseProduct(b.template cast<double>()).sum();
}

template <class Scalar>
double changed_entries(const Matrix3X<Scalar>& a, const Matrix3X<Scalar>& b) {
  double count = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (std::memcmp(a.data() + i, b.data() + i, sizeof(Scalar)) != 0) ++count;
  }
  return count;
}

}  // namespace

template <class Scalar>
Measurement inertia_adds_nothing(const Subject& subject) {
  const auto setup = pinned_setup<Scalar>(subject);
  const Matrix3X<Scalar> b = setup.directions(3);
  const double size =
      largest(forces_of(*setup.law, setup.sample)) +
      largest(stiffness_product(*setup.law, setup.sample, b)) +
      largest(damping_product(*setup.law, setup.sample, b)) +
      std::abs(static_cast<double>(setup.law->non_conservative_power(setup.sample.state())));
  return {size, 0.0, "|f| + |K b| + |C b| + |P| of an added inertia"};
}

template <class Scalar>
Measurement inertia_is_linear(const Subject& subject) {
  const auto setup = pinned_setup<Scalar>(subject);
  const Matrix3X<Scalar> f = setup.directions(3);
  const Matrix3X<Scalar> g = setup.directions(4);
  const Matrix3X<Scalar> error = setup.redistributed(Scalar(2) * f - g) -
                                 (Scalar(2) * setup.redistributed(f) - setup.redistributed(g));
  return {largest(error), setup.roundoff(1.0), "|R(2 F - G) - 2 R(F) + R(G)| [N]"};
}

template <class Scalar>
Measurement inertia_keeps_the_net_force(const Subject& subject) {
  const auto setup = pinned_setup<Scalar>(subject);
  const Matrix3X<Scalar> before = setup.directions(3);
  const Matrix3X<Scalar> after = setup.redistributed(before);
  Vector3<double> change = Vector3<double>::Zero();
  double pinned_change = 0.0;
  for (Eigen::Index node = 0; node < before.cols(); ++node) {
    const Vector3<double> difference =
        after.col(node).template cast<double>() - before.col(node).template cast<double>();
    if (is_pinned(setup.mesh, node)) {
      pinned_change = std::max(pinned_change, largest(difference));
    } else {
      change += difference;
    }
  }
  return worse({largest(change), setup.roundoff(1.0), "|change of sum F over free nodes| [N]"},
               {pinned_change, 0.0, "|change of a force on a pinned node| [N]"});
}

template <class Scalar>
Measurement inertia_adds_no_torque(const Subject& subject) {
  const Setup<Scalar> setup(subject, subject.mesh());
  const Matrix3X<double> positions = setup.sample.positions.template cast<double>();
  const Matrix3X<double> before = forces_along_edges(setup.mesh, positions);
  const Matrix3X<double> after =
      setup.redistributed(before.template cast<Scalar>()).template cast<double>();
  Vector3<double> torque = Vector3<double>::Zero();
  for (Eigen::Index node = 0; node < after.cols(); ++node) {
    torque += Vector3<double>(positions.col(node)).cross(Vector3<double>(after.col(node)));
  }
  return {largest(torque), setup.roundoff(largest(positions) * largest(before)),
          "|sum x cross R(F)| of torque-free forces [N m]"};
}

template <class Scalar>
Measurement inertia_keeps_uniform_accelerations(const Subject& subject) {
  const auto setup = pinned_setup<Scalar>(subject);
  const Vector3<Scalar> g(Scalar(0.3), Scalar(-1.0), Scalar(0.7));
  const Matrix3X<Scalar> weight = setup.forces_for(g.replicate(1, setup.mesh.num_nodes()));
  return {largest(setup.redistributed(weight) - weight), setup.roundoff(largest(weight)),
          "|R(M g) - M g| [N]"};
}

template <class Scalar>
Measurement inertia_is_symmetric(const Subject& subject) {
  const auto setup = pinned_setup<Scalar>(subject);
  const Matrix3X<Scalar> a = setup.directions(3);
  const Matrix3X<Scalar> b = setup.directions(4);
  const double ab = sum_of_products(a, setup.redistributed(setup.forces_for(b)));
  const double ba = sum_of_products(b, setup.redistributed(setup.forces_for(a)));
  return {std::abs(ab - ba), setup.roundoff(static_cast<double>(setup.sample.masses.sum())),
          "|a.R(Mb) - b.R(Ma)|"};
}

template <class Scalar>
Measurement inertia_is_positive(const Subject& subject) {
  const auto setup = pinned_setup<Scalar>(subject);
  double least = std::numeric_limits<double>::infinity();
  const auto look_at = [&](const Matrix3X<Scalar>& a) {
    const Matrix3X<Scalar> forces = setup.forces_for(a);
    least = std::min(least,
                     sum_of_products(a, setup.redistributed(forces)) / sum_of_products(a, forces));
  };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) look_at(setup.directions(seed));
  look_at(setup.sample.positions);
  look_at(Matrix3X<Scalar>::Ones(3, setup.mesh.num_nodes()));
  return {-least, -setup.roundoff(1.0), "-a.R(Ma) / a.Ma, largest"};
}

Measurement inertia_balances_its_energy(const Subject& subject) {
  const auto setup = pinned_setup<double>(subject);
  Sample<double> sample = setup.sample;
  const Matrix3X<double> force = setup.directions(3);
  Matrix3X<double> change = setup.redistributed(force) * sample.masses.cwiseInverse().asDiagonal();
  for (const int node : setup.mesh.pinned) {
    sample.velocities.col(node).setZero();
    change.col(node).setZero();
  }
  const Matrix3X<double> v = sample.velocities;
  const auto added = [&](double sign) {
    sample.velocities = v + sign * change;
    return setup.law->added_kinetic_energy(sample.state());
  };
  // The energy is a quadratic form, for which this difference is the derivative.
  const double gain =
      v.cwiseProduct(change * sample.masses.asDiagonal()).sum() + 0.5 * (added(1) - added(-1));
  const double power = v.cwiseProduct(force).sum();
  const double scale = largest(v) * largest(force) + added(1) + added(-1);
  return {std::abs(gain - power), setup.roundoff(scale), "|F.v - d(E_kin)/dt| [W]"};
}

template <class Scalar>
Measurement inertia_repeats_bit_for_bit(const Subject& subject) {
  const Setup<Scalar> setup(subject, with_pins(subject.large_mesh()));
  const Matrix3X<Scalar> forces = setup.directions(3);
  const auto with = [&](int threads) {
    return with_threads(threads, [&] { return setup.redistributed(forces); });
  };
  const Matrix3X<Scalar> first = with(1);
  return {changed_entries(first, with(1)) + changed_entries(first, with(4)), 0.0,
          "entries that change when repeated"};
}

Measurement inertia_in_float_agrees_with_double(const Subject& subject) {
  const auto coarse = pinned_setup<float>(subject);
  const auto fine = pinned_setup<double>(subject);
  const Matrix3X<float> forces = coarse.directions(3);
  const Matrix3X<double> error =
      coarse.redistributed(forces).cast<double>() - fine.redistributed(forces.cast<double>());
  return {largest(error), coarse.roundoff(1.0), "float - double: redistributed force [N]"};
}

template <class Scalar>
Measurement redistribution_changes_nothing(const Subject& subject) {
  const Setup<Scalar> setup(subject, subject.mesh());
  const Matrix3X<Scalar> forces = setup.directions(3);
  const double energy =
      std::abs(static_cast<double>(setup.law->added_kinetic_energy(setup.sample.state())));
  return {changed_entries(forces, setup.redistributed(forces)) + energy, 0.0,
          "changed entries + |added kinetic energy|"};
}

#define WEFT_INSTANTIATE(Scalar)                                                    \
  template Measurement inertia_adds_nothing<Scalar>(const Subject&);                \
  template Measurement inertia_is_linear<Scalar>(const Subject&);                   \
  template Measurement inertia_keeps_the_net_force<Scalar>(const Subject&);         \
  template Measurement inertia_adds_no_torque<Scalar>(const Subject&);              \
  template Measurement inertia_keeps_uniform_accelerations<Scalar>(const Subject&); \
  template Measurement inertia_is_symmetric<Scalar>(const Subject&);                \
  template Measurement inertia_is_positive<Scalar>(const Subject&);                 \
  template Measurement inertia_repeats_bit_for_bit<Scalar>(const Subject&);         \
  template Measurement redistribution_changes_nothing<Scalar>(const Subject&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft::contract
