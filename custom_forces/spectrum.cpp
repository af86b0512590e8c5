#include <weft/custom_forces/spectrum.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include <weft/custom_forces/registry.hpp>

namespace weft::forces {
namespace {

/// y = A x for a symmetric A; x and y are 3 x n.
using Operator = std::function<void(const Matrix3X<double>&, Matrix3X<double>&)>;

struct Eigenpair {
  double value = 0.0;
  Matrix3X<double> vector;  // unit norm
  int iterations = 0;
  bool converged = true;
};

/// Pseudo-random and fixed: has a part of every mode, whatever the symmetry of the mesh.
Matrix3X<double> start_vector(const VectorX<double>& inverse_masses) {
  Matrix3X<double> vector(3, inverse_masses.size());
  std::uint32_t state = 1;
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    state = state * 1664525u + 1013904223u;  // Numerical Recipes' generator, low quality is enough
    vector.data()[i] = static_cast<double>(state) / 4294967296.0 - 0.5;
  }
  for (Eigen::Index i = 0; i < vector.cols(); ++i) {
    if (inverse_masses[i] == 0.0) vector.col(i).setZero();
  }
  return vector;
}

double dot(const Matrix3X<double>& a, const Matrix3X<double>& b) {
  return a.cwiseProduct(b).sum();
}

/// Eigenvalue of A S + shift that is largest in magnitude, minus the shift. A is symmetric, S
/// symmetric and positive definite, so A S is self-adjoint in the inner product x . S y, in which
/// the quotient is taken. The vector is an eigenvector of A S with x . S x = 1.
Eigenpair power_iteration(const Operator& multiply, const Operator& inertia,
                          Matrix3X<double> vector, double shift) {
  Eigenpair result;
  Matrix3X<double> product(3, vector.cols());
  Matrix3X<double> dual(3, vector.cols());  // S x
  inertia(vector, dual);
  double norm = std::sqrt(dot(vector, dual));
  double previous = 0.0;
  result.converged = false;
  while (norm > 0.0 && result.iterations < kMaxPowerIterations) {
    vector /= norm;
    dual /= norm;
    multiply(dual, product);
    product += shift * vector;
    const double quotient = dot(dual, product);
    result.value = quotient - shift;
    ++result.iterations;
    result.converged = std::abs(quotient - previous) <= kRayleighTolerance * std::abs(quotient);
    if (result.converged) break;
    previous = quotient;
    result.vector = vector;
    vector.swap(product);
    inertia(vector, dual);
    norm = std::sqrt(dot(vector, dual));
  }
  if (!(norm > 0.0)) result.converged = norm == 0.0;  // A = 0, or not a number
  if (result.converged && norm > 0.0) result.vector = vector;
  return result;
}

Eigenpair largest_eigenvalue(const Operator& multiply, const Operator& inertia,
                             const Matrix3X<double>& start) {
  Eigenpair pair = power_iteration(multiply, inertia, start, 0.0);
  if (pair.value < 0.0) {
    const int iterations = pair.iterations;
    pair = power_iteration(multiply, inertia, start, -pair.value);
    pair.iterations += iterations;
  }
  return pair;
}

/// Wraps a product as M^-1/2 (-product) M^-1/2 on free nodes.
Operator scaled(const VectorX<double>& inverse_masses, const Operator& product) {
  const VectorX<double> scale = inverse_masses.cwiseSqrt();
  return [scale, product](const Matrix3X<double>& x, Matrix3X<double>& y) {
    const Matrix3X<double> moved = x * scale.asDiagonal();
    Matrix3X<double> forces = Matrix3X<double>::Zero(3, x.cols());
    product(moved, forces);
    y = -(forces * scale.asDiagonal());
  };
}

/// What inertia-level laws do to forces, as an operator S on mass-weighted ones: F -> M^1/2 F. Their
/// redistribution R is symmetric in the inner product of the accelerations, x . R(M y), which makes
/// S = M^-1/2 R M^1/2 symmetric.
Operator added_inertia(const LawSet<double>& laws, const State<double>& state,
                       const VectorX<double>& inverse_masses) {
  if (!laws.has_level(LawTraits::Level::kInertia)) {
    return [](const Matrix3X<double>& x, Matrix3X<double>& y) { y = x; };
  }
  const VectorX<double> scale = inverse_masses.cwiseSqrt();
  return [&laws, &state, scale](const Matrix3X<double>& x, Matrix3X<double>& y) {
    y = x * state.masses.cwiseSqrt().asDiagonal();
    laws.redistribute_forces(state, y);
    y = y * scale.asDiagonal();
  };
}

}  // namespace

