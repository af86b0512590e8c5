#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <weft/custom_forces/core/error.hpp>

namespace weft::import {

/// A mesh file that cannot be used. what() is "file: what is wrong", one line.
class ImportError : public InvalidArgument {
 public:
  ImportError(const std::filesystem::path& file, const std::string& message)
      : InvalidArgument(file.string() + ": " + message) {}
};

/// Weights of the vertices that a bone or a vertex group of the file names.
struct FileGroup {
  std::string name;
  std::vector<std::pair<int, double>> weights;  ///< vertex of the part, weight [-]
};

/// One mesh at one place of the file's scene.
struct FilePart {
  std::string node;               ///< name of the place
  std::string mesh;               ///< name of the mesh; if it and node have none, that of the file
  std::string material;           ///< name of its material
  std::vector<double> positions;  ///< 3 per vertex, in the axes and unit of the file
  std::vector<double> texture_coordinates;   ///< 2 per vertex, or empty
  std::vector<std::vector<int>> faces = {};  ///< vertices of each polygon, in the file's order
  std::vector<FileGroup> groups = {};
  [[nodiscard]] int num_vertices() const { return static_cast<int>(positions.size() / 3); }
};

/// Reads what a file of any format that assimp knows (OBJ, glTF, GLB, PLY, FBX, STL, ...) holds, in
/// a process of its own. Every vertex that a face or a group names exists; positions may be anything.
/// Throws ImportError: no such file, over 256 MB, unknown or damaged format, more than 10 million
/// vertices or corners.
[[nodiscard]] std::vector<FilePart> read_mesh_file(const std::filesystem::path& path);

}  // namespace weft::import
