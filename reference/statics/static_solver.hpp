#pragma once

#include <functional>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/reference/system.hpp>

namespace weft::reference {

/// Forces that shall vanish: a body's, or those of a model with fewer unknowns.
struct StaticProblem {
  using Forces = std::function<void(const Matrix3X<double>& positions, Matrix3X<double>& forces)>;
  using Product =
      std::function<void(const Matrix3X<double>& positions, const Matrix3X<double>& displacements,
                         Matrix3X<double>& product)>;
  Forces forces;              ///< forces = f(positions), 3 x n [N]
  Product stiffness_product;  ///< product = (df/dx) displacements, 3 x n [N]
  Edges coupled;              ///< coupling.hpp
  std::vector<bool> fixed;    ///< n; nodes whose position is given
  double load = 1.0;          ///< [N] what residuals are measured against, > 0
};

struct StaticOptions {
  double residual = 1e-10;  ///< largest force on a free node at the end, as a part of the load [-]
  int max_iterations = 200;
  double max_move = 0.1;  ///< longest move of a node in one iteration [m]
};

struct StaticOutcome {
  bool converged = false;
  double residual = 0.0;  ///< largest force on a free node over the load [-]
  int iterations = 0;
};

/// Newton's method from the given positions. Where the stiffness is not positive definite it is
/// shifted until it is, so that the iteration goes downhill and does not stop at an unstable
/// equilibrium on its way; a line search keeps it from leaping over the next low place. The matrix is assembled from products with the stiffness, one for all
/// nodes of a colour and each axis. A failure is in the outcome.
[[nodiscard]] StaticOutcome solve_statics(const StaticProblem& problem, Matrix3X<double>& positions,
                                          const StaticOptions& options = {});

/// The problem of a body at rest under its laws, velocities 0. load: largest force of the laws named
/// external on all nodes together; throws as coupled_nodes(). The body must outlive the problem.
[[nodiscard]] StaticProblem static_problem(Body& body, double load);

}  // namespace weft::reference
