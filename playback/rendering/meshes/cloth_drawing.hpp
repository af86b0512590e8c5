#pragma once

// Tested by tests/playback/rendering/meshes/cloth_drawing_test.cpp.

#include <memory>

#include <weft/mesh/embedding/cloth_embedding.hpp>
#include <weft/playback/rendering/meshes/drawn_layout.hpp>
#include <weft/playback/rendering/meshes/surface_mesh.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// The drawn mesh of a cloth (Cloth::drawn_mesh) in the states of a run.
class ClothDrawing {
 public:
  /// mesh: of the scene. Throws InvalidArgument as ClothEmbedding.
  ClothDrawing(const DrawnCloth& drawn, const ClothMesh& mesh);

  [[nodiscard]] const DrawnLayout& layout() const { return layout_; }
  [[nodiscard]] const ClothEmbedding& embedding() const { return embedding_; }
  /// Leads the mesh to a state of the cloth, which may be torn.
  void set_state(const ClothState& cloth);
  /// A vertex in the state that was set.
  [[nodiscard]] DrawnVertex vertex(int v) const { return embedding_.vertex(pose_, v); }

 private:
  DrawnLayout layout_;
  ClothMesh mesh_;
  ClothEmbedding embedding_;
  ClothPose pose_;
  std::shared_ptr<const ClothTopology> topology_;  ///< that the embedding has
};

/// The picture of a cloth with a drawn mesh. Triangles with a vertex that is not finite or out of the limits are left out.
[[nodiscard]] SurfaceMesh drawn_surface(ClothDrawing& drawing, const ClothState& cloth,
                                        const DrawLimits& limits);

}  // namespace weft::scenes
