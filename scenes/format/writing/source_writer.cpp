// Tested by tests/scenes/body_sources_test.cpp.

#include <fmt/format.h>

#include <weft/scenes/format/mesh_text.hpp>
#include <weft/scenes/format/scene_text.hpp>
#include <weft/scenes/format/scene_words.hpp>

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

std::string center_text(const std::optional<double>& mass_share) {
  if (!mass_share) return "center_node = false";
  return fmt::format("center_node = true, center_mass_share = {}", value_text(*mass_share, "1"));
}

void write_geometry(std::string& out, const Icosphere& sphere) {
  line(out, "icosphere",
       fmt::format("{{ radius = {}, frequency = {}, {} }}", value_text(sphere.radius, "m"),
                   sphere.frequency, center_text(sphere.center_mass_share)));
  line(out, "center", vector_text(sphere.center, "m"));
  line(out, "orientation", orientation_text(sphere.orientation));
}

void write_geometry(std::string& out, const Rope& rope) {
  line(out, "rope",
       fmt::format("{{ nodes = {}, start = {}, end = {} }}", rope.nodes,
                   vector_text(rope.start, "m"), vector_text(rope.end, "m")));
}

/// The character says it.
void write_geometry(std::string&, const SkinSource&) {}

void write_geometry(std::string& out, const MeshBody& body) {
  line(out, "mesh",
       fmt::format("{{ data = \"{}\", {} }}", mesh_text(body.shape->surface),
                   center_text(body.center_mass_share)));
  line(out, "position", vector_text(body.position, "m"));
  line(out, "orientation", orientation_text(body.orientation));
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
