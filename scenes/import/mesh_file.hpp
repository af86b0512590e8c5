#pragma once

// Tested by tests/scenes/import/import_test.cpp.

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <weft/core/error.hpp>
#include <weft/core/input_file.hpp>

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

/// A mesh file in memory.
struct MeshInput {
  std::filesystem::path name;  ///< in messages; its extension says the format
  std::string bytes;
  FileSource files = {};  ///< the buffers that a glTF file may name; without it none
};

/// The file at a path, with the files beside it and below. Throws ImportError: no such file, no
/// regular file, over 256 MB.
[[nodiscard]] MeshInput mesh_input(const std::filesystem::path& path);

/// Reads what an OBJ, glTF, GLB, PLY, FBX or STL file holds, in a process of its own. Of the files
/// that a mesh may name only the buffers of glTF are read (*.bin, *.glbin, *.glbuf): no material
/// library and no picture. Every vertex that a face or a group names exists; positions may be
/// anything. Throws ImportError: empty, unknown or damaged format, more than 10 million vertices or
/// corners, more time or memory than a file of this size may take.
[[nodiscard]] std::vector<FilePart> read_mesh_file(const MeshInput& input);

}  // namespace weft::import
