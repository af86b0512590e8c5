#pragma once

#include <weft/custom_forces/core/cloth_mesh.hpp>

namespace weft {

/// A sphere of triangles: an icosahedron whose faces are divided into frequency^2 triangles each,
/// the nodes moved out to the radius.
struct Icosphere {
  double radius = 1.0;              ///< [m], > 0
  int frequency = 4;                ///< parts of an icosahedron's edge, 1 to 512
  Vector3<double> center{0, 0, 0};  ///< [m]
  double total_mass = 1.0;          ///< [kg], > 0, shared out by rest area
};

/// Builds the mesh: 10 frequency^2 + 2 nodes, front faces outward, one edge set "stretch" with the
/// 30 frequency^2 edges. Throws InvalidArgument for values out of their domain.
[[nodiscard]] ClothMesh make_icosphere(const Icosphere& sphere);

}  // namespace weft
