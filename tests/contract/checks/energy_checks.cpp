#include "tests/contract/checks/energy_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/contract/evaluate.hpp"

namespace weft::contract {
namespace {

/// Steps of the difference formulas in units of kSpacing [-]. The largest stays clear of every rest
/// length (Deformation); at the smallest, truncation is still 1e4 times the round-off eps E / h.
const std::vector<double> kStepRatios = {0x1p-7, 0x1p-8, 0x1p-9, 0x1p-10, 0x1p-11};

Matrix3X<double> difference_gradient(const forces::ForceLaw<double>& law, Sample<double> sample,
                                     double step) {
  Matrix3X<double> gradient(3, sample.num_nodes());
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    double& x = sample.positions.data()[i];
    const double here = x;
    x = here + step;
    const double ahead = law.potential_energy(sample.state());
    x = here - step;
    const double behind = law.potential_energy(sample.state());
    x = here;
    gradient.data()[i] = (ahead - behind) / (2 * step);
  }
  return gradient;
}

}  // namespace

Measurement force_is_minus_energy_gradient(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<double>(mesh);
  Measurement worst{.what = "force = -grad E"};
  for (const Deformation deformation : kDeformations) {
    Sample<double> sample = deformed(mesh, deformation);
    sample.velocities.setZero();
    const Matrix3X<double> force = forces_of(*law, sample);
    const double energy_scale = std::abs(law->potential_energy(sample.state())) +
                                force_scale(*law, sample) * largest(sample.positions);
    std::vector<double> steps, errors, floors;
    for (const double ratio : kStepRatios) {
      const double step = ratio * kSpacing;
      steps.push_back(step);
      errors.push_back((difference_gradient(*law, sample, step) + force).norm());
      floors.push_back(roundoff<double>(sample.num_nodes(), energy_scale) / step);
    }
    worst = worse(worst, order_of_convergence("force = -grad E", 2.0, steps, errors, floors));
  }
  return worst;
}

Measurement energy_is_zero(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<double>(mesh);
  Measurement worst{.what = "|E| of a law without energy [J]"};
  for (const Deformation deformation : kDeformations) {
    const Sample<double> sample = deformed(mesh, deformation);
    worst = worse(worst, {std::abs(law->potential_energy(sample.state())), 0.0, worst.what});
  }
  return worst;
}

Measurement power_is_accounted_for(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<double>(mesh);
  const auto dual_law = subject.make<Dual>(mesh);
  Measurement worst{.what = "|f.v + dE/dt - P_nc| [W]"};
  for (const Deformation deformation : kDeformations) {
    const Sample<double> sample = deformed(mesh, deformation);
    const Sample<Dual> moving =
        seeded(sample, sample.velocities, Matrix3X<double>::Zero(3, sample.num_nodes()));
    const double energy_rate = dual_law->potential_energy(moving.state()).derivatives()[0];
    const double power = forces_of(*law, sample).cwiseProduct(sample.velocities).sum();
    const double residual = power + energy_rate - law->non_conservative_power(sample.state());
    const double scale = force_scale(*law, sample) * largest(sample.velocities);
    worst = worse(
        worst, {std::abs(residual), roundoff<double>(sample.positions.size(), scale), worst.what});
  }
  return worst;
}

Measurement power_is_never_positive(const Subject& subject) {
  constexpr std::uint64_t kStates = 20;
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<double>(mesh);
  double power = -std::numeric_limits<double>::infinity();
  for (std::uint64_t seed = 1; seed <= kStates; ++seed) {
    for (const Deformation deformation : kDeformations) {
      const Sample<double> sample = deformed(mesh, deformation, seed);
      power = std::max(power, law->non_conservative_power(sample.state()));
    }
  }
  return {power, 0.0, "largest P_nc of a dissipative law [W]"};
}

}  // namespace weft::contract
