#pragma once

#include <string>

#include <weft/scenes/output/output_folder.hpp>

namespace weft::app {

/// The folder for the scenes that recordings can be judged by; belongs to Weft once it is filled.
[[nodiscard]] output::OutputFolder judged_scenes_folder(const std::string& path);

/// Writes every scene of which a recording can be judged, for other programs: SCENE.toml, and an OBJ file SCENE_BODY.obj for each body
/// but planes, with cloth where it starts and colliders in their own frame. Scenes that differ in their number of nodes have it in
/// their name. Returns the number of scenes.
int write_judged_scenes(const output::OutputFolder& folder);

}  // namespace weft::app
