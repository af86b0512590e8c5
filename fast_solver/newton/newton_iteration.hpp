#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp.

#include <weft/fast_solver/newton/linear_gains.hpp>

namespace weft::fast {

/// One iteration of Newton's method.
struct NewtonIteration {
  int iterations;  ///< limit of conjugate gradients
  LinearAccuracy accuracy = {};
  double most_to_lengthen = 0;  ///< the most that it may gain to be lengthened [J]
  bool is_first = false;        ///< whether it is the first of a step
  bool decides = true;          ///< whether contact states are decided
  bool continues = false;  ///< in the first iteration: contact states of the last solve are kept
  /// Whether an iteration before has gained energy: friction must be linearized by what bounds it from above.
  bool is_cautious = false;
  bool linearizes = true;   ///< whether forces are linearized afterwards
  bool factorizes = false;  ///< whether the coarse matrix is factorized again
};

}  // namespace weft::fast
