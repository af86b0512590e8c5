#pragma once

// Tested by tests/custom_forces/body_sources_test.cpp, tests/mesh/topology/hinges_test.cpp.

#include <optional>

#include <weft/core/eigen_alignment.hpp>

#include <Eigen/Geometry>

#include <weft/mesh/surface_body.hpp>

namespace weft {

/// A sphere of triangles: an icosahedron whose faces are divided into frequency^2 triangles each,
/// the nodes moved out to the radius.
struct Icosphere {
  double radius = 1.0;              ///< [m], > 0
  int frequency = 4;                ///< parts of an icosahedron's edge, 1 to 512
  Vector3<double> center{0, 0, 0};  ///< [m]
  double total_mass = 1.0;          ///< [kg], > 0
  MassLumping lumping = MassLumping::kArea;
  /// With a value the sphere has a centre node with this part of the mass (surface_body.hpp).
  std::optional<double> center_mass_share = std::nullopt;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< unit length
};

/// Builds the mesh: 10 frequency^2 + 2 nodes, and the centre node as the last one; front faces
/// outward; edge sets "stretch" with the 30 frequency^2 edges, "bend" and, with a centre node,
/// "center". Texture coordinates of the corners: longitude / 360 degrees, from the local x axis
/// counter-clockwise about the local y axis, and 0 at the lower pole to 1 at the upper one. Throws
/// InvalidArgument for values out of their domain.
[[nodiscard]] ClothMesh make_icosphere(const Icosphere& sphere);

/// Area of the triangles [m^2], a little less than the sphere's. Throws as make_icosphere().
[[nodiscard]] double surface_area(const Icosphere& sphere);

}  // namespace weft
