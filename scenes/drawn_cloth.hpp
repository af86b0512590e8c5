#pragma once

// Tested by tests/scenes/drawn_mesh_test.cpp.

#include <memory>
#include <string>

#include <weft/mesh/embedding/cloth_embedding.hpp>
#include <weft/mesh/surface_body.hpp>

namespace weft::scenes {

/// A finer surface that is drawn in place of a cloth's own triangles and that the cloth leads. No engine looks at it.
struct DrawnCloth {
  /// [m] in the world, around the cloth in its rest positions; shared: nobody changes it.
  std::shared_ptr<const Surface> surface;
  std::string part = {};  ///< of the character's model that it is; empty: a mesh of its own
  EmbeddingOptions embedding = {};
};

}  // namespace weft::scenes
