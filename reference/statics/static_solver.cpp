#include <weft/reference/statics/static_solver.hpp>

#include <algorithm>
#include <cmath>

#include <weft/reference/statics/colored_matrix.hpp>
#include <weft/reference/statics/coupling.hpp>
#include <weft/reference/statics/definite_factor.hpp>

namespace weft::reference {
namespace {

double largest_free_force(const Matrix3X<double>& forces, const std::vector<bool>& fixed) {
  double largest = 0.0;
  for (Eigen::Index node = 0; node < forces.cols(); ++node) {
    if (fixed[static_cast<std::size_t>(node)]) continue;
    const double size = forces.col(node).norm();
    if (!(size <= largest)) largest = size;
  }
  return largest;
}

/// Moves positions along a step that goes downhill, as far as options allow and not much beyond the
/// lowest place on the way; forces become those there. The forces' work along the step says where
/// that is, so no energy is needed.
void move_downhill(const StaticProblem& problem, const StaticOptions& options,
                   const Matrix3X<double>& step, Matrix3X<double>& positions,
                   Matrix3X<double>& forces) {
  const double longest = std::sqrt(step.colwise().squaredNorm().maxCoeff());
  const double pull = forces.cwiseProduct(step).sum();
  const double residual = largest_free_force(forces, problem.fixed);
  const Matrix3X<double> start = positions;
  double part = longest > options.max_move ? options.max_move / longest : 1.0;
  constexpr int kMaxHalvings = 30;
  constexpr double kOvershoot = 0.9;  // part of the first pull with which it may be pulled back
  for (int halving = 0; halving <= kMaxHalvings; ++halving, part *= 0.5) {
    positions = start + part * step;
    problem.forces(positions, forces);
    if (forces.cwiseProduct(step).sum() >= -kOvershoot * pull) return;
    if (largest_free_force(forces, problem.fixed) < residual) return;
  }
}

}  // namespace

StaticOutcome solve_statics(const StaticProblem& problem, Matrix3X<double>& positions,
                            const StaticOptions& options) {
  const ColoredMatrix matrix(problem.coupled, problem.fixed);
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, positions.cols());
  DefiniteFactor factor;
  StaticOutcome outcome;
  problem.forces(positions, forces);
  for (;; ++outcome.iterations) {
    outcome.residual = largest_free_force(forces, problem.fixed) / problem.load;
    outcome.converged = outcome.residual <= options.residual;
    if (outcome.converged || !std::isfinite(outcome.residual) ||
        outcome.iterations == options.max_iterations || matrix.num_free() == 0) {
      return outcome;
    }
    factor.factorize(
        matrix.assemble([&](const Matrix3X<double>& direction, Matrix3X<double>& product) {
          problem.stiffness_product(positions, direction, product);
          product = -product;
        }));
    Eigen::VectorXd right(3 * matrix.num_free());
    for (int node = 0; node < positions.cols(); ++node) {
      if (matrix.row_of(node) >= 0) right.segment<3>(matrix.row_of(node)) = forces.col(node);
    }
    const Eigen::VectorXd solution = factor.solve(right);
    Matrix3X<double> step = Matrix3X<double>::Zero(3, positions.cols());
    for (int node = 0; node < positions.cols(); ++node) {
      if (matrix.row_of(node) >= 0) step.col(node) = solution.segment<3>(matrix.row_of(node));
    }
    move_downhill(problem, options, step, positions, forces);
  }
}

StaticProblem static_problem(Body& body, double load) {
  StaticProblem problem;
  problem.coupled = coupled_nodes(body);
  problem.fixed.assign(static_cast<std::size_t>(body.mesh.num_nodes()), false);
  for (const int node : body.mesh.pinned) problem.fixed[static_cast<std::size_t>(node)] = true;
  problem.load = load;
  problem.forces = [&body](const Matrix3X<double>& positions, Matrix3X<double>& forces) {
    const Matrix3X<double> still = Matrix3X<double>::Zero(3, positions.cols());
    forces.setZero();
    const forces::ForceReport report =
        body.laws.add_forces({positions, still, body.mesh.masses},
                             forces::LawSet<double>::VelocityLaws::kAsForces, forces);
    if (!report.ok()) forces.col(*report.first_non_finite_node).setConstant(std::nan(""));
  };
  problem.stiffness_product = [&body](const Matrix3X<double>& positions,
                                      const Matrix3X<double>& displacements,
                                      Matrix3X<double>& product) {
    const Matrix3X<double> still = Matrix3X<double>::Zero(3, positions.cols());
    product.setZero();
    body.laws.add_stiffness_product({positions, still, body.mesh.masses}, displacements, product);
  };
  return problem;
}

}  // namespace weft::reference
