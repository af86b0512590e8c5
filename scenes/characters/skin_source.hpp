#pragma once

// Tested by tests/scenes/characters_test.cpp.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <weft/characters/character.hpp>
#include <weft/mesh/cloth_mesh.hpp>
#include <weft/scenes/motion/pose.hpp>

namespace weft::scenes {

/// A model as a scene has it, shared by all that is made of it.
struct CharacterModel {
  characters::Character character;
  std::vector<std::byte> bytes;  ///< of the file
};

/// Where a character stands and what it does.
struct CharacterPose {
  std::optional<std::size_t> clip = std::nullopt;  ///< index; none: the rest pose
  bool loop = true;
  double scale = 1.0;  ///< [m] per unit of the model, > 0
  Pose place;          ///< of the model's frame in the world
};

/// Frames of all bones in the world at a time of the run [s]; they contain the scale.
[[nodiscard]] std::vector<Eigen::Affine3d> world_frames(const CharacterModel& model,
                                                        const CharacterPose& pose, double time);

/// A part of a character as the source of a body.
struct SkinSource {
  std::shared_ptr<const CharacterModel> model;
  std::shared_ptr<const characters::Part> part;
  CharacterPose pose;
  bool is_cloth = false;    ///< otherwise it is drawn only: no springs, every node led
  double total_mass = 1.0;  ///< [kg]
  MassLumping lumping = MassLumping::kArea;
};

/// Where the bones have the nodes at a time of the run [s], 3 x n [m]: a pure function, for whatever
/// shows or places a character without simulating it.
[[nodiscard]] Matrix3X<double> skin_positions(const SkinSource& source, double time);

/// Where they are in the model's rest pose, which gives cloth its rest lengths, 3 x n [m].
[[nodiscard]] Matrix3X<double> rest_positions(const SkinSource& source);

/// The mesh of the part: a body of its surface, or triangles without springs. Throws InvalidArgument
/// as make_surface_body().
[[nodiscard]] ClothMesh make_skin_mesh(const SkinSource& source);

/// Area of the part in the rest pose [m^2].
[[nodiscard]] double skin_area(const SkinSource& source);

/// Unit normals of a surface's vertices, weighted by area, 3 x n [-]; straight up where there is none.
[[nodiscard]] Matrix3X<double> vertex_normals(const Matrix3X<double>& positions,
                                              const Triangles& triangles);

}  // namespace weft::scenes
