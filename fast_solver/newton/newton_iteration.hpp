#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp.

namespace weft::fast {

/// The energies that a linear solve gains, each twice the decrease of the quadratic model [J]: that of all iterations, and that
/// of the last few. The latter estimates what is left to gain (Strakos and Tichy 2002).
struct LinearGain {
  double total = 0;
  double left = 0;
  bool is_broken = false;  ///< by rounding, before anything was found out
};

/// One iteration of Newton's method.
struct NewtonIteration {
  int iterations;           ///< limit of conjugate gradients
  bool is_first = false;    ///< whether it is the first of a step
  bool decides = true;      ///< whether contact states are decided
  bool continues = false;   ///< in the first iteration: contact states of the last solve are kept
  bool linearizes = true;   ///< whether forces are linearized afterwards
  bool factorizes = false;  ///< whether the coarse matrix is factorized again
  double least_gain = 0;    ///< stop the linear solve below this gain [J]
};

}  // namespace weft::fast
