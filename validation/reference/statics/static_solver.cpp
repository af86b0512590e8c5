#include <weft/validation/reference/statics/static_solver.hpp>

#include <algorithm>
#include <cmath>

#include <weft/validation/reference/statics/colored_matrix.hpp>
#include <weft/validation/reference/statics/coupling.hpp>
#include <weft/validation/reference/statics/definite_factor.hpp>

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

}  // namespace

StaticOutcome solve_statics(const StaticProblem& problem, Matrix3X<double>& positions,
                            const StaticOptions& options) {
  const ColoredMatrix matrix(problem.coupled, problem.fixed);
  const auto num_nodes = positions.cols();
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, num_nodes);
  DefiniteFactor factor;
  StaticOutcome outcome;
  for (;; ++outcome.iterations) {
    problem.forces(positions, forces);
    outcome.residual = largest_free_force(forces, problem.fixed) / problem.load;
    outcome.converged = outcome.residual <= options.residual;
    if (outcome.converged || !std::isfinite(outcome.residual) ||
        outcome.iterations == options.max_iterations || matrix.num_free() == 0) {
      return outcome;
    }
    const Eigen::SparseMatrix<double> stiffness =
        matrix.assemble([&](const Matrix3X<double>& direction, Matrix3X<double>& product) {
          problem.stiffness_product(positions, direction, product);
          product = -product;
        });
    factor.factorize(stiffness);
    Eigen::VectorXd right(3 * matrix.num_free());
    for (int node = 0; node < num_nodes; ++node) {
      if (matrix.row_of(node) >= 0) right.segment<3>(matrix.row_of(node)) = forces.col(node);
    }
    const Eigen::VectorXd step = factor.solve(right);
    double longest = 0.0;
    for (Eigen::Index row = 0; row < step.size(); row += 3) {
      longest = std::max(longest, step.segment<3>(row).norm());
    }
    const double part = longest > options.max_move ? options.max_move / longest : 1.0;
    for (int node = 0; node < num_nodes; ++node) {
      if (matrix.row_of(node) >= 0) {
        positions.col(node) += part * step.segment<3>(matrix.row_of(node));
      }
    }
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
