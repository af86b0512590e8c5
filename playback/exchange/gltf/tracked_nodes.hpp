#pragma once

// Tested by tests/playback/exchange/gltf/gltf_export_test.cpp.

#include <memory>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// The nodes of a cloth as it is in the last frame, in every frame. Tears only split nodes, and triangles keep their order, so that the
/// nodes that a node has become are, before the tear, that one node.
class TrackedNodes {
 public:
  /// whole: mesh of the scene. last: topology in the last frame, null if the cloth is whole.
  TrackedNodes(ClothMesh whole, std::shared_ptr<const ClothTopology> last);

  /// The mesh in the last frame, as drawn_mesh().
  [[nodiscard]] const ClothMesh& mesh() const { return mesh_; }
  /// Triangles of a state, as indices of its own nodes.
  [[nodiscard]] const Triangles& triangles(const ClothState& cloth) const;
  /// For each node of mesh() the node that it is in a state; those of no triangle keep their number. Throws UnfitRecording for a state that is not torn less
  /// than the last frame, or equally. Valid until the next call.
  [[nodiscard]] const std::vector<int>& nodes(const ClothState& cloth);

 private:
  ClothMesh whole_;
  ClothMesh mesh_;
  std::shared_ptr<const ClothTopology> topology_;  ///< of nodes_
  std::vector<int> nodes_;
};

}  // namespace weft::scenes
