#pragma once

// Tested by tests/scenes/import/import_test.cpp.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <weft/mesh/surface_body.hpp>
#include <weft/scenes/import/mesh_file.hpp>
#include <weft/scenes/import/mesh_report.hpp>

namespace weft::import {

/// Which axis of the file points up. Weft's is y.
enum class UpAxis { kY, kZ };

struct ImportOptions {
  double scale = 1.0;  ///< metres per unit of the file, > 0
  UpAxis up = UpAxis::kY;
  std::string part = {};  ///< name of a node, mesh or material; empty: everything
  /// Vertices closer than this become one node [m], >= 0; none: a millionth of the mesh's diagonal,
  /// a few roundings of single precision.
  std::optional<double> weld_tolerance = std::nullopt;
  /// Whether a body shall be made of the mesh. What is only drawn may branch, turn its fronts anywhere and have flat triangles.
  bool is_body = true;
};

/// Nodes with a weight: a bone or vertex group of the file, or a part (weight 1 for its nodes).
struct NodeGroup {
  std::string name;
  std::vector<int> nodes;       ///< sorted
  std::vector<double> weights;  ///< of each of them [-]
  bool is_part = false;
};

struct ImportedMesh {
  Surface surface;  ///< texture coordinates per corner, if every part has some
  std::vector<NodeGroup> groups;
  MeshReport report;
};

/// Reads a mesh as a surface of which make_surface_body() makes a body. Polygons are cut into
/// triangles, fours along their shorter diagonal, others from their first corner; vertices at one
/// place are welded.
/// Throws ImportError, with the number of the face (from 0) and the name of its part, for what
/// read_mesh_file() refuses, a part that is not there, positions that are not finite, and everything
/// that MeshReport::fault() says; without is_body only a mesh without a triangle.
[[nodiscard]] ImportedMesh import_mesh(const MeshInput& input, const ImportOptions& options = {});
/// The same for mesh_input(file).
[[nodiscard]] ImportedMesh import_mesh(const std::filesystem::path& file,
                                       const ImportOptions& options = {});

/// The same for a mesh with faults, which are in the report. Throws ImportError if there is nothing to
/// report on.
[[nodiscard]] MeshReport check_mesh(const std::filesystem::path& file,
                                    const ImportOptions& options = {});

}  // namespace weft::import
