#pragma once

#include <string>

#include <weft/core/types.hpp>

namespace weft::bench {

/// A damped cloth of 1 m with one state of rest, up to a mirror, in which it is 6 s after its start.
enum class RestDrape {
  kHammock,  ///< held along two opposite edges, which are 80 cm apart
  kBanner,   ///< held along one edge, let go when it lies flat
};

struct DrapeSolver {
  int rounds = 2;               ///< of the fast solver; 0: Bullet's links
  int iterations = 3;           ///< of the fast solver, or of Bullet
  double time_step = 1.0 / 60;  ///< [s]
};

/// Positions at the end, 3 x 441 [m].
[[nodiscard]] Matrix3X<double> rest_of(RestDrape drape, const DrapeSolver& solver);

/// Distances of nodes from those of another rest [m], or from its mirror image if that is nearer: the free corners of
/// a banner curl to either side.
[[nodiscard]] VectorX<double> distances(RestDrape drape, const Matrix3X<double>& rest,
                                        const Matrix3X<double>& other);

[[nodiscard]] std::string to_string(RestDrape drape);

}  // namespace weft::bench
