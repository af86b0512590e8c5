#pragma once

// Tested by tests/validation/metrics/drape_test.cpp.

#include <optional>

#include <weft/core/types.hpp>

namespace weft::validation {

/// A fixed raster in a plane. Areas that are compared must be counted on one and the same raster:
/// its discretisation error then cancels in their ratio.
struct ProjectionRaster {
  Vector3<double> direction{0, 1, 0};  ///< normal of the plane, any length > 0 [-]
  Vector3<double> center{0, 0, 0};     ///< a corner of four cells projects from here [m]
  double cell_size = 0.01;             ///< [m], > 0
};

/// Cell size that gives a specimen of this area [m^2] the resolution of a Cusick test on a 0.25 mm
/// raster: 1200 cells across the disc of equal area. A 0.30 m disc gives 0.25 mm. Throws
/// InvalidArgument unless area > 0.
[[nodiscard]] double cusick_cell_size(double specimen_area);

/// Area of the parallel projection of a surface along the raster's direction [m^2]: cells whose
/// centre lies in at least one projected triangle, edges included; what overlaps counts once.
/// None if a position is not finite or the projection would need more than kMaxProjectedCells.
/// Shapes   positions 3 x n [m], triangles 3 x t
/// Errors   InvalidArgument for a raster out of its domain and for node indices out of range
[[nodiscard]] std::optional<double> projected_area(ConstMatrix3XRef<double> positions,
                                                   const Triangles& triangles,
                                                   const ProjectionRaster& raster);

/// Area of a disc around the raster's centre, counted on the raster [m^2]. Throws InvalidArgument
/// for a raster or a radius [m] out of its domain, and for a disc of more than kMaxProjectedCells.
[[nodiscard]] double disc_area(double radius, const ProjectionRaster& raster);

/// Largest bounding rectangle of a projection [cells], one byte each: 8192 x 8192, seven times a
/// specimen's 1200 in each direction. A cloth that flew apart further has no drape.
inline constexpr double kMaxProjectedCells = 0x1p26;

}  // namespace weft::validation
