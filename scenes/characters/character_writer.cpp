// Tested by tests/scenes/characters_test.cpp.

#include <algorithm>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/characters/model_files.hpp>
#include <weft/scenes/format/reading/appearance_reader.hpp>
#include <weft/scenes/format/scene_text.hpp>
#include <weft/scenes/format/scene_words.hpp>

namespace weft::scenes {
namespace {

template <class Body>
const Body& find_body(const std::vector<Body>& bodies, const std::string& name) {
  const auto found =
      std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.name == name; });
  if (found == bodies.end()) {
    throw InvalidArgument("write_scene: '" + name + "' of a character is not in the scene");
  }
  return *found;
}

struct PaintText {
  std::string operator()(const PaintedColor& color) const {
    return fmt::format("{{ color = {} }}", word(kChannelWords, color.channel));
  }
  std::string operator()(const PaintedGroup& group) const {
    return fmt::format("{{ group = {} }}", toml_string(group.bone));
  }
};

void write_reach(std::string& out, const ReachSettings& reach) {
  if (reach.max_distance) line(out, "max_distance", value_text(*reach.max_distance, "m"));
  if (reach.paint) line(out, "paint", std::visit(PaintText{}, *reach.paint));
  if (reach.backstop_radius > 0) {
    line(out, "backstop_radius", value_text(reach.backstop_radius, "m"));
    line(out, "backstop_offset", value_text(reach.backstop_offset, "m"));
  }
}

void write_part(std::string& out, const CharacterCloth& entry, const Cloth& cloth) {
  out += "\n[[character.cloth]]\n";
  line(out, "part", toml_string(entry.part));
  line(out, "name", toml_string(cloth.name));
  write_source(out, cloth.source);
  line(out, "collision_margin", value_text(cloth.collision_margin, "m"));
  line(out, "friction", value_text(cloth.friction, "1"));
  write_reach(out, entry.reach);
  out += write_appearance(cloth.appearance);
  if (cloth.drawn_mesh) write_drawn_mesh(out, *cloth.drawn_mesh);
  for (const forces::LawSpecification& law : cloth.laws) {
    write_law(out, "character.cloth.law", law);
  }
}

void write_bone_collider(std::string& out, const CharacterCollider& entry, Collider collider) {
  out += "\n[[character.collider]]\n";
  line(out, "bone", toml_string(entry.bone));
  collider.position = entry.place.position;
  collider.orientation = entry.place.orientation;
  write_collider_keys(out, collider);
}

}  // namespace

void write_character(std::string& out, const CharacterSettings& settings, const Scene& scene) {
  out += "\n[[character]]\n";
  line(out, "name", toml_string(settings.name));
  line(out, "file", toml_string(model_uri(*settings.model)));
  if (settings.pose.clip) {
    const auto& clips = settings.model->character.clips;
    line(out, "clip", toml_string(clips.at(*settings.pose.clip).name));
  }
  line(out, "loop", settings.pose.loop ? "true" : "false");
  line(out, "scale", value_text(settings.pose.scale, "1"));
  line(out, "position", vector_text(settings.pose.place.position, "m"));
  line(out, "orientation", orientation_text(settings.pose.place.orientation));
  out += write_appearance(settings.appearance);
  for (const CharacterCloth& entry : settings.cloths) {
    write_part(out, entry, find_body(scene.cloths, entry.cloth));
  }
  for (const CharacterCollider& entry : settings.colliders) {
    write_bone_collider(out, entry, find_body(scene.colliders, entry.collider));
  }
}

}  // namespace weft::scenes
