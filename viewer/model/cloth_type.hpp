#pragma once

// Tested by tests/viewer/model/cloth_type_test.cpp.

#include <span>
#include <string>
#include <string_view>

#include <weft/scenes/scene.hpp>

namespace weft::viewer {

/// A kind of fabric that differs from others by how it bends, as in the scene drape_torsion.
struct ClothType {
  std::string_view name;
  /// Length over which a strip bends under its own weight, (D / (rho g))^(1/3) [m]; the bending
  /// rigidity D of a cloth follows from its own mass per area rho.
  double bending_length = 0.0;
  std::string_view summary;
};

/// The first row stands for the laws as the scene has them.
[[nodiscard]] std::span<const ClothType> cloth_types();

/// Gives every cloth with triangles the bending of a type, in place of the laws torsion and
/// hinge_torsion that it has; the first type, those of `written`. Where the engine steps explicitly
/// and its step cannot be divided (is_held) the rigidity stays below what the scene's time step can take.
/// Returns what to tell the user about that; empty if there is nothing.
[[nodiscard]] std::string apply_cloth_type(scenes::Scene& scene, const scenes::Scene& written,
                                           std::size_t type, bool is_held);

}  // namespace weft::viewer
