#pragma once

namespace weft::fast {

/// How well a step was solved: by Newton's method, each iteration of which minimizes a model of the step's energy
///
///   E(x) = m |x - y|^2 / (2 h'^2) + V(x)
///
/// A solution that is e away from the minimum has e^T H e / 2 more energy than it. Where no spring is compressed, H is at
/// least m / h'^2, and what is left to gain bounds the error: the root mean square of |e| over the mass is at most
/// h' sqrt(2 energy_left / m). Compressed springs push nodes aside, and a sheet that crumples may be farther off.
struct SolverReport {
  int newton_iterations = 0;  ///< linearizations
  double energy_left = 0.0;  ///< what more iterations would gain, from how the last ones shrank [J]
  bool is_converged =
      true;  ///< to the tolerance, or as far as rounding allows; false: the budget ended first
};

}  // namespace weft::fast
