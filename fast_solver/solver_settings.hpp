#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp.

namespace weft::fast {

/// Iteration limits and tolerance of one implicit step.
struct SolverSettings {
  int newton_iterations = 24;   ///< linearizations at most, >= 1
  int linear_iterations = 200;  ///< for conjugate gradients in each at most, >= 1
  /// The step is solved when the energy that is left to gain, over the energy of the step's motion without springs, is below the
  /// square of this [-].
  double tolerance = 0.001;
};

}  // namespace weft::fast
