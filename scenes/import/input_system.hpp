#pragma once

// Tested by tests/scenes/import/import_test.cpp.

#include <string>

#include <assimp/IOSystem.hpp>

#include <weft/scenes/import/mesh_file.hpp>

namespace weft::import {

/// The file system as assimp sees it: the mesh itself, from memory, and the buffers that a glTF mesh
/// names, from its FileSource. Whatever else assimp asks for is not there, and nothing is written.
class InputSystem final : public Assimp::IOSystem {
 public:
  explicit InputSystem(const MeshInput& input);

  /// The name under which assimp finds the mesh: without a folder, so that the names of its buffers
  /// come as the file spells them.
  [[nodiscard]] const std::string& mesh_name() const { return mesh_name_; }
  /// Why the first file that was asked for in vain was not given; empty if there is none.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

  [[nodiscard]] bool Exists(const char* name) const override;
  [[nodiscard]] char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

 private:
  [[nodiscard]] std::optional<std::string> content_of(const std::string& name);

  const MeshInput& input_;
  std::string mesh_name_;
  std::string refusal_;
};

}  // namespace weft::import
