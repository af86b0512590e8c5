#include "tests/contract/checks/derivative_checks.hpp"

#include <cmath>

#include "tests/contract/evaluate.hpp"

namespace weft::contract {
namespace {

/// Steps in units of the direction's entries [-]; directions are kSpacing and 1 m/s long at most.
const std::vector<double> kSteps = {0x1p-7, 0x1p-8, 0x1p-9, 0x1p-10, 0x1p-11};

enum class Argument { kPositions, kVelocities };

struct Probe {
  Sample<double> sample;
  Matrix3X<double> direction;  ///< 3 x n, [m] or [m/s]
};

std::vector<Probe> probes(const ClothMesh& mesh, Argument argument) {
  std::vector<Probe> result;
  std::uint64_t seed = 7;
  for (const Deformation deformation : kDeformations) {
    const double size = argument == Argument::kPositions ? kSpacing : 1.0;
    result.push_back(
        {deformed(mesh, deformation), size * random_directions(mesh.num_nodes(), seed++)});
  }
  return result;
}

Matrix3X<double> product(const forces::ForceLaw<double>& law, const Probe& probe,
                         Argument argument) {
  return argument == Argument::kPositions ? stiffness_product(law, probe.sample, probe.direction)
                                          : damping_product(law, probe.sample, probe.direction);
}

Measurement derivative(const Subject& subject, Argument argument, const std::string& what) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<double>(mesh);
  const auto dual_law = subject.make<Dual>(mesh);
  Measurement worst{.what = what};
  for (const Probe& probe : probes(mesh, argument)) {
    const Matrix3X<double> none = Matrix3X<double>::Zero(3, mesh.num_nodes());
    const Sample<Dual> dual = argument == Argument::kPositions
                                  ? seeded(probe.sample, probe.direction, none)
                                  : seeded(probe.sample, none, probe.direction);
    const Matrix3X<double> error =
        product(*law, probe, argument) - derivatives_of(forces_of(*dual_law, dual));
    worst =
        worse(worst, {largest(error),
                      roundoff<double>(mesh.num_nodes(), force_scale(*law, probe.sample)), what});
  }
  return worst;
}

Measurement difference(const Subject& subject, Argument argument, const std::string& what) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<double>(mesh);
  Measurement worst{.what = what};
  for (const Probe& probe : probes(mesh, argument)) {
    const Matrix3X<double> expected = product(*law, probe, argument);
    std::vector<double> errors, floors;
    for (const double step : kSteps) {
      Sample<double> ahead = probe.sample;
      Sample<double> behind = probe.sample;
      (argument == Argument::kPositions ? ahead.positions : ahead.velocities) +=
          step * probe.direction;
      (argument == Argument::kPositions ? behind.positions : behind.velocities) -=
          step * probe.direction;
      const Matrix3X<double> slope =
          (forces_of(*law, ahead) - forces_of(*law, behind)) / (2 * step);
      errors.push_back((slope - expected).norm());
      floors.push_back(roundoff<double>(mesh.num_nodes(), force_scale(*law, probe.sample)) / step);
    }
    worst = worse(worst, order_of_convergence(what, 2.0, kSteps, errors, floors));
  }
  return worst;
}

}  // namespace

Measurement stiffness_is_the_derivative(const Subject& subject) {
  return derivative(subject, Argument::kPositions, "|K b - df/dx b| by Dual [N]");
}

Measurement stiffness_is_the_difference(const Subject& subject) {
  return difference(subject, Argument::kPositions, "K b = df/dx b by differences");
}

Measurement damping_is_the_derivative(const Subject& subject) {
  return derivative(subject, Argument::kVelocities, "|C b - df/dv b| by Dual [N]");
}

Measurement damping_is_the_difference(const Subject& subject) {
  return difference(subject, Argument::kVelocities, "C b = df/dv b by differences");
}

Measurement stiffness_is_symmetric(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto law = subject.make<double>(mesh);
  Measurement worst{.what = "|a.Kb - b.Ka| [N m]"};
  for (Probe& probe : probes(mesh, Argument::kPositions)) {
    probe.sample.velocities.setZero();
    const Matrix3X<double> a = kSpacing * random_directions(mesh.num_nodes(), 31);
    const Matrix3X<double>& b = probe.direction;
    const double ab = a.cwiseProduct(stiffness_product(*law, probe.sample, b)).sum();
    const double ba = b.cwiseProduct(stiffness_product(*law, probe.sample, a)).sum();
    const double scale = kSpacing * force_scale(*law, probe.sample);
    worst = worse(worst, {std::abs(ab - ba), roundoff<double>(a.size(), scale), worst.what});
  }
  return worst;
}

Measurement float_agrees_with_double(const Subject& subject) {
  const ClothMesh mesh = subject.mesh();
  const auto coarse = subject.make<float>(mesh);
  const auto fine = subject.make<double>(mesh);
  Measurement worst{.what = "float against double"};
  const auto compare = [&](const std::string& what, double error, double scale) {
    worst =
        worse(worst, {error, roundoff<float>(mesh.num_nodes(), scale), "float - double: " + what});
  };
  for (const Probe& probe : probes(mesh, Argument::kPositions)) {
    const Sample<float> sample = cast<float>(probe.sample);
    const Sample<double> same = cast<double>(sample);
    const Matrix3X<float> direction = probe.direction.cast<float>();
    const Matrix3X<double> same_direction = direction.cast<double>();
    const double scale = force_scale(*fine, same);
    const auto error = [](const Matrix3X<float>& a, const Matrix3X<double>& b) {
      return largest(a.cast<double>() - b);
    };
    compare("force [N]", error(forces_of(*coarse, sample), forces_of(*fine, same)), scale);
    compare("stiffness product [N]",
            error(stiffness_product(*coarse, sample, direction),
                  stiffness_product(*fine, same, same_direction)),
            scale);
    compare("damping product [N]",
            error(damping_product(*coarse, sample, direction),
                  damping_product(*fine, same, same_direction)),
            scale);
    const double energy = fine->potential_energy(same.state());
    compare("energy [J]",
            std::abs(static_cast<double>(coarse->potential_energy(sample.state())) - energy),
            std::abs(energy) + scale * largest(same.positions));
    const double power = fine->non_conservative_power(same.state());
    compare("power [W]",
            std::abs(static_cast<double>(coarse->non_conservative_power(sample.state())) - power),
            std::abs(power) + scale * largest(same.velocities));
  }
  return worst;
}

}  // namespace weft::contract
