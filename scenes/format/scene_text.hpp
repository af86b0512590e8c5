#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

#include <cstddef>
#include <string>
#include <string_view>

#include <weft/scenes/format/toml_text.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// The parts of the writer.

/// A quantity with its unit, or a bare number for the unit "1". Throws InvalidArgument if it is not
/// finite: it would not read back.
[[nodiscard]] std::string value_text(double value, std::string_view unit);
[[nodiscard]] std::string vector_text(const Vector3<double>& vector, std::string_view unit);
/// As a quaternion: axis and angle would not read back to the same bits.
[[nodiscard]] std::string orientation_text(const Eigen::Quaterniond& orientation);

/// Adds "key = value".
void line(std::string& out, std::string_view key, const std::string& value);

/// The word of an enumeration's value.
template <class Words, class Enum>
[[nodiscard]] std::string word(const Words& words, Enum value) {
  return toml_string(words.at(static_cast<std::size_t>(value)));
}

/// Adds the lines of a cloth that say where its nodes come from and what they weigh.
void write_source(std::string& out, const ClothSource& source);

/// Adds a law as a table of this path, "cloth.law".
void write_law(std::string& out, std::string_view path, const forces::LawSpecification& law);

/// Adds the mesh that is drawn in place of a cloth.
void write_drawn_mesh(std::string& out, const DrawnCloth& drawn);

/// Adds the keys of a collider, without its header.
void write_collider_keys(std::string& out, const Collider& collider);

/// Adds a character with the cloths and colliders of the scene that belong to it.
void write_character(std::string& out, const CharacterSettings& settings, const Scene& scene);

}  // namespace weft::scenes
