#pragma once

// Tested by tests/validation/cases/analytic/bending/elastica_test.cpp.

#include <weft/mesh/cloth_mesh.hpp>

namespace weft::validation {

/// A direction in which a square grid repeats: tan(angle) = p / q.
struct LatticeDirection {
  int p = 0;
  int q = 1;
  [[nodiscard]] double angle() const;   ///< [deg]
  [[nodiscard]] double period() const;  ///< in cells: sqrt(p^2 + q^2)
};

/// The direction next to an angle of 0 to 90 degrees, of those with p, q <= 12.
[[nodiscard]] LatticeDirection nearest_direction(double degrees);

/// A piece of a square grid whose lines run at an angle to x, clamped left of x = 0 and with its free end at
/// x = length [m], about cells times as long as its spacing; along -z two periods and more, so that the middle
/// one has all its neighbors. Masses are those of an endless sheet with a sharp end, of density [kg/m^2]. The nodes
/// behind the clamp are pinned. Edge set "net". Where a cell sticks out of the end its triangles remain as far
/// as they have all corners.
[[nodiscard]] ClothMesh make_lattice_strip(const LatticeDirection& direction, int cells,
                                           double length, double density);

}  // namespace weft::validation
