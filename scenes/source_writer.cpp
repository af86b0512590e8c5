#include <fmt/format.h>

#include <weft/scenes/scene_text.hpp>
#include <weft/scenes/scene_words.hpp>

namespace weft::scenes {
namespace {

void write_geometry(std::string& out, const ClothGrid& grid) {
  line(out, "grid",
       fmt::format("{{ nodes = [{}, {}], size = [{}, {}], stencil = {} }}", grid.nodes[0],
                   grid.nodes[1], value_text(grid.size[0], "m"), value_text(grid.size[1], "m"),
                   word(kStencilWords, grid.stencil)));
  line(out, "center", vector_text(grid.center, "m"));
  line(out, "u_axis", vector_text(grid.u_axis, "1"));
  line(out, "v_axis", vector_text(grid.v_axis, "1"));
}

void write_geometry(std::string& out, const Icosphere& sphere) {
  std::string center_node = "center_node = false";
  if (sphere.center_mass_share) {
    center_node = fmt::format("center_node = true, center_mass_share = {}",
                              value_text(*sphere.center_mass_share, "1"));
  }
  line(out, "icosphere",
       fmt::format("{{ radius = {}, frequency = {}, {} }}", value_text(sphere.radius, "m"),
                   sphere.frequency, center_node));
  line(out, "center", vector_text(sphere.center, "m"));
  line(out, "orientation", orientation_text(sphere.orientation));
}

void write_geometry(std::string& out, const Rope& rope) {
  line(out, "rope",
       fmt::format("{{ nodes = {}, start = {}, end = {} }}", rope.nodes,
                   vector_text(rope.start, "m"), vector_text(rope.end, "m")));
}

}  // namespace

void write_source(std::string& out, const ClothSource& source) {
  std::visit(
      [&](const auto& s) {
        write_geometry(out, s);
        line(out, "mass", value_text(s.total_mass, "kg"));
        line(out, "mass_lumping", word(kLumpingWords, s.lumping));
      },
      source);
}

}  // namespace weft::scenes
