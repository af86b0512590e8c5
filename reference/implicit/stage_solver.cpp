#include <weft/reference/implicit/stage_solver.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <weft/reference/implicit/gmres.hpp>
#include <weft/reference/statics/colored_matrix.hpp>
#include <weft/reference/statics/coupling.hpp>
#include <weft/reference/statics/definite_factor.hpp>

namespace weft::reference {
namespace {

/// A stage equation at one y, with what its derivative is taken at.
class Linearisation {
 public:
  Linearisation(BodyDynamics& dynamics, const StageEquation& equation)
      : dynamics_(dynamics), equation_(equation) {}

  /// Sum of the squares of the forces that are left [N^2]; not finite for a state out of range.
  double set(const Matrix3X<double>& y) {
    positions_ = equation_.positions + equation_.position_gain * y;
    velocities_ = equation_.velocities + equation_.velocity_gain * y;
    if (!positions_.allFinite() || !velocities_.allFinite()) return std::nan("");
    residual_.resize(3, y.cols());
    dynamics_.evaluate(positions_, velocities_, equation_.time_in_step,
                       BodyDynamics::VelocityLaws::kAsForces, residual_);
    residual_ -= equation_.acceleration_gain * y;
    if (equation_.accelerations.cols() > 0) residual_ -= equation_.accelerations;
    const VectorX<double>& inverse = dynamics_.inverse_masses();
    for (Eigen::Index i = 0; i < y.cols(); ++i) {
      if (inverse[i] == 0.0) {
        residual_.col(i).setZero();
      } else {
        residual_.col(i) *= dynamics_.body().mesh.masses[i];
      }
    }
    return residual_.squaredNorm();
  }

  /// product = -d residual / dy direction [N]
  void multiply(BodyDynamics::Reach reach, const Matrix3X<double>& direction,
                Matrix3X<double>& product) {
    dynamics_.multiply_jacobian(reach, positions_, velocities_, equation_.time_in_step,
                                equation_.position_gain * direction,
                                equation_.velocity_gain * direction, product);
    product =
        (equation_.acceleration_gain * direction) * dynamics_.body().mesh.masses.asDiagonal() -
        product;
  }

  [[nodiscard]] const Matrix3X<double>& residual() const { return residual_; }    ///< [N]
  [[nodiscard]] double size() const { return positions_.cwiseAbs().maxCoeff(); }  ///< [m]

 private:
  BodyDynamics& dynamics_;
  const StageEquation& equation_;
  Matrix3X<double> positions_, velocities_;
  Matrix3X<double> residual_;
};

std::vector<bool> pinned_flags(const BodyDynamics& dynamics) {
  std::vector<bool> fixed;
  for (const double inverse : dynamics.inverse_masses()) fixed.push_back(inverse == 0.0);
  return fixed;
}

}  // namespace

class StageSolver::Preconditioner {
 public:
  explicit Preconditioner(const BodyDynamics& dynamics)
      : matrix_(nearly_coupled_nodes(dynamics.body()), pinned_flags(dynamics)) {}

  /// The step of y by which the linearised equation is solved. Returns how many iterations it took.
  int solve(Linearisation& linear, const StageEquation& equation, Matrix3X<double>& step) {
    const bool is_other =
        position_gain_ != equation.position_gain || velocity_gain_ != equation.velocity_gain;
    if (is_other) make_factor(linear, equation);
    const VectorX<double> right = gathered(linear.residual());
    VectorX<double> solution;
    int iterations = run(linear, right, solution).iterations;
    if (iterations > kStaleFactor && !is_new_) {
      make_factor(linear, equation);
      iterations += run(linear, right, solution).iterations;
    }
    is_new_ = false;
    scatter(solution, step);
    return iterations;
  }

  [[nodiscard]] bool has_unknowns() const { return matrix_.num_free() > 0; }

