#pragma once

namespace weft::validation {

/// An elastic strip clamped at one end, under its own weight and a weight at its tip.
struct ElasticaLoad {
  double gamma = 0.0;     ///< rho g L^3 / D [-], of its own weight
  double tip_load = 0.0;  ///< P L^2 / D [-], of a weight at the tip
  double tilt = 0.0;      ///< of the clamp below the horizontal [rad]
};

/// Its equilibrium, as a fraction of its length.
struct HeavyElastica {
  double drop = 0.0;       ///< H / L [-], of the tip
  double reach = 0.0;      ///< W / L [-], of the tip
  double curvature = 0.0;  ///< at the clamp, times L [rad]
  double tip_angle = 0.0;  ///< below the horizontal [rad]
};

/// Solves theta'' + (gamma (1 - s) + tip_load) cos(theta) = 0, theta(0) = tilt, theta'(1) = 0 by shooting
/// from the tip with Runge-Kutta 4: there the solution grows and no digit is lost, so that gamma may be large.
/// Within 1e-8 of the exact solution for gamma <= 500. Throws InvalidArgument unless 0 <= gamma <= 1e4,
/// 0 <= tip_load <= 1e3, one of both > 0, and |tilt| <= 1.5.
[[nodiscard]] HeavyElastica solve_elastica(const ElasticaLoad& load);

/// The same without a tip load and with a horizontal clamp.
[[nodiscard]] HeavyElastica solve_heavy_elastica(double gamma);

/// gamma at which the chord from the clamp to the tip hangs angle [rad] below the horizontal, 0 < angle < 1.4.
[[nodiscard]] double gamma_of_chord(double angle);

}  // namespace weft::validation
