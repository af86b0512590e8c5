#pragma once

namespace weft::validation {

/// A heavy elastic strip clamped horizontally, as a fraction of its length.
struct HeavyElastica {
  double drop = 0.0;       ///< H / L [-], of the tip
  double reach = 0.0;      ///< W / L [-], of the tip
  double curvature = 0.0;  ///< at the clamp, times L [rad]
};

/// Solves theta'' + gamma (1 - s) cos(theta) = 0, theta(0) = 0, theta'(1) = 0 by shooting with
/// Runge-Kutta 4; gamma = rho g L^3 / D [-], 0 < gamma <= 200. Within 1e-7 of the exact solution for
/// gamma <= 100. Throws InvalidArgument for other gamma.
[[nodiscard]] HeavyElastica solve_heavy_elastica(double gamma);

}  // namespace weft::validation
