#pragma once

#include <optional>

#include <weft/core/types.hpp>
#include <weft/mesh/cloth_mesh.hpp>
#include <weft/validation/metrics/projected_area.hpp>

namespace weft::validation {

/// How a drape is looked at.
struct DrapeSetup {
  Vector3<double> up{0, 1, 0};              ///< against gravity, any length > 0 [-]
  Vector3<double> support_center{0, 0, 0};  ///< any point on the support's vertical axis [m]
  /// Radius of the disc or sphere under the cloth [m]; none: nothing to subtract.
  std::optional<double> support_radius = std::nullopt;
  /// Cell of the raster [m]; none: cusick_cell_size of the specimen.
  std::optional<double> cell_size = std::nullopt;
};

/// Drape coefficient after Cusick (BS 5058, ISO 9073-9), for a specimen of any outline on a support
/// of any size. All optional values are none if a position is not finite or the cloth is too large
/// for the raster.
struct Drape {
  double rest_area = 0.0;                ///< A_rest, the flat specimen [m^2]
  double support_area = 0.0;             ///< A_support, 0 without a support [m^2]
  double cell_size = 0.0;                ///< of the raster that was used [m]
  std::optional<double> projected_area;  ///< A_projected, the cloth seen from above [m^2]
  std::optional<double> area_ratio;      ///< A_projected / A_rest [-]
  /// (A_projected - A_support) / (A_rest - A_support) [-]: 1 for a stiff board, 0 for a cloth that
  /// hangs straight down. Times 100 it is the DC of the standards. Below 0 the cloth does not cover
  /// its support.
  std::optional<double> coefficient;
};

/// Measures the drape of a mesh in the given positions. The specimen is the mesh's rest shape seen
/// along its mean normal; all three areas are counted on rasters of one cell size.
/// Shapes   positions 3 x n [m], n as the mesh
/// Errors   InvalidArgument for a setup out of its domain, a mesh without rest area, a support not
///          smaller than the specimen, positions of another size
[[nodiscard]] Drape measure_drape(const ClothMesh& mesh, ConstMatrix3XRef<double> positions,
                                  const DrapeSetup& setup);

}  // namespace weft::validation
