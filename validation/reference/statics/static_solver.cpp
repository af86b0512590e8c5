#include <weft/validation/reference/statics/static_solver.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>

#include <weft/validation/reference/statics/coupling.hpp>

namespace weft::reference {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// -df/dx on the free nodes.
class StiffnessMatrix {
 public:
  explicit StiffnessMatrix(const StaticProblem& problem)
      : problem_(problem), num_nodes_(static_cast<int>(problem.fixed.size())) {
    row_of_.assign(problem.fixed.size(), -1);
    for (std::size_t node = 0; node < problem.fixed.size(); ++node) {
      if (!problem.fixed[node]) row_of_[node] = 3 * num_free_++;
    }
    colors_ = column_colors(problem.coupled, num_nodes_);
    num_colors_ = colors_.empty() ? 0 : *std::max_element(colors_.begin(), colors_.end()) + 1;
    for (int node = 0; node < num_nodes_; ++node) blocks_.emplace_back(node, node);
    for (Eigen::Index e = 0; e < problem.coupled.cols(); ++e) {
      blocks_.emplace_back(problem.coupled(0, e), problem.coupled(1, e));
      blocks_.emplace_back(problem.coupled(1, e), problem.coupled(0, e));
    }
  }

  [[nodiscard]] int num_free() const { return num_free_; }
  [[nodiscard]] int row_of(int node) const { return row_of_[static_cast<std::size_t>(node)]; }

  [[nodiscard]] Sparse assemble(const Matrix3X<double>& positions) const {
    std::vector<std::vector<std::pair<int, int>>> blocks_of_color(
        static_cast<std::size_t>(num_colors_));
    for (const auto& [row, column] : blocks_) {
      if (row_of(row) < 0 || row_of(column) < 0) continue;
      const auto color = static_cast<std::size_t>(colors_[static_cast<std::size_t>(column)]);
      blocks_of_color[color].emplace_back(row, column);
    }
    std::vector<Eigen::Triplet<double>> triplets;
    Matrix3X<double> direction(3, num_nodes_);
    Matrix3X<double> product(3, num_nodes_);
    for (int color = 0; color < num_colors_; ++color) {
      for (int axis = 0; axis < 3; ++axis) {
        direction.setZero();
        for (int node = 0; node < num_nodes_; ++node) {
          const auto n = static_cast<std::size_t>(node);
          if (colors_[n] == color && !problem_.fixed[n]) direction(axis, node) = 1.0;
        }
        problem_.stiffness_product(positions, direction, product);
        for (const auto& [row, column] : blocks_of_color[static_cast<std::size_t>(color)]) {
          for (int k = 0; k < 3; ++k) {
            triplets.emplace_back(row_of(row) + k, row_of(column) + axis, -product(k, row));
          }
        }
      }
    }
    Sparse matrix(3 * num_free_, 3 * num_free_);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    return matrix;
  }

 private:
  const StaticProblem& problem_;
  int num_nodes_;
  int num_free_ = 0;
  std::vector<int> row_of_;  // first row of a free node, -1 for a fixed one
  std::vector<int> colors_;
  int num_colors_ = 0;
  std::vector<std::pair<int, int>> blocks_;
};

/// Solves (K + shift) step = right, with the smallest shift tried that makes it positive definite.
Eigen::VectorXd downhill_step(const Sparse& stiffness, const Eigen::VectorXd& right,
                              Eigen::SimplicialLDLT<Sparse>& factor) {
  const double scale = stiffness.diagonal().cwiseAbs().mean();
  Sparse identity(stiffness.rows(), stiffness.cols());
  identity.setIdentity();
  constexpr double kFirstShift = 1e-9;  // of the mean diagonal: far below any mode that matters
  constexpr int kMaxShifts = 12;
  double shift = 0.0;
  for (int attempt = 0; attempt <= kMaxShifts; ++attempt) {
    factor.factorize(shift > 0.0 ? Sparse(stiffness + shift * identity) : stiffness);
    if (factor.info() == Eigen::Success && factor.vectorD().minCoeff() > 0.0) break;
    shift = shift > 0.0 ? 10 * shift : kFirstShift * scale;
  }
  return factor.solve(right);
}

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
  const StiffnessMatrix matrix(problem);
  const auto num_nodes = positions.cols();
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, num_nodes);
  Eigen::SimplicialLDLT<Sparse> factor;
  StaticOutcome outcome;
  bool is_analyzed = false;
  for (;; ++outcome.iterations) {
    problem.forces(positions, forces);
    outcome.residual = largest_free_force(forces, problem.fixed) / problem.load;
    outcome.converged = outcome.residual <= options.residual;
    if (outcome.converged || !std::isfinite(outcome.residual) ||
        outcome.iterations == options.max_iterations || matrix.num_free() == 0) {
      return outcome;
    }
    const Sparse stiffness = matrix.assemble(positions);
    if (!is_analyzed) factor.analyzePattern(stiffness);
    is_analyzed = true;
    Eigen::VectorXd right(3 * matrix.num_free());
    for (int node = 0; node < num_nodes; ++node) {
      if (matrix.row_of(node) >= 0) right.segment<3>(matrix.row_of(node)) = forces.col(node);
    }
    const Eigen::VectorXd step = downhill_step(stiffness, right, factor);
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
