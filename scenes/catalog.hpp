#pragma once

#include <span>
#include <string_view>

#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// A scene that comes with Weft: a TOML file under scenes/catalog, built into the library.
struct CatalogEntry {
  std::string_view name;
  std::string_view text;  ///< the file's text
};

[[nodiscard]] std::span<const CatalogEntry> scene_catalog();
[[nodiscard]] const CatalogEntry* find_catalog_scene(std::string_view name);

/// A catalog name, or else a path of a scene file. Throws SceneError, and InvalidArgument with a
/// suggestion for a name that is neither.
[[nodiscard]] Scene load_scene(const std::string& name_or_path);

}  // namespace weft::scenes
