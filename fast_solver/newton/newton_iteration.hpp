#pragma once

namespace weft::fast {

/// What a linear system of Newton's method gains, twice an energy of the linear model [J]: what its solution takes away, and
/// of that, what the last iterations did, which tells how much is left.
struct LinearGain {
  double total = 0;
  double left = 0;
  bool is_broken = false;  ///< by rounding, before anything was found out
};

/// One iteration of Newton's method.
struct NewtonIteration {
  int iterations;         ///< of conjugate gradients at most
  bool is_first = false;  ///< of a step
  bool decides = true;    ///< how contacts hold nodes
  bool continues =
      false;  ///< in the first iteration: a node that was held in the solve before stays so
  bool linearizes = true;   ///< for another iteration
  bool factorizes = false;  ///< makes the coarse correction anew
  double least_gain = 0;    ///< of an iteration that another one follows [J]
};

}  // namespace weft::fast
