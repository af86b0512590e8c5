#pragma once

// Tested by tests/bridge/implicit/step_error_test.cpp.

namespace weft::fast {

/// How accurately a step was solved. Each Newton iteration minimizes a quadratic model of the incremental potential
///
///   E(x) = m |x - y|^2 / (2 h'^2) + V(x)
///
/// A solution with the error e has e^T H e / 2 more energy than the minimum, H the Hessian. If no spring is compressed, H is at
/// least m / h'^2. Then the root mean square of |e| over the mass is at most h' sqrt(2 energy_left / m). Compressed springs
/// soften H, so that the error of a crumpled sheet may be larger.
struct SolverReport {
  int newton_iterations = 0;  ///< linearizations
  double energy_left = 0.0;  ///< what more iterations would gain, from how the last ones shrank [J]
  bool is_converged =
      true;  ///< to the tolerance, or as far as rounding allows; false: the budget ended first
};

}  // namespace weft::fast
