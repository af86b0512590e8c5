#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <memory>

#include <weft/playback/rendering/meshes/cloth_layout.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// The layout of a cloth that may have torn.
class TornLayout {
 public:
  explicit TornLayout(const ClothMesh& mesh);

  [[nodiscard]] const ClothLayout& whole() const { return whole_; }
  /// The layout of a state; made anew only if the topology is another one than last time.
  [[nodiscard]] const ClothLayout& of(const ClothMesh& mesh, const ClothState& cloth);

 private:
  ClothLayout whole_;
  ClothLayout torn_;
  std::shared_ptr<const ClothTopology> topology_;  ///< of torn_
};

}  // namespace weft::scenes
