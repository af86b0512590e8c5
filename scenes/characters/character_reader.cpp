// Tested by tests/scenes/characters_test.cpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/characters/character_controller.hpp>
#include <weft/scenes/characters/model_files.hpp>
#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/appearance_reader.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/format/scene_words.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 9> kCharacterKeys = {
    "name", "file", "clip", "loop", "scale", "position", "orientation", "cloth", "collider"};
constexpr std::array<std::string_view, 13> kPartKeys = {
    "part",      "name",         "mass",  "areal_density",   "mass_lumping",    "collision_margin",
    "friction",  "max_distance", "paint", "backstop_radius", "backstop_offset", "law",
    "drawn_mesh"};
constexpr std::array<std::string_view, 2> kPaintKeys = {"color", "group"};
constexpr std::array<std::string_view, 3> kDrawnKeys = {"part", "max_distance", "rigid_pieces"};
constexpr std::array<std::string_view, 1> kBoneKeys = {"bone"};

/// Runs what may refuse a name or a value of the model, and says where the scene asks for it.
template <class Call>
decltype(auto) at(const TomlValue& value, const Call& call) {
  try {
    return call();
  } catch (const SceneError&) {
    throw;
  } catch (const InvalidArgument& error) {
    value.fail(error.what());
  }
}

void allow_with_appearance(const TomlTable& table, Keys own) {
  std::vector<std::string_view> keys(own.begin(), own.end());
  keys.insert(keys.end(), kClothAppearanceKeys.begin(), kClothAppearanceKeys.end());
  table.allow(keys);
}

/// A name of the model as a name of the scene: letters, digits, '_' and '-'.
std::string scene_name(const std::string& character, const std::string& part) {
  std::string name = character + "-" + part;
  for (char& c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!is_plain) c = '_';
  }
  return name;
}

CharacterPose read_pose(const TomlTable& table, const CharacterModel& model) {
  CharacterPose pose;
  if (const auto value = table.find("clip")) {
    const auto& clips = model.character.clips;
    const std::string name = value->text();
    const characters::Clip& clip =
        at(*value, [&]() -> const characters::Clip& { return find_clip(model.character, name); });
    pose.clip = static_cast<std::size_t>(&clip - clips.data());
  }
  if (const auto value = table.find("loop")) pose.loop = value->boolean();
  if (const auto value = table.find("scale")) pose.scale = value->positive("1");
  if (const auto value = table.find("position")) pose.place.position = value->vector("m");
  if (const auto value = table.find("orientation")) {
    pose.place.orientation = read_orientation(*value);
  }
  return pose;
}

Paint read_paint(const TomlTable& table) {
  table.allow(kPaintKeys);
  const auto color = table.find("color");
  const auto group = table.find("group");
  if (color.has_value() == group.has_value()) table.fail("expected exactly one of color, group");
  if (group) return PaintedGroup{group->text()};
  return PaintedColor{static_cast<int>(color->choice(kChannelWords, "colour channel"))};
}

ReachSettings read_reach(const TomlTable& table, const SkinSource& source) {
  ReachSettings reach;
  if (const auto value = table.find("max_distance")) reach.max_distance = value->non_negative("m");
  if (const auto value = table.find("backstop_radius")) {
    reach.backstop_radius = value->non_negative("m");
  }
  if (const auto value = table.find("backstop_offset")) {
    if (!table.has("backstop_radius")) value->fail("expected a backstop_radius as well");
    reach.backstop_offset = value->non_negative("m");
  }
  if (const auto value = table.find("paint")) {
    reach.paint = read_paint(value->table("a table such as { color = \"red\" }"));
    at(*value, [&] { return max_distances(reach, source); });
  }
  return reach;
}

double read_mass(const TomlTable& table, const SkinSource& source) {
  const auto mass = table.find("mass");
  const auto density = table.find("areal_density");
  if (mass && density) density->fail("mass is given too, expected exactly one of the two");
  if (mass) return mass->positive("kg");
  if (!density) {
    table.fail("missing key 'mass' or 'areal_density', expected exactly one of the two");
  }
  const double total = density->positive("kg/m^2") * skin_area(source);
  if (!(total > 0) || !std::isfinite(total)) {
    density->fail(
        fmt::format("makes a mass of {}, expected > 0 and finite", format_quantity(total, "kg")));
  }
  return total;
}

std::vector<int> attached_nodes(const ReachSettings& reach, const SkinSource& source) {
  const VectorX<double> distances = max_distances(reach, source);
  std::vector<int> nodes;
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    if (distances[i] == 0) nodes.push_back(static_cast<int>(i));
  }
  return nodes;
}

/// Parts of the model by their common name, which no other cloth has taken.
std::vector<int> claim_parts(const TomlValue& part, const CharacterSettings& settings,
                             std::vector<bool>& is_taken) {
  const std::vector<int> parts =
      at(part, [&] { return find_parts(settings.model->character, part.text()); });
  for (const int p : parts) {
    if (is_taken[static_cast<std::size_t>(p)]) {
      part.fail("is a cloth already, expected another part");
    }
    is_taken[static_cast<std::size_t>(p)] = true;
  }
  return parts;
}

/// The source of some parts of the model as one body.
SkinSource make_source(const CharacterSettings& settings, const std::vector<int>& parts,
                       bool is_cloth) {
  SkinSource source;
  source.model = settings.model;
  source.pose = settings.pose;
  source.is_cloth = is_cloth;
  const auto weld = is_cloth ? characters::Weld::kSamePlace : characters::Weld::kSameSkin;
  source.part =
      std::make_shared<characters::Part>(merged_part(settings.model->character, parts, weld));
  return source;
}

