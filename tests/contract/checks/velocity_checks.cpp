#include "tests/contract/checks/velocity_checks.hpp"

#include "tests/contract/evaluate.hpp"

namespace weft::contract {
namespace {

constexpr double kTimeStep = 0.5;  // [s]

Matrix3X<double> acceleration(const forces::ForceLaw<double>& law, const Sample<double>& sample,
                              const Matrix3X<double>& velocities) {
  const Matrix3X<double> force =
      forces_of(law, Sample<double>{sample.positions, velocities, sample.masses});
  return force.array().rowwise() / sample.masses.transpose().array();
}

Matrix3X<double> runge_kutta(const forces::ForceLaw<double>& law, const Sample<double>& sample,
                             int num_steps) {
  const double h = kTimeStep / num_steps;
  Matrix3X<double> v = sample.velocities;
  for (int step = 0; step < num_steps; ++step) {
    const Matrix3X<double> k1 = acceleration(law, sample, v);
    const Matrix3X<double> k2 = acceleration(law, sample, v + h / 2 * k1);
    const Matrix3X<double> k3 = acceleration(law, sample, v + h / 2 * k2);
    const Matrix3X<double> k4 = acceleration(law, sample, v + h * k3);
    v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return v;
}

}  // namespace

Measurement advance_solves_the_equation(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<double>(mesh);
  Measurement worst{.what = "advance_velocities against Runge-Kutta"};
  for (const Deformation deformation : kDeformations) {
    const Sample<double> sample = deformed(mesh, deformation);
    Matrix3X<double> advanced = sample.velocities;
    law->advance_velocities(sample.state(), kTimeStep, advanced);
    std::vector<double> steps, errors, floors;
    for (const int num_steps : {8, 16, 32, 64}) {
      steps.push_back(kTimeStep / num_steps);
      errors.push_back((runge_kutta(*law, sample, num_steps) - advanced).norm());
      floors.push_back(roundoff<double>(num_steps, largest(sample.velocities)));
    }
    worst = worse(worst, order_of_convergence(worst.what, 4.0, steps, errors, floors));
  }
  return worst;
}

template <class Scalar>
Measurement two_half_steps_are_one(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<Scalar>(mesh);
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  Matrix3X<Scalar> once = sample.velocities;
  law->advance_velocities(sample.state(), Scalar(kTimeStep), once);
  Sample<Scalar> twice = sample;
  for (int half = 0; half < 2; ++half) {
    Matrix3X<Scalar> velocities = twice.velocities;
    law->advance_velocities(twice.state(), Scalar(kTimeStep / 2), velocities);
    twice.velocities = velocities;
  }
  return {largest(once - twice.velocities), roundoff<Scalar>(2, largest(sample.velocities)),
          "|one step - two half steps| [m/s]"};
}

template <class Scalar>
Measurement advance_changes_nothing(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<Scalar>(mesh);
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  Matrix3X<Scalar> velocities = sample.velocities;
  law->advance_velocities(sample.state(), Scalar(kTimeStep), velocities);
  return {largest(velocities - sample.velocities), 0.0, "|change of velocity| [m/s]"};
}

#define WEFT_INSTANTIATE(Scalar)                                       \
  template Measurement two_half_steps_are_one<Scalar>(const Subject&); \
  template Measurement advance_changes_nothing<Scalar>(const Subject&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft::contract
