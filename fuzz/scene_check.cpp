#include "fuzz/scene_check.hpp"

#include <optional>
#include <string>

#include "fuzz/fuzz_target.hpp"

namespace weft::fuzz {

void check_scene_text(std::string_view text, const FileSource& files) {
  std::optional<scenes::Scene> scene;
  std::string written;
  try {
    scene = scenes::read_scene_text(text, "input.toml", files);
    written = scenes::write_scene(*scene);
  } catch (const InvalidArgument& error) {
    require_clear(error.what());
    return;
  }
  try {
    const FileSource own = scenes::files_of(*scene);
    const scenes::Scene again = scenes::read_scene_text(written, "written.toml", own);
    require(scenes::write_scene(again) == written, "a written scene reads back to the same text");
  } catch (const InvalidArgument& error) {
    require(false, std::string("a written scene can be read: ") + error.what());
  }
}

}  // namespace weft::fuzz
