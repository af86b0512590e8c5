#pragma once

// Tested by tests/custom_forces/body_sources_test.cpp.

#include <optional>

#include <weft/mesh/cloth_mesh.hpp>

namespace weft {

/// A surface of triangles, as a generator or a file gives it.
struct Surface {
  Matrix3X<double> positions;                 ///< 3 x n [m]
  Triangles triangles;                        ///< 3 x t, counter-clockwise seen from the front
  Matrix2X<double> texture_coordinates = {};  ///< 2 x n or empty, as in ClothMesh
  Matrix2X<double> corner_texture_coordinates = {};  ///< 2 x 3t or empty, as in ClothMesh
};

/// What makes a body of a surface.
struct BodyMass {
  double total_mass = 1.0;  ///< [kg], > 0, the centre node's part included
  MassLumping lumping = MassLumping::kArea;
  /// With a value the body has a centre node with this part of the total mass, > 0 and < 1; the
  /// surface shares the rest.
  std::optional<double> center_mass_share = std::nullopt;
};

/// A share with which spokes as stiff as the surface's springs turn a centre node and a surface node
/// at about the same rate: n spokes on a tenth of the mass against the 6 edges, the spoke and the
/// bend springs on the n-th part of the rest.
inline constexpr double kCenterMassShare = 0.1;

/// Builds a body of any surface, open or closed: edge sets "stretch" (the edges) and "bend" (the two
/// far corners of each pair of neighboring triangles, unless an edge ties them already). The centre
/// node is the last node; it lies at the centroid of the surface, belongs to no triangle and is tied
/// to each other node by the edge set "center" (spokes) and the connection set "center" (the surface
/// node's frame counts, the centre is the far node).
/// Throws InvalidArgument, with the number of the node or triangle, for positions that are not
/// finite, a node of no triangle, a triangle that names no node of the surface or one twice or has
/// no area, an edge of three triangles, neighbors that do not turn the same way round, a centre node
/// that falls on the surface, and masses out of their domain.
[[nodiscard]] ClothMesh make_surface_body(const Surface& surface, const BodyMass& mass);

/// Area of all triangles [m^2].
[[nodiscard]] double surface_area(const Surface& surface);

}  // namespace weft
