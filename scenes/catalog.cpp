#include <weft/scenes/catalog.hpp>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/format/spelling.hpp>

namespace weft::scenes {

const CatalogEntry* find_catalog_scene(std::string_view name) {
  const std::span<const CatalogEntry> entries = scene_catalog();
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const CatalogEntry& entry) { return entry.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

Scene load_scene(const std::string& name_or_path) {
  if (const CatalogEntry* entry = find_catalog_scene(name_or_path)) {
    return read_scene_text(entry->text, std::string(entry->name) + ".toml");
  }
  std::error_code ignored;
  const bool looks_like_path = name_or_path.ends_with(".toml") ||
                               name_or_path.find('/') != std::string::npos ||
                               std::filesystem::exists(name_or_path, ignored);
  if (looks_like_path) return read_scene_file(name_or_path);
  std::vector<std::string_view> names;
  for (const CatalogEntry& entry : scene_catalog()) names.push_back(entry.name);
  throw InvalidArgument("scene = '" + shown(name_or_path) +
                        "': neither a scene of the catalog nor a file" +
                        suggestion(name_or_path, names));
}

}  // namespace weft::scenes
