// Tested by tests/scenes/drawn_mesh_test.cpp.

#include <fmt/format.h>

#include <weft/scenes/format/mesh_text.hpp>
#include <weft/scenes/format/scene_text.hpp>

namespace weft::scenes {

void write_drawn_mesh(std::string& out, const DrawnCloth& drawn) {
  std::string text = drawn.part.empty() ? fmt::format("data = \"{}\"", mesh_text(*drawn.surface))
                                        : fmt::format("part = {}", toml_string(drawn.part));
  const auto add = [&](std::string_view key, const std::optional<double>& length) {
    if (length) text += fmt::format(", {} = {}", key, value_text(*length, "m"));
  };
  add("max_distance", drawn.embedding.max_distance);
  add("rigid_pieces", drawn.embedding.rigid_pieces);
  line(out, "drawn_mesh", "{ " + text + " }");
}

}  // namespace weft::scenes
