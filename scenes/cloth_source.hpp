#pragma once

// Tested by tests/scenes/body_sources_test.cpp.

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <weft/custom_forces/law_info.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/mesh/rope.hpp>
#include <weft/mesh/surface_body.hpp>
#include <weft/scenes/characters/skin_source.hpp>
#include <weft/scenes/import/import_mesh.hpp>

namespace weft::scenes {

/// A surface of any triangles, most often from a file. Bodies share it: nobody changes it.
struct MeshGeometry {
  Surface surface;                             ///< in the body's own frame
  std::vector<import::NodeGroup> groups = {};  ///< for pins and regions
};

struct MeshBody {
  std::shared_ptr<const MeshGeometry> shape;
  Vector3<double> position{0, 0, 0};  ///< [m] of the origin of the surface
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double total_mass = 1.0;  ///< [kg], > 0
  MassLumping lumping = MassLumping::kArea;
  std::optional<double> center_mass_share = std::nullopt;  ///< as in BodyMass
};

/// Where the nodes and triangles of a body come from. Each has total_mass and lumping.
using ClothSource = std::variant<ClothGrid, Icosphere, Rope, MeshBody, SkinSource>;

/// Number of nodes of the mesh that make_source_mesh() builds, without building it.
[[nodiscard]] int num_nodes(const ClothSource& source);

/// The mesh without pins, regions and connections of a scene. Throws InvalidArgument as the builder
/// of the source.
[[nodiscard]] ClothMesh make_source_mesh(const ClothSource& source);

/// Length that errors are compared with [m]: of the longer side of a grid, the diameter of a sphere,
/// from end to end of a rope, the diagonal of the box around a mesh.
[[nodiscard]] double body_size(const ClothSource& source);

/// Names of the sets that the mesh of this source has for a law of this kind; empty for laws that
/// take no sets.
[[nodiscard]] std::vector<std::string> source_sets(const ClothSource& source,
                                                   forces::ElementKind elements);

/// What the source is in a message: "a grid", "an icosphere", "a rope",
/// "a mesh".
[[nodiscard]] std::string source_name(const ClothSource& source);

}  // namespace weft::scenes
