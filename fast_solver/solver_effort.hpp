#pragma once

namespace weft::fast {

/// How much work a step is worth.
struct SolverEffort {
  int rounds = 2;      ///< linearisations, >= 1
  int iterations = 4;  ///< conjugate gradients in each, >= 1
};

}  // namespace weft::fast