/// Its positions are those of the model's rest pose, as the rest positions of the cloth.
DrawnCloth read_drawn_part(const TomlValue& value, const CharacterSettings& settings,
                           std::vector<bool>& is_taken) {
  const TomlTable table = value.table("a table such as { part = \"Cape fine\" }");
  table.allow(kDrawnKeys);
  const TomlValue part = table.require("part", "the name of a part of the model");
  SkinSource source = make_source(settings, claim_parts(part, settings, is_taken), false);
  if (source.part->triangles.cols() == 0) part.fail("has no triangles, expected a surface");
  Surface surface;
  surface.positions = rest_positions(source);
  surface.triangles = source.part->triangles;
  surface.corner_texture_coordinates = source.part->corner_texture_coordinates;
  DrawnCloth drawn;
  drawn.surface = std::make_shared<const Surface>(std::move(surface));
  drawn.part = part.text();
  drawn.embedding = read_embedding(table);
  return drawn;
}

void read_part(const TomlTable& table, const World& world, CharacterSettings& settings,
               std::vector<bool>& is_taken, Scene& scene) {
  allow_with_appearance(table, kPartKeys);
  const TomlValue part = table.require("part", "the name of a part of the model");
  CharacterCloth entry;
  entry.part = part.text();
  const std::vector<int> parts = claim_parts(part, settings, is_taken);
  Cloth cloth;
  const auto name = table.find("name");
  entry.cloth = cloth.name = name ? name->identifier() : scene_name(settings.name, entry.part);
  SkinSource source = make_source(settings, parts, true);
  if (source.part->triangles.cols() == 0) part.fail("has no triangles, expected a surface");
  source.total_mass = read_mass(table, source);
  if (const auto value = table.find("mass_lumping")) {
    source.lumping = static_cast<MassLumping>(value->choice(kLumpingWords, "mass lumping"));
  }
  entry.reach = read_reach(table, source);
  at(part, [&] { return make_skin_mesh(source); });
  const std::vector<int> nodes = attached_nodes(entry.reach, source);
  if (!nodes.empty()) cloth.pins = {NodePin{nodes}};
  cloth.source = std::move(source);
  if (const auto value = table.find("collision_margin")) {
    cloth.collision_margin = value->non_negative("m");
  }
  if (const auto value = table.find("friction")) cloth.friction = value->non_negative("1");
  cloth.appearance = read_appearance(table);
  if (const auto value = table.find("drawn_mesh")) {
    cloth.drawn_mesh = read_drawn_part(*value, settings, is_taken);
    check_drawn_mesh(*value, cloth);
  }
  read_laws(table, world, cloth);
  settings.cloths.push_back(std::move(entry));
  scene.cloths.push_back(std::move(cloth));
}

/// What is no cloth, one body for each node of the model.
void add_skins(const std::vector<bool>& is_taken, const Appearance& appearance,
               CharacterSettings& settings, Scene& scene) {
  const std::vector<characters::Part>& parts = settings.model->character.parts;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const bool is_first =
        std::none_of(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(p),
                     [&](const auto& q) { return q.node == parts[p].node; });
    if (!is_first) continue;
    std::vector<int> group;
    for (std::size_t q = p; q < parts.size(); ++q) {
      if (parts[q].node == parts[p].node && !is_taken[q]) group.push_back(static_cast<int>(q));
    }
    if (group.empty()) continue;
    Cloth skin;
    skin.name = scene_name(settings.name, parts[p].node) + "-skin";
    SkinSource source = make_source(settings, group, false);
    if (source.part->triangles.cols() == 0) continue;
    std::vector<int> all(static_cast<std::size_t>(source.part->positions.cols()));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    skin.pins = {NodePin{std::move(all)}};
    skin.source = std::move(source);
    skin.appearance = appearance;
    settings.skins.push_back(skin.name);
    scene.cloths.push_back(std::move(skin));
  }
}

void read_bone_collider(const TomlTable& table, CharacterSettings& settings, Scene& scene) {
  const TomlValue bone = table.require("bone", "the name of a bone of the model");
  CharacterCollider entry;
  entry.bone = bone.text();
  const auto& skeleton = settings.model->character.skeleton;
  const int index = at(bone, [&] { return find_bone(skeleton, entry.bone); });
  for (const std::string_view key : {"mass", "path"}) {
    if (const auto value = table.find(key)) value->fail("a bone leads the collider, expected none");
  }
  Collider collider = read_collider(table, kBoneKeys);
  entry.collider = collider.name;
  entry.place = {collider.position, collider.orientation};
  const auto frames = world_frames(*settings.model, settings.pose, 0.0);
  const Pose start = led_pose(frames[static_cast<std::size_t>(index)], entry.place);
  collider.position = start.position;
  collider.orientation = start.orientation;
  collider.led_by = settings.name;
  settings.colliders.push_back(std::move(entry));
  scene.colliders.push_back(std::move(collider));
}

}  // namespace

void read_character(const TomlTable& table, Scene& scene) {
  allow_with_appearance(table, kCharacterKeys);
  CharacterSettings settings;
  settings.name = table.require("name", "a name such as \"figure\"").identifier();
  const TomlValue file = table.require("file", "a glTF model such as \"figure.glb\"");
  settings.model = at(file, [&] { return load_model(file.text(), file.files()); });
  settings.pose = read_pose(table, *settings.model);
  std::vector<bool> is_taken(settings.model->character.parts.size(), false);
  for (const TomlTable& part : table.tables("cloth")) {
    read_part(part, scene.world, settings, is_taken, scene);
  }
  settings.appearance = read_appearance(table);
  add_skins(is_taken, settings.appearance, settings, scene);
  for (const TomlTable& collider : table.tables("collider")) {
    read_bone_collider(collider, settings, scene);
  }
  scene.characters.push_back(std::move(settings));
}

}  // namespace weft::scenes
