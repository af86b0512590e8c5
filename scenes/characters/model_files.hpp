#pragma once

// Tested by tests/scenes/characters_test.cpp.

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <weft/core/input_file.hpp>
#include <weft/scenes/characters/skin_source.hpp>

namespace weft::scenes {

/// A model that comes with Weft: a file under scenes/models, built into the library.
struct ModelFile {
  std::string_view name;
  std::span<const unsigned char> bytes;
};

[[nodiscard]] std::span<const ModelFile> model_files();

/// Largest model of a scene [bytes]: a recording keeps it.
inline constexpr std::size_t kMaxModelSize = std::size_t{8} * 1024 * 1024;

/// The model that a scene names: the text of model_uri(), one that comes with Weft, or one of the
/// files that the scene may name. Throws InvalidArgument for anything else, for a model that needs
/// other files, and for one that is too large.
[[nodiscard]] std::shared_ptr<const CharacterModel> load_model(const std::string& name,
                                                               const FileSource& files);

/// The whole model as a text, "data:model/gltf-binary;base64,...", so that a recording needs no file.
[[nodiscard]] std::string model_uri(const CharacterModel& model);

}  // namespace weft::scenes