Spectrum spectrum(LawSet<double>& laws, const State<double>& state,
                  const VectorX<double>& inverse_masses) {
  using Level = LawTraits::Level;
  const Matrix3X<double> start = start_vector(inverse_masses);

  const auto damping = [&](Level level) -> Operator {
    return scaled(inverse_masses,
                  [&laws, &state, level](const Matrix3X<double>& x, Matrix3X<double>& y) {
                    for (const auto& law : laws.laws()) {
                      if (law->info().traits.level != level) continue;
                      Matrix3X<double> scratch = Matrix3X<double>::Zero(3, law->scratch_columns());
                      law->add_damping_product(state, x, scratch, y);
                    }
                  });
  };
  const Operator stiffness =
      scaled(inverse_masses, [&laws, &state](const Matrix3X<double>& x, Matrix3X<double>& y) {
        laws.add_stiffness_product(state, x, y);
      });

  const Operator inertia = added_inertia(laws, state, inverse_masses);
  const Operator plain = [](const Matrix3X<double>& x, Matrix3X<double>& y) { y = x; };

  const Eigenpair top = largest_eigenvalue(stiffness, inertia, start);
  const Eigenpair force = largest_eigenvalue(damping(Level::kForce), inertia, start);
  const Eigenpair velocity = largest_eigenvalue(damping(Level::kVelocity), plain, start);

  Spectrum result;
  result.omega_max = std::sqrt(std::max(0.0, top.value));
  if (top.vector.cols() > 0) {
    // The motion of the mode is S x; its inertia product with x is x . S x = 1.
    Matrix3X<double> mode(3, start.cols());
    Matrix3X<double> product(3, start.cols());
    inertia(top.vector, mode);
    damping(Level::kForce)(mode, product);
    result.top_mode_damping = dot(mode, product);
    damping(Level::kVelocity)(mode, product);
    result.top_mode_damping += dot(top.vector, product);
  }
  result.gamma_force_max = std::max(0.0, force.value);
  result.gamma_velocity_max = std::max(0.0, velocity.value);
  result.iterations = std::max({top.iterations, force.iterations, velocity.iterations});
  result.converged = top.converged && force.converged && velocity.converged;
  return result;
}

double critical_time_step(const Spectrum& s) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto ratio = [](double a, double b) { return b > 0.0 ? a / b : kInfinity; };
  const auto margin = [&](double h) {
    const double q = std::exp(-h * s.gamma_velocity_max) * (1.0 - h * s.gamma_force_max);
    return 2.0 * (1.0 + q) - h * h * s.omega_max * s.omega_max;
  };
  double unstable = std::min(ratio(2.0, s.omega_max), ratio(2.0, s.gamma_force_max));
  if (!std::isfinite(unstable) || margin(unstable) > 0.0) return unstable;
  double stable = 0.0;
  constexpr int kBisections = 60;  // one bit each, more than a double has
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (stable + unstable);
    (margin(middle) > 0.0 ? stable : unstable) = middle;
  }
  return stable;
}

double critical_time_step(const ClothMesh& mesh, const std::vector<LawSpecification>& laws) {
  LawSet<double> set;
  for (const LawSpecification& law : laws) set.add(make_law<double>(law, mesh));
  VectorX<double> inverse_masses = mesh.masses.cwiseInverse();
  for (const int node : mesh.pinned) inverse_masses[node] = 0.0;
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, mesh.num_nodes());
  return critical_time_step(
      spectrum(set, State<double>{mesh.rest_positions, still, mesh.masses}, inverse_masses));
}

}  // namespace weft::forces
