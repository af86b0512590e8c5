#pragma once

#include <functional>

#include <weft/core/types.hpp>

namespace weft::reference {

/// result = A vector.
using LinearMap = std::function<void(const VectorX<double>& vector, VectorX<double>& result)>;

struct KrylovOutcome {
  int iterations = 0;
  double residual =
      0.0;  ///< |right - A solution| over |right| [-], as the method's recurrence has it
};

/// Solves A solution = right by the generalised minimal residual method (Saad and Schultz 1986)
/// without restart, preconditioned from the right, from 0, until the residual is below tolerance
/// times |right|, or for max_iterations. A need not be symmetric.
[[nodiscard]] KrylovOutcome gmres(const LinearMap& a, const LinearMap& preconditioner,
                                  const VectorX<double>& right, double tolerance,
                                  int max_iterations, VectorX<double>& solution);

}  // namespace weft::reference
