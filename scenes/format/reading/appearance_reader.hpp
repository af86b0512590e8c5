#pragma once

// Tested by tests/scenes/appearance/appearance_test.cpp.

#include <array>
#include <string_view>

#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/format/toml_reader.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// Keys that read_appearance() reads, in cloths and in colliders.
inline constexpr std::array<std::string_view, 7> kClothAppearanceKeys = {
    "color", "back_color", "pattern_color", "texture", "texture_repeat", "smooth", "visible"};
inline constexpr std::array<std::string_view, 6> kColliderAppearanceKeys = {
    "color", "pattern_color", "texture", "texture_repeat", "smooth", "visible"};

/// Throws SceneError.
[[nodiscard]] Appearance read_appearance(const TomlTable& table);

/// Loads the files that the cloths and colliders of a scene name, each once. Throws SceneError at
/// the place that names one that is missing or no picture.
void load_appearance_files(const TomlTable& root, Scene& scene);

/// TOML lines of what is not as by default: a scene without appearances is written as ever.
[[nodiscard]] std::string write_appearance(const Appearance& appearance);

}  // namespace weft::scenes
