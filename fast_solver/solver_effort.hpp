#pragma once

namespace weft::fast {

/// How much work a step is worth.
struct SolverEffort {
  int rounds = 2;  ///< linearisations, >= 1
  /// Conjugate gradients in each, >= 1. Where nothing touches the body the first of several takes one, and the last a
  /// quarter more.
  int iterations = 4;
};

}  // namespace weft::fast
