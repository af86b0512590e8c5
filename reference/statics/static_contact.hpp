#pragma once

#include <weft/reference/statics/static_solver.hpp>

namespace weft::reference {

struct StaticContactOutcome {
  StaticOutcome solution;           ///< of the last inner problem
  bool converged = false;           ///< inner residual and depth are both below their bounds
  int rounds = 0;                   ///< how often contact forces were updated
  double depth = 0.0;               ///< [m] largest by which a node is nearer than its margin
  Matrix3X<double> contact_forces;  ///< 3 x n [N]
};

/// Depth at which contact counts as solved, as a part of the margin or, without one, of 1 m [-].
inline constexpr double kContactDepth = 1e-9;

/// Equilibrium of a body under its laws and frictionless contact of its nodes with colliders: forces
/// along the normals, >= 0, and 0 off the surface. Contact forces are Lagrange multipliers, found by
/// the method of Hestenes and Powell: each inner problem, solved by solve_statics(), has springs at
/// the surface besides, whose forces become multipliers until the springs carry nothing. So the
/// solution does not depend on them. problem: static_problem() of the same body.
[[nodiscard]] StaticContactOutcome solve_static_contact(const StaticProblem& problem,
                                                        const Body& body,
                                                        const std::vector<Collider>& colliders,
                                                        Matrix3X<double>& positions,
                                                        const StaticOptions& options = {});

}  // namespace weft::reference