 private:
  void make_factor(Linearisation& linear, const StageEquation& equation) {
    const Eigen::SparseMatrix<double> jacobian =
        matrix_.assemble([&](const Matrix3X<double>& direction, Matrix3X<double>& product) {
          linear.multiply(BodyDynamics::Reach::kShort, direction, product);
        });
    factor_.factorize(0.5 * (jacobian + Eigen::SparseMatrix<double>(jacobian.transpose())));
    position_gain_ = equation.position_gain;
    velocity_gain_ = equation.velocity_gain;
    is_new_ = true;
  }

  KrylovOutcome run(Linearisation& linear, const VectorX<double>& right,
                    VectorX<double>& solution) {
    Matrix3X<double> direction = Matrix3X<double>::Zero(3, linear.residual().cols());
    Matrix3X<double> product(3, direction.cols());
    return gmres(
        [&](const VectorX<double>& vector, VectorX<double>& result) {
          scatter(vector, direction);
          linear.multiply(BodyDynamics::Reach::kAll, direction, product);
          result = gathered(product);
        },
        [&](const VectorX<double>& vector, VectorX<double>& result) {
          result = factor_.solve(vector);
        },
        right, kKrylovTolerance, kMaxKrylovIterations, solution);
  }

  [[nodiscard]] VectorX<double> gathered(const Matrix3X<double>& all) const {
    VectorX<double> free(3 * matrix_.num_free());
    for (int node = 0; node < all.cols(); ++node) {
      if (matrix_.row_of(node) >= 0) free.segment<3>(matrix_.row_of(node)) = all.col(node);
    }
    return free;
  }
  void scatter(const VectorX<double>& free, Matrix3X<double>& all) const {
    for (int node = 0; node < all.cols(); ++node) {
      if (matrix_.row_of(node) >= 0) all.col(node) = free.segment<3>(matrix_.row_of(node));
    }
  }

  ColoredMatrix matrix_;
  DefiniteFactor factor_;
  double position_gain_ = 0.0;  // that the factor was made for
  double velocity_gain_ = 0.0;
  bool is_new_ = false;
};

StageSolver::StageSolver() = default;
StageSolver::~StageSolver() = default;

IntegrationReport StageSolver::solve(BodyDynamics& dynamics, const StageEquation& equation,
                                     Matrix3X<double>& y) {
  if (!preconditioner_) preconditioner_ = std::make_unique<Preconditioner>(dynamics);
  IntegrationReport report;
  if (!preconditioner_->has_unknowns()) return report;
  Linearisation linear(dynamics, equation);
  Matrix3X<double> step = Matrix3X<double>::Zero(3, y.cols());
  double merit = linear.set(y);
  bool is_solved = merit == 0.0;
  report.converged = is_solved;
  int iterations = 0;
  while (!is_solved && std::isfinite(merit) && report.newton_iterations < kMaxNewtonIterations) {
    ++report.newton_iterations;
    iterations += preconditioner_->solve(linear, equation, step);
    if (iterations > kMaxStageIterations) {
      report.exhausted = "an implicit stage is not solved after 5000 iterations of GMRES";
      break;
    }
    const double longest = equation.position_gain * step.cwiseAbs().maxCoeff();
    const bool is_last = longest <= kNewtonStep * linear.size() ||
                         step.cwiseAbs().maxCoeff() <= kNewtonStep * y.cwiseAbs().maxCoeff();
    const Matrix3X<double> start = y;
    constexpr int kMaxHalvings = 30;
    constexpr double kDecrease = 1e-4;  // Armijo's condition
    double part = 1.0;
    double next = merit;
    for (int halving = 0; halving <= kMaxHalvings; ++halving, part *= 0.5) {
      y = start + part * step;
      next = linear.set(y);
      // At the end rounding rules the residual: the last step is taken as it is.
      if (is_last || next <= (1.0 - 2.0 * kDecrease * part) * merit) break;
    }
    if (!is_last && !(next < merit)) {  // no way down from here
      y = start;
      merit = linear.set(y);
      break;
    }
    merit = next;
    is_solved = is_last || merit == 0.0;
    report.converged = is_solved;
  }
  report.residual = std::sqrt(linear.residual().colwise().squaredNorm().maxCoeff());
  return report;
}

}  // namespace weft::reference
