#pragma once

// Tested by tests/scenes/import/import_test.cpp.

#include <memory>
#include <vector>

#include <weft/scenes/import/mesh_file.hpp>

struct aiScene;
namespace Assimp {
class Importer;
}

namespace weft::import {

/// A file as assimp reads it, unchanged: no step of assimp's that would renumber faces or vertices.
class AssimpFile {
 public:
  explicit AssimpFile(const MeshInput& input);
  ~AssimpFile();
  AssimpFile(const AssimpFile&) = delete;
  AssimpFile& operator=(const AssimpFile&) = delete;
  [[nodiscard]] const aiScene& operator*() const { return *scene_; }

 private:
  std::unique_ptr<Assimp::Importer> importer_;
  const aiScene* scene_ = nullptr;
};

/// Only within run_isolated(): a damaged file can bring assimp down. Throws Error with assimp's
/// message, or with the file that it was not given.
[[nodiscard]] AssimpFile load_assimp(const MeshInput& input);

/// The meshes of a scene where its nodes put them. Throws Error for a scene that is not consistent
/// or too large.
[[nodiscard]] std::vector<FilePart> parts_of(const aiScene& scene);

}  // namespace weft::import
