#pragma once

// Tested by tests/validation/cases/analytic/bending/elastica_test.cpp.

namespace weft::validation {

/// A weightless strip, clamped at one end and pinned at the other, that is pressed together along its clamp's
/// direction.
struct PinnedElastica {
  double compression = 0.0;  ///< delta / L [-]
  double force = 0.0;        ///< P L^2 / D [-], along the clamp's direction
  double ratio = 0.0;        ///< sideways force over P [-]: the friction that holds the tip
  double tip_angle = 0.0;    ///< of the tangent at the tip to the clamp's direction [rad], > 0
};

/// Solves theta'' + F sin(theta - beta) = 0, theta(0) = 0, theta'(1) = 0, integral of sin(theta) = 0 for the first
/// mode, by the angle of the tip: shooting with Runge-Kutta 4 and Newton's method for F and beta. Within 1e-6 for
/// compressions up to 0.5. Throws InvalidArgument unless 0 < ratio <= 0.5.
[[nodiscard]] PinnedElastica pinned_elastica_of_ratio(double ratio);

/// The same for a compression, 0 < compression <= 0.45.
[[nodiscard]] PinnedElastica pinned_elastica_of_compression(double compression);

}  // namespace weft::validation
