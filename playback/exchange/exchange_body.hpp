#pragma once

// Tested by tests/playback/exchange/point_cache_export_test.cpp, tests/playback/exchange/vtp_export_test.cpp.

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <weft/mesh/cloth_mesh.hpp>
#include <weft/mesh/embedding/cloth_embedding.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// A cloth, its drawn mesh or a collider of a scene as files of other programs have it: points and triangles.
struct ExchangeBody {
  std::string name;       ///< in the scene
  std::string file_name;  ///< without an ending; differs from that of every other body
  bool is_rigid = false;
  std::size_t index = 0;  ///< among the scene's cloths, or among its colliders
  /// At rest: of a cloth in the world, of a rigid body in its own frame [m].
  ClothMesh mesh;
  /// The drawing that leads the points of a drawn mesh; null: the points are the cloth's nodes.
  std::shared_ptr<const ClothEmbedding> embedding = nullptr;
};

/// Every cloth and collider of the scene, cloths first. Planes are left out: they have no border.
[[nodiscard]] std::vector<ExchangeBody> exchange_bodies(const Scene& scene);
/// The drawn meshes of its cloths (Cloth::drawn_mesh), named after the cloth with "-drawn" behind; bodies: whose names are taken.
[[nodiscard]] std::vector<ExchangeBody> drawn_bodies(const Scene& scene,
                                                     const std::vector<ExchangeBody>& bodies);

/// Points of the body in the world, 3 x n [m].
[[nodiscard]] Matrix3X<double> world_positions(const ExchangeBody& body, const SceneState& state);
/// Velocities of these points, 3 x n [m/s].
[[nodiscard]] Matrix3X<double> world_velocities(const ExchangeBody& body, const SceneState& state);

/// Edges of a body without triangles, such as a rope: 2 x m; none of a surface.
[[nodiscard]] Edges line_segments(const ClothMesh& mesh);

}  // namespace weft::scenes
