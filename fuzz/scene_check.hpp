#pragma once

#include <string_view>

#include <weft/scenes/format/scene_file.hpp>

namespace weft::fuzz {

/// Reads a scene. A scene that can be read and written reads back to the same text, without any file
/// but those that it has taken along.
void check_scene_text(std::string_view text, const FileSource& files);

}  // namespace weft::fuzz
