#pragma once

// Tested by tests/scenes/catalog/tear_test.cpp.

#include <memory>
#include <optional>
#include <vector>

#include <weft/core/state_archive.hpp>
#include <weft/mesh/cutting/tear.hpp>
#include <weft/scenes/cloth_tear.hpp>

namespace weft::scenes {

/// The mesh of a cloth that tears while a scene runs: what is the same for every engine.
class TornCloth {
 public:
  /// mesh: of the scene. Throws InvalidArgument as weft::check(TearRule).
  TornCloth(ClothMesh mesh, ClothTear tear);

  [[nodiscard]] const ClothMesh& mesh() const { return mesh_; }
  /// None as long as the cloth is whole.
  [[nodiscard]] const std::shared_ptr<const ClothTopology>& topology() const { return topology_; }
  /// The tear that makes this cloth of one that has torn less, or equally: of the same scene, earlier.
  /// Throws Error if the two do not belong together.
  [[nodiscard]] Tear tear_since(const TornCloth& earlier) const;

  /// The cuts before the first step; none if nothing comes apart.
  [[nodiscard]] std::optional<Tear> first_cuts() const;
  /// What tears at these positions, 3 x n [m]; none if nothing does.
  [[nodiscard]] std::optional<Tear> tear_at(ConstMatrix3XRef<double> positions) const;
  /// The engine has made this tear.
  void adopt(const Tear& tear);
  /// Mesh and topology, if the cloth has torn.
  void serialize(StateArchive& archive);

 private:
  ClothMesh mesh_;
  ClothTear tear_;
  int num_first_nodes_;
  std::shared_ptr<const ClothTopology> topology_;
};

/// The part of a scene's mesh and a state's topology (may be null) that is known without the engine:
/// rest positions, triangles, places in pictures and the edges "stretch", for pictures and strains. No masses, no other
/// sets. Throws InvalidArgument if the two do not fit.
[[nodiscard]] ClothMesh drawn_mesh(const ClothMesh& mesh, const ClothTopology* topology);

}  // namespace weft::scenes
