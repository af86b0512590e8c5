// A mesh file; its format is told by its first bytes. assimp runs in a process of its own, as ever.
#include <string>

#include <weft/scenes/import/import_mesh.hpp>
#include "fuzz/fuzz_target.hpp"

namespace {

std::string extension_of(std::string_view bytes) {
  if (bytes.starts_with("ply")) return ".ply";
  if (bytes.starts_with("glTF")) return ".glb";
  if (bytes.starts_with("{")) return ".gltf";
  if (bytes.starts_with("Kaydara") || bytes.starts_with(";")) return ".fbx";
  if (bytes.starts_with("solid") || bytes.starts_with(std::string_view("\0\0", 2))) return ".stl";
  return ".obj";
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  const std::string_view bytes = fuzz::text_of(data, size);
  const import::MeshInput input{"input" + extension_of(bytes), std::string(bytes)};
  try {
    const import::ImportedMesh mesh = import::import_mesh(input);
    fuzz::require(mesh.surface.positions.allFinite(), "positions are finite");
    fuzz::require(mesh.surface.triangles.minCoeff() >= 0 &&
                      mesh.surface.triangles.maxCoeff() < mesh.surface.positions.cols(),
                  "triangles name nodes that are there");
  } catch (const import::ImportError& error) {
    const std::string_view message = error.what();
    fuzz::require(message.size() <= 2000, "an error is short");
    // At its beginning: what follows may quote the file, which may say so too.
    fuzz::require(!message.starts_with(input.name.string() + ": cannot be read: takes more than"),
                  "a small file is read in seconds");
  }
  return 0;
}
