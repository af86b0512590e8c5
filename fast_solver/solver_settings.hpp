#pragma once

namespace weft::fast {

/// How much work a step is worth.
struct SolverSettings {
  int newton_iterations = 24;  ///< linearizations at most, >= 1
  int linear_iterations = 32;  ///< of conjugate gradients in each at most, >= 1
  /// When a step is done: what is left to gain, over the energy of the step's motion without springs, is less than the square
  /// of this [-].
  double tolerance = 0.001;
};

}  // namespace weft::fast
