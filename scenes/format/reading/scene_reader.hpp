#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/format/toml_reader.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// The parts of the reader, one per kind of table. All throw SceneError.

inline constexpr int kMaxSteps = 10'000'000;  ///< of a whole run
inline constexpr int kMaxNodes = 1'000'000;   ///< of all cloths together
/// A recording keeps a mesh inside the text of its scene, which has a largest size.
inline constexpr int kMaxMeshNodes = 50'000;

[[nodiscard]] Scene read_scene(const TomlTable& root);
[[nodiscard]] World read_world(const TomlTable& table);
[[nodiscard]] Cloth read_cloth(const TomlTable& table, const World& world);
/// more: further keys that the table may have.
[[nodiscard]] Collider read_collider(const TomlTable& table, Keys more = {});
/// The laws of a cloth whose source and pins are known.
void read_laws(const TomlTable& table, const World& world, Cloth& cloth);
/// Adds the character, its cloths, skins and colliders to a scene whose world is known.
void read_character(const TomlTable& table, Scene& scene);
/// Keys of a cloth that say where its nodes come from and what they weigh: those of the source that
/// the table names.
[[nodiscard]] std::vector<std::string_view> cloth_source_keys(const TomlTable& table);
[[nodiscard]] ClothSource read_cloth_source(const TomlTable& table);
/// The body of a cloth with the key mesh, without its mass.
[[nodiscard]] MeshBody read_mesh_body(const TomlTable& cloth);
/// center_mass_share if center_node is true.
[[nodiscard]] std::optional<double> read_center_node(const TomlTable& table);
/// A table { axis, angle } or { quaternion }; of unit length.
[[nodiscard]] Eigen::Quaterniond read_orientation(const TomlValue& value);
/// The shape of a collider; other_keys: what its table may hold beside.
[[nodiscard]] Shape read_shape(const TomlTable& table, std::vector<std::string_view> other_keys);
/// cloth: the source says which edge sets there are; world: gravity, if the law names no
/// acceleration.
[[nodiscard]] forces::LawSpecification read_law(const TomlTable& table, const Cloth& cloth,
                                                const World& world);
/// The mesh that is drawn in place of a cloth whose rest shape is known.
[[nodiscard]] DrawnCloth read_drawn_mesh(const TomlValue& value, const Cloth& cloth);
/// The keys of it that say how it is bound to the cloth.
[[nodiscard]] EmbeddingOptions read_embedding(const TomlTable& table);
/// Refuses a drawn mesh that the cloth cannot lead.
void check_drawn_mesh(const TomlValue& value, const Cloth& cloth);
/// A mesh from the file of this table.
[[nodiscard]] import::ImportedMesh read_mesh_file(const TomlTable& table, bool is_body);
/// cloth: its regions may be weak, and its laws must allow a tear.
[[nodiscard]] ClothTear read_tear(const TomlValue& value, const Cloth& cloth);
[[nodiscard]] Path read_path(const TomlValue& value);
/// scene: its cloths say which there are.
[[nodiscard]] ControllerSettings read_controller(const TomlTable& table, const Scene& scene);
[[nodiscard]] std::vector<Pin> read_pins(const TomlValue& value, const Cloth& cloth);
/// The nodes at the bright places of a picture file; table: has more of the pin.
[[nodiscard]] NodePin read_mask(const TomlTable& table, const TomlValue& value, const Cloth& cloth);
/// The pins of a cloth, which may move.
void read_cloth_pins(const TomlValue& value, Cloth& cloth);
/// Refuses pins of this table [[cloth]] whose collider the scene does not have or that moves freely.
void check_carriers(const TomlTable& cloth, const Scene& scene);

}  // namespace weft::scenes
