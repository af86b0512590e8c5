#pragma once

// Tested by tests/reference/implicit_integrators_test.cpp.

#include <memory>

#include <weft/reference/integrators/integrator.hpp>
#include <weft/reference/rigid/body_dynamics.hpp>

namespace weft::reference {

/// The equation of a stage of an implicit method, for an unknown acceleration y, 3 x n:
///
///   M (accelerations + acceleration_gain y) = f(p, w, t),
///   p = positions + position_gain y,  w = velocities + velocity_gain y
///
/// y is 0 on pinned nodes, so that p and w are given there.
struct StageEquation {
  Matrix3X<double> positions;      ///< 3 x n [m]
  double position_gain = 0.0;      ///< [s^2], > 0
  Matrix3X<double> velocities;     ///< 3 x n [m/s]
  double velocity_gain = 0.0;      ///< [s], >= 0
  Matrix3X<double> accelerations;  ///< 3 x n [m/s^2]; empty: 0
  double acceleration_gain = 1.0;  ///< [-], > 0
  double time_in_step = 0.0;       ///< [s]
};

/// Newton's method with a line search on the sum of the squared forces that are left. The linear
/// systems are solved by gmres() with the exact derivative of all laws, preconditioned by a sparse
/// Cholesky factor of the symmetric part of that of the laws of short reach, shifted until it is
/// positive definite. The factor is kept for as long as it is good. Deterministic.
///
/// Ends after a step that moves no node by more than kNewtonStep of the body's size: convergence is
/// quadratic, so the error left is far below rounding.
class StageSolver {
 public:
  StageSolver();
  ~StageSolver();

  /// y: the first guess, and the solution. What was not reached is in the report: never throws for
  /// numbers.
  IntegrationReport solve(BodyDynamics& dynamics, const StageEquation& equation,
                          Matrix3X<double>& y);

 private:
  class Preconditioner;
  std::unique_ptr<Preconditioner> preconditioner_;
};

/// Newton's last step as a share of the largest coordinate of the body [-].
inline constexpr double kNewtonStep = 1e-11;
inline constexpr int kMaxNewtonIterations = 50;
/// Residual of the linear systems, relative [-]: with kNewtonStep, an error of 1e-19.
inline constexpr double kKrylovTolerance = 1e-8;
inline constexpr int kMaxKrylovIterations = 200;
/// Over all linear systems of one stage, a hundred times what a stage takes: more is a blow-up.
inline constexpr int kMaxStageIterations = 5000;
/// Iterations at which the factor is made anew: about what a factor costs.
inline constexpr int kStaleFactor = 12;

}  // namespace weft::reference
