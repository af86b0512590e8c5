#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp, tests/scenes/catalog/tear_test.cpp.

#include <vector>

#include <weft/core/types.hpp>
#include <weft/mesh/cutting/tear_rule.hpp>

namespace weft::scenes {

/// How a cloth of a scene tears. The threads of the rule are the edges "stretch".
struct ClothTear {
  TearRule rule;                 ///< weak regions are the cloth's
  std::vector<Blade> cuts = {};  ///< through the cloth at rest, before the first step
};

/// What a torn cloth consists of.
struct ClothTopology {
  Triangles triangles;  ///< as many as in the scene's mesh, in its order; other nodes
  std::vector<int>
      origins;  ///< of each node beyond those of the scene's mesh: the node of that it was
};

}  // namespace weft::scenes
