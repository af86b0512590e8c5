#pragma once

// Tested by tests/validation/theory_test.cpp.

#include <functional>
#include <vector>

#include <weft/reference/statics/static_solver.hpp>
#include <weft/reference/system.hpp>

namespace weft::validation {

/// Angular frequency of a small swing of a body in a mode about its present state [rad/s]: velocity Verlet, and
/// a least-squares fit of q'' = -w^2 q to the amplitude q, which counts the scheme's own steps, so that for
/// a mode of the body the result is exact for every step. NaN if the body blows up.
/// Shapes   mode 3 x n [-], largest component about 1; amplitude [m]; step [s]
[[nodiscard]] double swing_frequency(const std::function<reference::Body()>& make,
                                     const Matrix3X<double>& mode, double amplitude, double step,
                                     int num_steps);

/// A mode of small vibration about an equilibrium.
struct Mode {
  double omega_squared = 0.0;  ///< [rad^2/s^2]
  Matrix3X<double> shape;      ///< 3 x n, largest component 1; 0 where nodes are fixed
};

/// The slowest modes of a static problem about positions, slowest first, that start from a motion along y:
/// inverse iteration, each step one solution under a load so small that the response is linear. length: of the
/// body [m]. Fewer than count if an iteration fails.
[[nodiscard]] std::vector<Mode> slowest_modes(const reference::StaticProblem& problem,
                                              const Matrix3X<double>& positions,
                                              const VectorX<double>& masses, int count,
                                              double length);

}  // namespace weft::validation
